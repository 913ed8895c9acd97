#pragma once
/// \file row_model.hpp  What a recording shows of a rig's rows: by how much, and where in the right image, points lie
/// beside the epipolar lines of the calibration, and whether one camera is late. doc/method.md section 3.

#include <Eigen/Core>
#include <vector>

#include "common/robust_fit.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/rig_estimate.hpp"
#include "rig/corner_matching.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {

/// A robust least-squares fit to the distances of matches from their lines in all frames so far, of which older ones
/// count less. Its terms: those of a RectificationError, 1, u, v, u^2, uv, v^2, u and v ranging from -1/2 to 1/2 over
/// the right image, less the mean of the squares; and minus the motion of the image across the line, as a camera that
/// is late by t frames shows points where they were t frames ago. Matches without a motion say nothing of that. Errors
/// that the matches of a frame share do not average out within the frame, so the covariance of the former is that of
/// the frames' contributions.
class RowModel {
 public:
  static constexpr int kTerms = 7;
  using Fit = RobustFit<kTerms>;
  using Terms = Fit::Terms;
  using Normal = Fit::Matrix;
  /// All that is known.
  struct Sums {
    Normal normal = Normal::Zero(), shared = Normal::Zero();  ///< `shared`: squared contributions of frames
    Terms right_side = Terms::Zero();
    double variance = 0;             ///< of a match, mean over the frames [px^2]
    double whole_variance = 0;       ///< the same without the model
    double frames = 0, matches = 0;  ///< that count
  };

  /// \param right the camera in which the matches lie \param memory frames that count
  explicit RowModel(const PinholeCamera& right, double memory = kRowMemory) : right_(right), kept_(1 - 1 / memory) {}

  /// Adds the matches of a frame; too few change nothing.
  void add(const std::vector<CornerMatch>& matches);

  /// The terms that are certain, each shrunk by its uncertainty; all zero before the first frame.
  RectificationError error() const;
  /// Distance of the matches from the model, in units of their distance from the lines; 1 before the first frame.
  double unexplained() const;
  const Sums& sums() const { return sums_; }
  /// Median distance of matches from all terms [px].
  double scatter(const std::vector<CornerMatch>& matches);

  /// Lag of the right camera in frame intervals, negative if the left one lags; 0 if not significant or implausibly
  /// large.
  double delay() const;
  /// Whether a delay would be seen, if there were one.
  bool would_show_delay() const;
  /// Whether matches fit clearly better without the delay.
  bool is_delay_contradicted_by(const std::vector<CornerMatch>& matches) const;

 private:
  static constexpr int kDelay = 6;
  void read(const std::vector<CornerMatch>& matches);
  Terms certain_terms() const;
  /// Standard deviation of the delay [frame intervals]; infinite while too few matches were seen.
  double delay_sigma() const;

  PinholeCamera right_;
  double kept_;  ///< of the weight of a frame, by the next one
  Sums sums_;
  Fit fit_;                     ///< all terms, certain or not
  std::vector<Fit::Row> rows_;  ///< of the matches read last
};

}  // namespace quadedge::rig
