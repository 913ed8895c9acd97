#pragma once
/// \file corner_judgement.hpp  Whether corners, searched for around their epipolar lines, fit the calibration.

#include "common/robust_fit.hpp"
#include "quadedge/rig_estimate.hpp"
#include "rig/rig_finding.hpp"

namespace quadedge::rig {

/// What a search needs.
struct CornerQuestion {
  const CornerMatcher& matcher;
  const StereoRig& rig;
  const StereoFrame& frame;
  double max_disparity;        ///< of the cascade, in the middle of the left image [px]
  const RigEstimate& known;    ///< of earlier frames
  const HiddenPixels& hidden;  ///< by the masks of the frame
  const GreyPlane* last_view;  ///< see CornerMatcher::search()
};

/// Robust fit to the distances of corners from their lines, whose terms are the distance in the middle of the left
/// image and its change over the image's width and height [px]. All zero for too few corners.
struct EpipolarFit : RobustFit<3> {
  double residual = 0;     ///< median distance from the lines, before the fit [px]
  bool is_coarse = false;  ///< whether the corners were found at the coarse resolution only
};

struct CornerAnswer {
  CornerSearch search;
  EpipolarFit fit;
  double unique_ratio = 1, negative_ratio = 0;  ///< of all corners found: unique, and with negative disparities
};

/// Adds a search for every `every`-th corner and its findings to the report.
CornerAnswer search_and_judge(const CornerQuestion& question, RigReport& report, std::size_t every = 1);

}  // namespace quadedge::rig
