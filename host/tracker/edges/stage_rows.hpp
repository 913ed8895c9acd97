#pragma once
/// \file stage_rows.hpp  Results of every stage for two small frames, as rows that can be compared between
/// implementations.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "edges/frontend.hpp"
#include "quadedge/image.hpp"

namespace quadedge::frontend {

/// Two frames of a rectified stereo rig.
struct SmallSequence {
  StereoRig rig;
  double max_disparity = 0;  ///< [px]
  Image left[2], right[2];
};

/// Results of one stage, unordered. Numbers are integer multiples of a unit: 1/100 px for positions, 1/200 rad for
/// directions, 1/500 for similarities, 1/100 grey level per px for gradients, 1 for descriptor distances and grey
/// levels; unused numbers are 0.
struct StageRows {
  static constexpr int kTolerance = 3;  ///< of every number, in its unit
  using Row = std::array<int, 5>;

  std::string stage;
  std::vector<Row> rows;
};

/// Observes every stage in the order of a frame; the last stages with a guided search, a coarse search with SIFT, and a
/// global search.
/// \param device  with its front end, or the reference \throws DeviceError
std::vector<StageRows> observe_stages(const SmallSequence& sequence, Device& device,
                                      const std::map<std::string, std::string>& variants);

/// The same for the stages of the paper's method, which `config` chooses, in the order of its cascades.
std::vector<StageRows> observe_paper_stages(const SmallSequence& sequence, Device& device, Config config);

/// Describes how the results of a stage differ; empty if they agree except for a fraction `allowed` of either side's
/// rows. The reference computes in double precision, so that decisions near a limit may differ.
std::string difference(const StageRows& found, const StageRows& expected, double allowed);

}  // namespace quadedge::frontend
