#pragma once
/// \file corner_judgement.hpp  Whether corners, searched for around their epipolar lines, fit the calibration.

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

struct CornerAnswer {
  CornerSearch search;
  EpipolarFit fit;  ///< of the distances of unique corners, if there are enough of them, from the lines
  double unique_ratio = 1, negative_ratio = 0;  ///< of all corners found: unique, and with negative disparities
};

/// Adds a search for every `every`-th corner and its findings to the report.
CornerAnswer search_and_judge(const CornerQuestion& question, RigReport& report, std::size_t every = 1);

}  // namespace quadedge::rig
