#pragma once
/// \file coarse_search.hpp  What the coarse disparity searches. doc/method.md section 3.

#include <cstdint>
#include <optional>

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"

namespace quadedge {

// What a path costs in addition when its disparity changes by a level, and when it changes by more. Pixels cost their
// difference in slope and half their difference in grey levels.
constexpr int kCoarseStepPenalty = 12, kCoarseJumpPenalty = 200;
constexpr float kUndecided = 0.9F;      // belief of an edge's best candidate below which neighbours leave a tie
constexpr float kCoarseReach = 1.5F;    // px; half a level and the error of a coarse position
constexpr float kCoarseDissent = 0.1F;  // what the witness leaves of the prior of the candidates it contradicts

/// How many edges the votes of their neighbours leave undecided.
struct RelaxationTally {
  std::int32_t edges = 0;      ///< with a candidate
  std::int32_t undecided = 0;  ///< of these, with a best belief below kUndecided
};

/// The search at half size over the disparities of `geometry`, one of `rig`; none where the rig is not rectified, or
/// where its images are too small.
std::optional<CoarseDisparityArguments> coarse_search(const StereoRig& rig, const EpipolarGeometry& geometry);

}  // namespace quadedge
