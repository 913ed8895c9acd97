#include "stages/temporal_match.hpp"

#include "opencl/variants.hpp"
#include "stages/quad_rows.hpp"

namespace quadedge::stages {
TemporalMatch::TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  const auto& variant = opencl::choose_variant("temporal_match", context, variants);
  fused_ = variant.form != opencl::Form::lists;
  local_size_ = static_cast<std::size_t>(variant.local_size);
  items_per_row_ = variant.form == opencl::Form::groups ? local_size_ : 1;
  if (fused_) kernel_ = {context, variant.program(context), "temporal_match"};
}

std::optional<AliveRows> TemporalMatch::read_quads(std::size_t rows, int step, const StereoEdges& edges,
                                                   TemporalMatches& matches) {
  matches.clear();
  std::optional<AliveRows> alive = AliveRows();
  read_back_.read(context_, result_, kQuadRowInts * rows, [&](const cl_int* values) {
    for (std::size_t row = 0; row < rows; ++row, values += kQuadRowInts) {
      if ((values[3] & kRowOverflow) != 0) {
        alive.reset();
        break;
      }
      alive->left += (values[3] & kLeftAlive) != 0 ? 1 : 0;
      alive->right += (values[3] & kRightAlive) != 0 ? 1 : 0;
      append_row(values, static_cast<std::int32_t>(row) * step, edges, matches);
    }
  });
  return alive;
}

std::optional<AliveRows> TemporalMatch::run(const DevicePositions& predicted, const TemporalSearch& search,
                                            const DeviceStereoEdges& base, const DeviceStereoEdges& current,
                                            const DevicePointIndex& left, const DevicePointIndex& right,
                                            const StereoEdges& edges, TemporalMatches& matches) {
  context_.begin_stage("temporal_match");
  const PositionsView left_predicted = predicted.list(0), right_predicted = predicted.list(1);
  const int count = (left_predicted.at.count + search.step - 1) / search.step;
  const auto rows = static_cast<std::size_t>(count);
  result_.ensure(context_, kQuadRowInts * rows);
  const FilterLimits limits = temporal_limits(config_, search);
  const TemporalMatchArguments arguments{count,
                                         search.step,
                                         left_predicted.at,
                                         right_predicted.at,
                                         left.layout(),
                                         right.layout(),
                                         current.positions(Side::left).at,
                                         search.radius,
                                         static_cast<float>(config_.orientation_rad()),
                                         limits.ncc_min,
                                         limits.ncc_nearly_best,
                                         quad_choice(config_, search)};
  kernel_({rows * items_per_row_, local_size_}, arguments, left_predicted.packed, left.points, left.cells, right.points,
          right.cells, base.left_patches, base.left_index, base.right_patches, current.left_patches, current.left_index,
          current.right_patches, current.packed, result_);
  return read_quads(rows, search.step, edges, matches);
}

}  // namespace quadedge::stages
