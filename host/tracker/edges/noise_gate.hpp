#pragma once
/// \file noise_gate.hpp  Decides which frames are smoothed because of their noise. doc/method.md section 1.

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::frontend {

/// Ratio of the noise that the threshold stage measures in an undistorted image to that of the recorded one: bilinear
/// interpolation removes much of what its operator responds to. 1 for an empty table.
double measured_noise_ratio(const UndistortionTable& table);

/// Is open for frames whose noise hides their edges: the limit of noise exceeds the gradient that a fifth of the images
/// exceeds. Once open, it closes at a fifth less noise.
class NoiseGate {
 public:
  NoiseGate(const StereoRig& rig, const EdgesConfig& config);

  bool is_open() const { return is_open_; }
  /// Takes what was measured in the recorded frame: standard deviation of the noise [grey levels], and that gradient.
  /// \returns whether the gate is open; for the same numbers the second answer is the same
  bool judge(double noise, double gradient);
  /// Standard deviation of white noise that has the same gradients in a recorded image as the frame's noise in a
  /// smoothed one [grey levels].
  double smoothed_noise() const { return smoothed_noise_; }

 private:
  double per_noise_, ratio_, smoothed_;
  double smoothed_noise_ = 0;
  bool is_open_ = false;
};

}  // namespace quadedge::frontend
