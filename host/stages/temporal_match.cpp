#include "stages/temporal_match.hpp"

#include <cstring>

#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;
// As in kernels/temporal_match.cl.
constexpr std::size_t kRowInts = 4;
constexpr cl_int kLeftAlive = 1, kRightAlive = 2, kOverflow = 4;

float from_bits(cl_int bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

TemporalMatch::TemporalMatch(opencl::Context& context, const TemporalConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  const auto& variant = opencl::choose_variant("temporal_match", context, variants);
  fused_ = variant.name != "lists";
  local_size_ = static_cast<std::size_t>(variant.local_size);
  if (fused_)
    kernel_ = {context, context.program({"similarity.cl", "point_index.cl", "temporal_match.cl"}, variant.defines),
               "temporal_match"};
}

std::optional<AliveRows> TemporalMatch::run(const DevicePlaces& left_predicted, const DevicePlaces& right_predicted,
                                            const TemporalSearch& search, const DeviceStereoEdges& base,
                                            const DeviceStereoEdges& current, const DevicePointIndex& left,
                                            const DevicePointIndex& right, const opencl::Buffer<cl_int>& itself,
                                            const StereoEdges& edges, TemporalMatches& matches) {
  context_.begin_stage("temporal_match");
  const int count = (left_predicted.count + search.step - 1) / search.step;
  const auto rows = static_cast<std::size_t>(count);
  result_.ensure(context_, kRowInts * rows);
  const FilterLimits limits = temporal_limits(config_, search);
  kernel_({rows, local_size_}, count, search.step, left_predicted.x, left_predicted.y, left_predicted.direction,
          right_predicted.x, right_predicted.y, right_predicted.direction, left.x, left.y, left.direction, left.number,
          left.cell_first, left.columns, left.rows, right.x, right.y, right.direction, right.number, right.cell_first,
          right.columns, right.rows, base.left_patches, base.left_index, base.right_patches, current.left_patches,
          current.left_index, current.right_patches, itself, current.packed, current.stride, search.radius,
          static_cast<float>(config_.orientation * kDegree), limits.ncc_min, limits.ncc_nearly_best,
          static_cast<float>(config_.distance_weight) / (search.radius * search.radius),
          static_cast<float>(config_.cluster_gap), static_cast<float>(config_.cluster_orientation * kDegree), result_);
  rows_.resize(kRowInts * rows);
  result_.read(rows_.data(), rows_.size());
  matches.clear();
  AliveRows alive;
  for (std::size_t row = 0; row < rows; ++row) {
    const cl_int* values = rows_.data() + kRowInts * row;
    if ((values[3] & kOverflow) != 0) return std::nullopt;
    alive.left += (values[3] & kLeftAlive) != 0 ? 1 : 0;
    alive.right += (values[3] & kRightAlive) != 0 ? 1 : 0;
    if (values[0] < 0) continue;
    matches.append(static_cast<std::int32_t>(row) * search.step, values[0], edges, from_bits(values[2]), values[1]);
  }
  return alive;
}

}  // namespace quadedge::stages
