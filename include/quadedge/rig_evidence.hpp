#pragma once
/// \file rig_evidence.hpp  What a frame's own images say about the calibration of the two cameras.

#include <limits>

namespace quadedge {

/// Evidence of one frame, doc/method.md section 7. NaN where nothing could be measured.
/// "Across" is the distance of a right point from its epipolar line [px of the right image], on a rectified rig how
/// much lower it lies than expected.
struct RigEvidence {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double matched_ratio = kUnknown;  ///< left edges with a stereo partner, of all left edges

  // Of patches around stereo edges, aligned in both directions of the image:
  double epipolar_residual = kUnknown;  ///< median distance from the line [px]
  double epipolar_offset = kUnknown;    ///< distance in the middle of the image [px], signed; the terms below add to it
  double epipolar_slope_x = kUnknown, epipolar_slope_y = kUnknown;  ///< change over the left image's width, height [px]
  int epipolar_samples = 0;

  // Of a search far around the epipolar lines, which only some frames have:
  double found_ratio = kUnknown;        ///< sought spots that are found, left to right and back to the same one
  double searched_residual = kUnknown;  ///< median distance of the found ones from their lines [px]
  double on_line_ratio = kUnknown;      ///< of those found exactly, those within 1 px of their line
  double negative_ratio = kUnknown;     ///< found ones with a disparity below -1 px
  double beyond_ratio = kUnknown;       ///< found ones with more than the largest disparity + 1 px
  bool is_searched() const { return found_ratio == found_ratio; }
};

}  // namespace quadedge
