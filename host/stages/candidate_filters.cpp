#include "stages/candidate_filters.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {

CandidateFilters::CandidateFilters(opencl::Context& context, const std::map<std::string, std::string>& variants)
    : context_(context) {
  const auto& variant = opencl::choose_variant("candidate_filters", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_row_ = variant.form == opencl::Form::groups ? local_size_ : 1;
  kernel_ = {context, variant.program(context), "candidate_filters"};
}

void CandidateFilters::run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step,
                           bool all_scores, DeviceCandidates& candidates) {
  context_.begin_stage("candidate_filters");
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  const FilterArguments arguments{candidates.rows, row_step, candidates.capacity, all_scores ? 1 : 0, limits};
  kernel_({static_cast<std::size_t>(candidates.rows) * items_per_row_, local_size_}, arguments, candidates.first,
          candidates.target, a.patches, a.patch_of, a.sift, b.patches, b.patch_of, b.sift, candidates.ncc,
          candidates.sift, candidates.state, candidates.alive);
}

}  // namespace quadedge::stages
