#pragma once
/// \file row_model.hpp  What a recording shows of a rig's rows: by how much, and where in the right image, points lie
/// beside the epipolar lines of the calibration. doc/method.md section 3.

#include <Eigen/Core>
#include <vector>

#include "common/epipolar_geometry.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// A robust least-squares fit of a RectificationError to the matches of all frames so far, of which older ones count
/// less. Errors that the matches of a frame share do not average out within the frame, so the covariance is that of the
/// frames' contributions.
class RowModel {
 public:
  static constexpr int kTerms = 6;
  using Terms = Eigen::Matrix<double, kTerms, 1>;
  using Normal = Eigen::Matrix<double, kTerms, kTerms>;
  /// All that is known; may be kept between recordings.
  struct Sums {
    Normal normal = Normal::Zero(), shared = Normal::Zero();  ///< `shared`: squared contributions of frames
    Terms right_side = Terms::Zero();
    double variance = 0;        ///< of a match, mean over the frames [px^2]
    double whole_variance = 0;  ///< the same without the model
    double frames = 0;          ///< that count
  };

  /// \param right the camera in which the matches lie
  explicit RowModel(const PinholeCamera& right) : RowModel(right, Sums()) {}
  RowModel(const PinholeCamera& right, const Sums& sums);

  /// Adds the matches of a frame; too few change nothing.
  void add(const std::vector<CornerMatch>& matches);

  /// The terms that are certain, each shrunk by its uncertainty; all zero before the first frame.
  RectificationError error() const;
  /// All terms, certain or not, in the order of RectificationError, and their covariance.
  struct Estimate {
    Terms terms;
    Normal covariance;
  };
  Estimate estimate() const;
  /// Distance of the matches from the model, in units of their distance from the lines; 1 before the first frame.
  double unexplained() const;
  const Sums& sums() const { return sums_; }
  /// Median distance of matches from all terms [px].
  double scatter(const std::vector<CornerMatch>& matches);

 private:
  /// 1, u, v, u^2, uv, v^2 at a match, less the mean of the squares over the image.
  Terms row_of(const CornerMatch& match) const;

  int width_, height_;
  Sums sums_;
  Terms terms_ = Terms::Zero();    ///< all of them
  std::vector<double> distances_;  ///< kept for its memory
};

}  // namespace quadedge::rig
