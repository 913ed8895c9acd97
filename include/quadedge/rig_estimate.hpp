#pragma once
/// \file rig_estimate.hpp  What is known of a stereo rig beside its calibration: with which rig a frame was measured.

#include <array>

namespace quadedge {

/// Distance of a right point from its epipolar line as a polynomial of the second degree in u and v, which range from
/// -1/2 to 1/2 over the right image [px]. Positive towards (ey, -ex) for a line of direction (ex, ey): downwards on a
/// rectified rig.
struct RectificationError {
  double offset = 0, slope_x = 0, slope_y = 0, bend_xx = 0, bend_xy = 0, bend_yy = 0;

  double at(double u, double v) const;
  /// Its largest absolute value over the image [px].
  double largest() const;
  RectificationError operator-(const RectificationError& other) const {
    return {offset - other.offset,   slope_x - other.slope_x, slope_y - other.slope_y,
            bend_xx - other.bend_xx, bend_xy - other.bend_xy, bend_yy - other.bend_yy};
  }
  RectificationError operator*(double factor) const {
    return {factor * offset, factor * slope_x, factor * slope_y, factor * bend_xx, factor * bend_xy, factor * bend_yy};
  }
  /// Its coefficients of 1, x, y, xx, xy, yy for an image of this size, x and y in pixels.
  using Terms = std::array<double, 6>;
  Terms in_pixels(int width, int height) const;
};

/// The rig of a frame, as far as it differs from the calibration (doc/method.md section 7).
struct RigEstimate {
  /// What the frame's stereo search allowed for. The right points that it found lie on the lines of the calibration.
  RectificationError rows;
  /// Of all disparities of the rig, to which it is added, and its standard deviation [px].
  double disparity_offset = 0, disparity_offset_sigma = 0;
  /// Covariance of its error with the systematic error of edges, in standard deviations of the latter [px]: from scenes
  /// alike, no more can be learned.
  double disparity_offset_shared = 0;
  /// By how much the right image of this frame alone is displaced along the epipolar lines, so that its disparities are
  /// larger, and the standard deviation of that [px]; 0 for a frame that is not displaced.
  double displacement = 0, displacement_sigma = 0;

  /// How good the calibration is: standard deviation of the errors that it leaves in single disparities, the same for
  /// an edge some frames later [px], and the weight of what the recording has shown of that [1/px^4].
  double disparity_error = 0, disparity_error_weight = 0;

  /// What is added to each disparity of the frame [px].
  double added_disparity() const { return disparity_offset - displacement; }
  /// Another frame of the rig, measured with what this frame knows of the offset.
  RigEstimate of(const RigEstimate& other) const {
    return {other.rows,         disparity_offset,         disparity_offset_sigma, disparity_offset_shared,
            other.displacement, other.displacement_sigma, disparity_error,        disparity_error_weight};
  }
};

}  // namespace quadedge
