#include "stages/stereo_mutual.hpp"

#include <limits>

#include "opencl/variants.hpp"

namespace quadedge::stages {

StereoMutual::StereoMutual(opencl::Context& context, const StereoConfig& config,
                           const std::map<std::string, std::string>& variants)
    : context_(context), mutual_radius_(static_cast<float>(config.mutual_radius)), scan_(context, variants) {
  const auto& variant = opencl::choose_variant("stereo_mutual", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  claim_ = {context, program, "stereo_claim"};
  owner_ = {context, program, "stereo_owner"};
  mutual_ = {context, program, "stereo_mutual"};
  collect_ = {context, program, "stereo_collect"};
}

void StereoMutual::run(const DeviceEdges& left, const DeviceEdges& right, Patches& right_patches,
                       const EpipolarGeometry& geometry, const DeviceClusters& clusters,
                       const DeviceRelaxation& relaxation, DeviceMutual& mutual, DeviceStereoEdges& result,
                       StereoEdges& edges) {
  context_.begin_stage("stereo_mutual");
  const int n = left.host_count;
  const auto left_edges = static_cast<std::size_t>(n), right_edges = static_cast<std::size_t>(right.host_count);
  mutual.keep.ensure(context_, left_edges);
  mutual.claimed.ensure(context_, right_edges);
  mutual.owner.ensure(context_, right_edges);
  mutual.claimed.fill(0, right_edges);
  mutual.owner.fill(std::numeric_limits<cl_int>::max(), right_edges);

  StereoMutualArguments arguments{};
  arguments.left = left.positions().at;
  arguments.capacity = clusters.stride;
  arguments.mutual_radius = mutual_radius_;
  arguments.geometry = geometry;
  const opencl::Range range(left_edges, local_size_);
  claim_(range, arguments, relaxation.chosen, relaxation.score, clusters.anchor, mutual.claimed);
  owner_(range, arguments, relaxation.chosen, relaxation.score, clusters.anchor, mutual.claimed, mutual.owner);
  mutual_(range, arguments, relaxation.chosen, clusters.anchor, left.packed, mutual.owner, mutual.keep);
  result.reserve(context_, left_edges);
  result.stride = n;
  scan_.run(mutual.keep, n, n, mutual.keep_first, result.total);
  collect_(range, arguments, mutual.keep_first, relaxation.chosen, left.packed, clusters.packed, clusters.anchor,
           result.left_index, result.right_index, result.packed, result.ncc);
  result.read(context_, read_back_, edges);
  right_patches.cut(result.positions(Side::right), result.right_patches);
}

}  // namespace quadedge::stages
