#include "stages/candidates.hpp"

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

CandidateLists DeviceCandidates::read() const {
  CandidateLists lists;
  lists.first = first.read(static_cast<std::size_t>(rows) + 1);
  lists.target = target.read(static_cast<std::size_t>(host_total));
  return lists;
}

JudgedCandidates DeviceCandidates::read_judged() const {
  const auto size = static_cast<std::size_t>(host_total);
  return {first.read(static_cast<std::size_t>(rows) + 1), target.read(size), state.read(size), ncc.read(size),
          sift.read(size)};
}

CandidateFilters::CandidateFilters(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "candidate_filters", variants) {
  kernel_ = {context, variant_.program(context), "candidate_filters"};
}

void CandidateFilters::run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step,
                           bool all_scores, DeviceCandidates& candidates) {
  begin();
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  kernel_(over(static_cast<std::size_t>(candidates.rows), local_size_), arguments, candidates.first, candidates.target,
          a.patches, a.patch_of, a.sift, b.patches, b.patch_of, b.sift, candidates.ncc, candidates.sift,
          candidates.state, candidates.alive);
}

}  // namespace quadedge::stages
