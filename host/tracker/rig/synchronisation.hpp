#pragma once
/// \file synchronisation.hpp  By how much one camera is late, from distances from the epipolar lines and image motion.

#include <vector>

#include "common/robust_fit.hpp"

namespace quadedge::rig {

/// If the right camera lags by t frame intervals, it shows points where they were t intervals ago, so that their
/// distance from the epipolar line is proportional to the image motion across that line. Calibration errors also cause
/// distances, but the same in every frame. A robust fit to all frames so far, of which older ones count less:
///   across = (a quadratic polynomial in u and v) - t motion.
class Synchronisation {
 public:
  using Fit = RobustFit<7>;

  /// What a corner shows. \param u, v position in the left image, -1/2 to 1/2
  /// \param across distance from the epipolar line [px] \param motion displacement across it since the last frame [px]
  static Fit::Row row(double u, double v, double across, double motion);
  /// Adds the corners of a frame; too few change nothing.
  void add(const std::vector<Fit::Row>& frame);

  /// Lag of the right camera in frame intervals, negative if the left one lags; 0 if not significant or
  /// implausibly large.
  double time_offset_frames() const;
  /// Whether an offset would be seen, if there were one.
  bool is_settled() const;
  /// Whether corners fit clearly better without the offset.
  bool is_contradicted_by(const std::vector<Fit::Row>& frame) const;

 private:
  /// Standard deviation of the offset [frame intervals]; infinite while too few corners were seen.
  double sigma() const;

  Fit fit_;
  Fit::Matrix normal_ = Fit::Matrix::Zero();
  Fit::Terms right_side_ = Fit::Terms::Zero();
  double variance_ = 0;            ///< of a distance, mean over the frames [px^2]
  double frames_ = 0, count_ = 0;  ///< that count, and their corners
};

}  // namespace quadedge::rig
