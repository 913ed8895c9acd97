#include "stages/wide_matching.hpp"

#include "common/layouts.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

int count_blocks(int descriptors) { return (descriptors + kBlockLanes - 1) / kBlockLanes; }

}  // namespace

WideMatching::WideMatching(opencl::Context& context, const TemporalConfig& config,
                           const std::map<std::string, std::string>& variants)
    : context_(context),
      neighbourhood_(static_cast<float>(config.wide_neighbourhood)),
      ratio_(static_cast<float>(config.wide_ratio)) {
  const auto& variant = opencl::choose_variant("wide_matching", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto rows = variant.defines.find("ROWS");
  rows_at_once_ = rows == variant.defines.end() ? 1 : std::stoul(rows->second);
  grouped_ = variant.form == opencl::Form::groups;
  in_blocks_ = variant.form == opencl::Form::blocks;
  const auto program = variant.program(context);
  if (in_blocks_) {
    transpose_ = {context, program, "wide_transpose"};
    blocks_kernel_ = {context, program, "wide_match"};
  } else {
    kernel_ = {context, program, "wide_match"};
  }
}

void WideMatching::transpose(const DeviceWideEdges& edges, opencl::Buffer<cl_uchar>& blocks) {
  const int count = count_blocks(edges.rows);
  blocks.ensure(context_, static_cast<std::size_t>(count) * kBlockLanes * kWideBytes);
  transpose_({static_cast<std::size_t>(count), local_size_}, edges.descriptors, edges.rows, blocks);
}

TemporalMatches WideMatching::run(const DeviceWideEdges& earlier, const DeviceWideEdges& current,
                                  const StereoEdges& current_edges) {
  context_.begin_stage("wide_matching");
  const auto rows = static_cast<std::size_t>(earlier.rows);
  best_.ensure(context_, rows);
  similarity_.ensure(context_, rows);
  const WideMatchingArguments arguments{{earlier.edges.stride, earlier.rows, earlier.step},
                                        {current.edges.stride, current.rows, current.step},
                                        neighbourhood_,
                                        ratio_};
  const std::size_t parts = (rows + rows_at_once_ - 1) / rows_at_once_;
  if (!in_blocks_) {
    kernel_({parts * (grouped_ ? local_size_ : 1), local_size_}, arguments, earlier.descriptors, earlier.edges.packed,
            current.descriptors, current.edges.packed, best_, similarity_);
  } else {
    transpose(earlier, earlier_blocks_);
    transpose(current, current_blocks_);
    blocks_kernel_({parts, local_size_}, arguments, earlier.descriptors, earlier_blocks_, earlier.edges.packed,
                   current.descriptors, current_blocks_, current.edges.packed, best_, similarity_);
  }
  std::vector<cl_int> best(rows);
  const opencl::CopyGuard guard(context_);
  best_.read_later(best.data(), rows);
  const auto similarity = similarity_.read(rows);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    if (best[row] < 0) continue;
    matches.append(static_cast<std::int32_t>(row) * earlier.step, best[row] * current.step, current_edges,
                   similarity[row], 0);
  }
  return matches;
}

}  // namespace quadedge::stages
