#include "stages/wide_matching.hpp"

#include "opencl/variants.hpp"

namespace quadedge::stages {

WideMatching::WideMatching(opencl::Context& context, const TemporalConfig& config, const std::map<std::string, std::string>& variants)
    : context_(context),
      neighbourhood_(static_cast<float>(config.wide_neighbourhood)),
      ratio_(static_cast<float>(config.wide_ratio)) {
  const auto& variant = opencl::choose_variant("wide_matching", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  kernel_ = {context, context.program({"wide_matching.cl"}, variant.defines), "wide_match"};
}

TemporalMatches WideMatching::run(const DeviceWideEdges& earlier, const DeviceWideEdges& current, const StereoEdges& current_edges) {
  context_.begin_stage("wide_matching");
  const auto rows = static_cast<std::size_t>(earlier.rows);
  best_.ensure(context_, rows);
  likeness_.ensure(context_, rows);
  kernel_({rows, local_size_}, earlier.descriptors, earlier.edges.packed, earlier.edges.stride, earlier.rows, earlier.step,
          current.descriptors, current.edges.packed, current.edges.stride, current.rows, current.step, neighbourhood_, ratio_, best_,
          likeness_);
  const auto best = best_.read(rows);
  const auto likeness = likeness_.read(rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    if (best[row] < 0) continue;
    matches.append(static_cast<std::int32_t>(row) * earlier.step, best[row] * current.step, current_edges, likeness[row], 0);
  }
  return matches;
}

}  // namespace quadedge::stages
