#include "stages/edge_threshold.hpp"

#include "common/threshold_limits.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {

EdgeThreshold::EdgeThreshold(opencl::Context& context, const EdgesConfig& config,
                             const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  values_.write(context, {static_cast<cl_float>(config.threshold), 0.0F});
  if (config.threshold > 0) return;
  const auto& variant = opencl::choose_variant("edge_threshold", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  opencl::Defines defines = gradient_defines(config);
  defines["GROUP"] = std::to_string(variant.local_size);
  const cl::Program program = variant.program(context, defines);
  tally_ = {context, program, "edges_tally"};
  choose_ = {context, program, "edges_threshold"};
}

ThresholdArguments EdgeThreshold::arguments(const PaddedPlane& plane) const {
  const ThresholdLimits limits = threshold_limits(config_);
  const double step = kMaxGrey / plane.max_value();  // [grey levels]
  return {plane.width(),
          plane.height(),
          plane.stride(),
          static_cast<float>(kMaxGrey),
          static_cast<float>(step),
          static_cast<float>(config_.threshold_area),
          static_cast<float>(limits.per_noise),
          static_cast<float>(limits.per_step * step),
          static_cast<float>(config_.threshold_max)};
}

int EdgeThreshold::tally(const PaddedPlane& plane, int first) {
  const int rows = plane.height() / kThresholdStep;
  tally_({static_cast<std::size_t>(rows) * local_size_, local_size_}, arguments(plane), plane.pixels(), plane.taps(),
         first, tallies_);
  return rows;
}

void EdgeThreshold::run(const PaddedPlane& left, const PaddedPlane* right) {
  if (config_.threshold > 0) return;
  context_.begin_stage("edge_threshold");
  const int rows = (left.height() + (right != nullptr ? right->height() : 0)) / kThresholdStep + 1;
  tallies_.ensure(context_, static_cast<std::size_t>(rows) * kThresholdBins);
  int count = tally(left, 0);
  if (right != nullptr) count += tally(*right, count);
  choose_({local_size_, local_size_}, arguments(left), tallies_, count, values_);
}

}  // namespace quadedge::stages
