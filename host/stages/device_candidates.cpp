#include "stages/device_candidates.hpp"

#include "common/layouts.hpp"

namespace quadedge::stages {

CandidateLists DeviceCandidates::alive_after(int order, const opencl::Buffer<cl_float>* cue) const {
  const auto size = static_cast<std::size_t>(host_total);
  const auto starts = first.read(static_cast<std::size_t>(rows) + 1);
  const auto targets = target.read(size);
  const auto states = state.read(size);
  const auto cues = cue != nullptr ? cue->read(size) : std::vector<float>();
  CandidateLists lists;
  lists.first.assign(1, 0);
  for (int row = 0; row < rows; ++row) {
    for (auto c = static_cast<std::size_t>(starts[static_cast<std::size_t>(row)]);
         c < static_cast<std::size_t>(starts[static_cast<std::size_t>(row) + 1]); ++c) {
      if (states[c] != kCandidateAlive && states[c] <= order) continue;
      lists.target.push_back(targets[c]);
      if (cue != nullptr) lists.cue.push_back(cues[c]);
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace quadedge::stages
