#pragma once
/// \file rig_evidence.hpp  Evidence in a frame's images for or against the calibration of the two cameras.

#include <limits>

namespace quadedge {

/// Evidence from one frame, see doc/method.md section 7. NaN if a quantity could not be measured.
struct RigEvidence {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  double matched_ratio = kUnknown;  ///< fraction of the left edges that have a stereo match

  // From patches around stereo edges, aligned in both image directions:
  double epipolar_residual = kUnknown;  ///< median distance from the line [px]
  double epipolar_correction = 0;       ///< largest distance from the lines that the stereo search allowed for [px]

  // From a wide search around the epipolar lines, which is done in some frames only:
  double found_ratio = kUnknown;  ///< fraction of the corners found in the right image and, from there, in the left
  double searched_residual = kUnknown;  ///< median distance of the corners found from their epipolar lines [px]
  double on_line_ratio = kUnknown;      ///< fraction of those found to sub-pixel accuracy within 1 px of their line
  double negative_ratio = kUnknown;     ///< fraction of the unique corners with a disparity below -1 px
  double beyond_ratio = kUnknown;       ///< fraction of the unique corners with one above the maximum + 1 px
  bool is_searched() const { return found_ratio == found_ratio; }
};

}  // namespace quadedge
