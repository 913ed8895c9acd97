#pragma once
/// \file row_model.hpp  What a recording shows of a rig's rows: by how much, and where in the right image, points lie
/// beside the epipolar lines of the calibration. doc/method.md section 3.

#include <Eigen/Core>
#include <vector>

#include "common/epipolar_geometry.hpp"
#include "rig/corner_matching.hpp"

namespace quadedge::rig {

/// A robust least-squares fit of the first terms to the matches of all frames so far, of which older ones count less:
/// 1, u, v, u^2, uv, v^2, u and v ranging from -1/2 to 1/2 over the right image, less the mean of the squares, and what
/// a lens moves points that lie farther from its axis by r^3 and by r^5. Errors that the matches of a frame share do
/// not average out within the frame, so the covariance is that of the frames' contributions.
template <int Count>
class RowFit {
 public:
  using Terms = Eigen::Matrix<double, Count, 1>;
  using Normal = Eigen::Matrix<double, Count, Count>;
  /// All that is known; may be kept between recordings.
  struct Sums {
    Normal normal = Normal::Zero(), shared = Normal::Zero();  ///< `shared`: squared contributions of frames
    Terms right_side = Terms::Zero();
    double variance = 0;        ///< of a match, mean over the frames [px^2]
    double whole_variance = 0;  ///< the same without the model
    double frames = 0;          ///< that count
  };

  /// \param right the camera in which the matches lie
  RowFit(const PinholeCamera& right, const Sums& sums);

  /// Adds the matches of a frame; too few change nothing.
  void add(const std::vector<CornerMatch>& matches);
  /// The terms that are certain, each shrunk by its uncertainty; all zero before the first frame.
  Terms certain_terms() const;
  const Terms& terms() const { return terms_; }
  const Sums& sums() const { return sums_; }
  /// Median distance of matches from all terms [px].
  double scatter(const std::vector<CornerMatch>& matches);

 private:
  Terms row_of(const CornerMatch& match) const;

  PinholeCamera right_;
  Sums sums_;
  Terms terms_ = Terms::Zero();    ///< all of them
  std::vector<double> distances_;  ///< kept for its memory
};

/// The fit of a RectificationError, and beside it one with a lens.
class RowModel {
 public:
  static constexpr int kTerms = 6;
  using Fit = RowFit<kTerms>;
  using Terms = Fit::Terms;
  using Normal = Fit::Normal;
  using Sums = Fit::Sums;

  /// \param right the camera in which the matches lie
  explicit RowModel(const PinholeCamera& right) : RowModel(right, Sums(), {}) {}
  /// \param known what earlier recordings have shown of the camera
  RowModel(const PinholeCamera& right, const Sums& sums, const RightCameraError& known)
      : right_(right), fit_(right, sums), with_lens_(right, {}), known_(known) {}

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
  /// What would make a camera's rows what they are, as far as it is certain after a few frames of this recording, or
  /// known; for a rig whose epipolar lines are rows. Whether it is true, rows do not show.
  RightCameraError camera_error() const;
  /// What is known from earlier recordings.
  const RightCameraError& known_camera_error() const { return known_; }
  /// Distance of the matches from the model, in units of their distance from the lines; 1 before the first frame.
  double unexplained() const;
  const Sums& sums() const { return fit_.sums(); }
  /// Median distance of matches from all terms [px].
  double scatter(const std::vector<CornerMatch>& matches) { return fit_.scatter(matches); }

 private:
  PinholeCamera right_;
  Fit fit_;
  RowFit<kTerms + 2> with_lens_;
  RightCameraError known_;
};

}  // namespace quadedge::rig
