#pragma once
/// \file epipolar_fit.hpp  Linear model of the distances from the epipolar lines over the image.

#include <vector>

#include "common/rectification_error.hpp"
#include "rig_check/epipolar_probe.hpp"

namespace quadedge::rig_check {

struct EpipolarFit : RectificationError {
  double residual = 0;  ///< median distance from the lines, before the fit [px]
  double scatter = 0;   ///< median distance from the fit [px]
  int samples = 0;
  bool is_coarse = false;  ///< whether the corners were found at the coarse resolution only
};

/// Robust fit (iteratively reweighted least squares with Cauchy weights); all zero for fewer than 12 corners.
EpipolarFit fit_across(const std::vector<CornerMatch>& matches, int width, int height);

}  // namespace quadedge::rig_check
