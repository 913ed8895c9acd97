/// \file candidates.cpp  One launch filters all rows of a list; the variant decides how many work-items share a row.
#include "device/candidates.hpp"

#include "common/layouts.hpp"

namespace quadedge::stages {

CandidateLists DeviceCandidates::read() const {
  CandidateLists lists;
  lists.first = first.read(static_cast<std::size_t>(rows) + 1);
  lists.target = target.read(static_cast<std::size_t>(host_total));
  return lists;
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
