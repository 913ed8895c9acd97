#include "stages/temporal_quads.hpp"

#include "opencl/variants.hpp"
#include "quadedge/filters.hpp"

namespace quadedge::stages {
TemporalQuads::TemporalQuads(opencl::Context& context, const TemporalConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  const auto& variant = opencl::choose_variant("temporal_quads", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = context.program({"temporal_quads.cl"}, variant.defines);
  agree_ = {context, program, "temporal_agreement"};
  best_kernel_ = {context, program, "temporal_best"};
}

void TemporalQuads::agree(DeviceCandidates& left, const DeviceCandidates& right) {
  context_.begin_stage("temporal_quads");
  score_.ensure(context_, static_cast<std::size_t>(left.capacity));
  agree_({static_cast<std::size_t>(left.rows), local_size_}, left.first, left.target, left.capacity, left.ncc,
         left.state, right.first, right.target, right.capacity, right.ncc, right.state, left.rows,
         order_of(TemporalFilter::agreement), score_);
}

TemporalMatches TemporalQuads::collect(const DeviceStereoEdges& current, const StereoEdges& edges,
                                       const TemporalSearch& search, const DevicePlaces& predicted,
                                       const DeviceCandidates& left) {
  const auto rows = static_cast<std::size_t>(left.rows);
  label_.ensure(context_, static_cast<std::size_t>(left.capacity));
  best_.ensure(context_, rows);
  rivals_.ensure(context_, rows);
  best_score_.ensure(context_, rows);
  best_kernel_({rows, local_size_}, left.first, left.target, left.capacity, left.rows, search.step, current.packed,
               current.stride, left.state, score_, predicted.x, predicted.y,
               static_cast<float>(config_.distance_weight) / (search.radius * search.radius),
               static_cast<float>(config_.cluster_gap), static_cast<float>(config_.cluster_orientation_rad()), label_,
               best_, rivals_, best_score_);
  const auto best = best_.read(rows);
  const auto rivals = rivals_.read(rows);
  const auto scores = best_score_.read(rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    if (best[row] >= 0)
      matches.append(static_cast<std::int32_t>(row) * search.step, best[row], edges, scores[row], rivals[row]);
  }
  return matches;
}

}  // namespace quadedge::stages
