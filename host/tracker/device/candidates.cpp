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

cl::Program candidates_program(opencl::Context& context, const opencl::Variant& variant, Turns turns) {
  if (turns == Turns::full) return variant.program(context);
  opencl::Defines defines = variant.defines;
  defines["HALF_TURN"] = "1";
  return context.program(variant.files, defines);
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

PaperFilters::PaperFilters(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, "paper_filters", variants), unused_(context, 1) {
  const auto program = variant_.program(context);
  ncc_ = {context, program, "paper_ncc"};
  decide_ = {context, program, "candidate_filters"};
}

void PaperFilters::run(const PaperDescribedEdges& a, const PaperDescribedEdges& b, const FilterLimits& limits,
                       int row_step, bool all_scores, DeviceCandidates& candidates) {
  begin();
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  const opencl::Range rows = over(static_cast<std::size_t>(candidates.rows), local_size_);
  ncc_(rows, arguments, candidates.first, candidates.target, a.patches, a.number_of, b.patches, b.number_of,
       candidates.ncc);
  decide_(rows, arguments, candidates.first, candidates.target, unused_, a.number_of, a.sift, unused_, b.number_of,
          b.sift, candidates.ncc, candidates.sift, candidates.state, candidates.alive);
}

}  // namespace quadedge::stages
