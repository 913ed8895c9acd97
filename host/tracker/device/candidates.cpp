/// \file candidates.cpp  One launch filters all rows of a list, a row per work-item.
#include "device/candidates.hpp"

#include "common/layouts.hpp"

namespace quadedge::stages {

CandidateLists DeviceCandidates::read() const {
  CandidateLists lists;
  lists.first = first.read(static_cast<std::size_t>(rows) + 1);
  lists.target = target.read(static_cast<std::size_t>(host_total));
  return lists;
}

cl::Program candidates_program(opencl::Context& context, const opencl::Variant& variant, Turns turns) {
  if (turns == Turns::full) return variant.program(context);
  opencl::Defines defines = variant.defines;
  defines["HALF_TURN"] = "1";
  return context.program(variant.files, defines);
}

CandidateFilters::CandidateFilters(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "candidate_filters", variants), kernel_(context, variant_.program(context), "candidate_filters") {}

void CandidateFilters::run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step,
                           bool all_scores, DeviceCandidates& candidates) {
  begin();
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  kernel_(over(static_cast<std::size_t>(candidates.rows)), arguments, candidates.first, candidates.target, a.patches,
          a.patch_of, a.sift, b.patches, b.patch_of, b.sift, candidates.ncc, candidates.sift, candidates.state,
          candidates.alive);
}

}  // namespace quadedge::stages
