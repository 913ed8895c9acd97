#pragma once
/// \file epipolar_fit.hpp  Linear model of the distances from the epipolar lines over the image.

#include <vector>

#include "rig_check/epipolar_probe.hpp"

namespace quadedge::rig_check {

/// across = offset + slope_x u + slope_y v, where u and v range from -1/2 to 1/2 over the left image.
struct EpipolarFit {
  double offset = 0, slope_x = 0, slope_y = 0;  ///< [px]
  double residual = 0;                          ///< median distance from the lines, before the fit [px]
  double scatter = 0;                           ///< median distance from the fit [px]
  int samples = 0;
  bool is_coarse = false;  ///< whether the corners were found at the coarse resolution only
};

/// Robust fit (iteratively reweighted least squares with Cauchy weights); all zero for fewer than 12 corners.
EpipolarFit fit_across(const std::vector<CornerMatch>& matches, int width, int height);

}  // namespace quadedge::rig_check
