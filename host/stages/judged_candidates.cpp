#include "stages/judged_candidates.hpp"

#include "common/layouts.hpp"

namespace quadedge::stages {

CandidateLists JudgedCandidates::alive_after(int order, const std::vector<float>* cue) const {
  CandidateLists lists;
  lists.first.assign(1, 0);
  for (std::size_t row = 0; row + 1 < first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(first[row]); c < static_cast<std::size_t>(first[row + 1]); ++c) {
      if (state[c] != kCandidateAlive && state[c] <= order) continue;
      lists.target.push_back(target[c]);
      if (cue != nullptr) lists.cue.push_back((*cue)[c]);
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace quadedge::stages
