#include "stages/temporal_quads.hpp"

#include "common/filter_limits.hpp"
#include "opencl/variants.hpp"
#include "quadedge/filters.hpp"
#include "stages/quad_rows.hpp"

namespace quadedge::stages {
TemporalQuads::TemporalQuads(opencl::Context& context, const TemporalConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  const auto& variant = opencl::choose_variant("temporal_quads", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  agree_ = {context, program, "temporal_agreement"};
  best_ = {context, program, "temporal_best"};
}

void TemporalQuads::agree(DeviceCandidates& left, const DeviceCandidates& right) {
  context_.begin_stage("temporal_quads");
  score_.ensure(context_, static_cast<std::size_t>(left.capacity));
  agree_({static_cast<std::size_t>(left.rows), local_size_},
         {left.rows, left.capacity, right.capacity, order_of(TemporalFilter::agreement)}, left.first, left.target,
         left.ncc, left.state, right.first, right.target, right.ncc, right.state, score_);
}

TemporalMatches TemporalQuads::collect(const DeviceStereoEdges& current, const StereoEdges& edges,
                                       const TemporalSearch& search, const PositionsView& predicted,
                                       const DeviceCandidates& left) {
  const auto rows = static_cast<std::size_t>(left.rows);
  label_.ensure(context_, static_cast<std::size_t>(left.capacity));
  result_.ensure(context_, kQuadRowInts * rows);
  best_({rows, local_size_},
        {left.rows, search.step, left.capacity, predicted.at, current.positions(Side::left).at,
         quad_choice(config_, search)},
        left.first, left.target, left.state, score_, predicted.packed, current.packed, label_, result_);
  const auto result = result_.read(kQuadRowInts * rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row)
    append_row(result.data() + kQuadRowInts * row, static_cast<std::int32_t>(row) * search.step, edges, matches);
  return matches;
}

}  // namespace quadedge::stages
