#pragma once
/// \file host_stages.hpp  The stages of a frame that the host times: FrameTiming::stages, and columns of frames.csv.

#include <array>

namespace quadedge {

constexpr const char* kStereoStage = "stereo";
constexpr const char* kTemporalStage = "temporal";
constexpr const char* kPoseStage = "pose";

/// In their order. A frame that is lost early does not reach all of them.
constexpr std::array<const char*, 3> kHostStages = {kStereoStage, kTemporalStage, kPoseStage};

}  // namespace quadedge
