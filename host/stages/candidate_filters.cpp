#include "stages/candidate_filters.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {

CandidateFilters::CandidateFilters(opencl::Context& context, const std::map<std::string, std::string>& variants)
    : context_(context) {
  const auto& variant = opencl::choose_variant("candidate_filters", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  kernel_ = {context, context.program({"similarity.cl", "candidate_filters.cl"}, variant.defines), "candidate_filters"};
}

void CandidateFilters::run(const DescribedEdges& a, const DescribedEdges& b, const FilterLimits& limits, int row_step,
                           bool all_scores, DeviceCandidates& candidates) {
  candidates.alive.ensure(context_, static_cast<std::size_t>(candidates.rows));
  kernel_({static_cast<std::size_t>(candidates.rows), local_size_}, candidates.first, candidates.target,
          candidates.rows, row_step, candidates.capacity, a.patches, a.patch_of, a.sift, a.sift_of, b.patches,
          b.patch_of, b.sift, b.sift_of, limits.ncc_min, limits.sift_max, limits.ncc_nearly_best,
          limits.sift_nearly_best, limits.ncc_order, limits.sift_order, all_scores ? 1 : 0, candidates.ncc,
          candidates.sift, candidates.rejected_by, candidates.alive);
}

}  // namespace quadedge::stages
