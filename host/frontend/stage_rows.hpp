#pragma once
/// \file stage_rows.hpp  What every stage leaves of two small frames, in rows that two implementations can be compared
/// by.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "frontend/frontend.hpp"
#include "quadedge/image.hpp"

namespace quadedge::frontend {

/// Two frames of a stereo rig that is rectified.
struct SmallSequence {
  StereoRig rig;
  double max_disparity = 0;  ///< [px]
  Image left[2], right[2];
};

/// What one stage left, without an order. Numbers are whole multiples of a unit: 1/100 px of positions, 1/200 rad of
/// directions, 1/500 of similarities, 1/100 grey level per px of gradients, 1 of distances between descriptors and of
/// grey levels; what a row lacks is 0.
struct StageRows {
  static constexpr int kTolerance = 3;  ///< of every number, in its unit
  using Row = std::array<int, 5>;

  std::string stage;
  std::vector<Row> rows;
};

/// Every stage in the order of a frame; the last ones by a guided search, a coarse one with SIFT, and one anywhere.
/// \param device  with its front end, or the reference \throws DeviceError
std::vector<StageRows> observe_stages(const SmallSequence& sequence, Device& device,
                                      const std::map<std::string, std::string>& variants);

/// How the results of a stage differ; empty where they agree but for `allowed`, a fraction of either side's rows: the
/// reference works in double precision, so that decisions near a limit may differ.
std::string difference(const StageRows& found, const StageRows& expected, double allowed);

}  // namespace quadedge::frontend
