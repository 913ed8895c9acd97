#include "stages/temporal_candidates.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr int kFirstCapacityPerRow = 48;  // initial; grows as needed

}  // namespace

TemporalCandidates::TemporalCandidates(opencl::Context& context, const std::map<std::string, std::string>& variants)
    : context_(context), scan_(context, variants) {
  const auto& variant = opencl::choose_variant("temporal_candidates", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  count_ = {context, program, "temporal_candidates_count"};
  fill_ = {context, program, "temporal_candidates_fill"};
}

void TemporalCandidates::run(const PositionsView& predicted, int row_step, const DevicePointIndex& current,
                             float radius, float orientation, DeviceCandidates& candidates) {
  context_.begin_stage("temporal_candidates");
  candidates.rows = (predicted.at.count + row_step - 1) / row_step;
  candidates.counts.ensure(context_, static_cast<std::size_t>(candidates.rows));
  candidates.reserve(context_, kFirstCapacityPerRow * candidates.rows);
  const opencl::Range range(static_cast<std::size_t>(candidates.rows), local_size_);
  const TemporalCandidateArguments arguments{candidates.rows,  row_step, predicted.at,
                                             current.layout(), radius,   orientation};
  count_(range, arguments, predicted.packed, current.points, current.cells, candidates.counts);
  candidates.build(context_, scan_, [&] {
    fill_(range, arguments, predicted.packed, current.points, current.cells, candidates.first, candidates.capacity,
          candidates.target);
  });
}

}  // namespace quadedge::stages
