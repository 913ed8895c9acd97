/// \file candidates.cpp  One launch filters all rows of a list; the variant decides how many work-items share a row.
#include "device/candidates.hpp"

#include <type_traits>

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

template <class Value>
FiltersOn<Value>::FiltersOn(opencl::Context& context, const opencl::VariantChoice& variants)
    : Stage(context, std::is_same_v<Value, cl_char> ? "candidate_filters" : "paper_filters", variants) {
  kernel_ = {context, variant_.program(context), "candidate_filters"};
}

template <class Value>
void FiltersOn<Value>::run(const DescribedBy<Value>& a, const DescribedBy<Value>& b, const FilterLimits& limits,
                           int row_step, bool all_scores, DeviceCandidates& candidates) {
  begin();
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  kernel_(over(static_cast<std::size_t>(candidates.rows), local_size_), arguments, candidates.first, candidates.target,
          a.patches, a.patch_of, a.sift, b.patches, b.patch_of, b.sift, candidates.ncc, candidates.sift,
          candidates.state, candidates.alive);
}

template class FiltersOn<cl_char>;
template class FiltersOn<cl_float>;

}  // namespace quadedge::stages
