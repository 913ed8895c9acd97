#include "stages/stereo_clusters.hpp"

#include <limits>

#include "common/stereo_constants.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {
StereoClusters::StereoClusters(opencl::Context& context, const StereoConfig& config,
                               const std::map<std::string, std::string>& variants)
    : context_(context), config_(config), scan_(context, variants) {
  const auto& variant = opencl::choose_variant("stereo_clusters", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = context.program({"direction.cl", "epipolar.cl", "stereo_clusters.cl"}, variant.defines);
  cluster_ = {context, program, "stereo_clusters"};
  claim_ = {context, program, "stereo_claim"};
  owner_ = {context, program, "stereo_owner"};
  mutual_ = {context, program, "stereo_mutual"};
  collect_ = {context, program, "stereo_collect"};
}

void StereoClusters::run(const DeviceEdges& left, const DeviceEdges& right, Patches& right_patches,
                         const EpipolarGeometry& geometry, const DeviceCandidates& candidates,
                         const DeviceRefined& refined, DeviceClusters& clusters, DeviceStereoEdges& result) {
  context_.begin_stage("stereo_clusters");
  const int n = left.host_count;
  const auto edges = static_cast<std::size_t>(n), right_edges = static_cast<std::size_t>(right.host_count);
  const auto capacity = static_cast<std::size_t>(candidates.capacity);
  clusters.order.ensure(context_, capacity);
  clusters.packed.ensure(context_, 3 * capacity);
  clusters.stride = candidates.capacity;
  clusters.anchor.ensure(context_, capacity);
  clusters.count.ensure(context_, edges);
  clusters.best.ensure(context_, edges);
  clusters.keep.ensure(context_, edges);
  clusters.claimed.ensure(context_, right_edges);
  clusters.owner.ensure(context_, right_edges);
  clusters.claimed.fill(0, right_edges);
  clusters.owner.fill(std::numeric_limits<cl_int>::max(), right_edges);

  const opencl::Range range(edges, local_size_);
  StereoClusterArguments arguments{};
  arguments.left = left.positions().at;
  arguments.right = right.positions().at;
  arguments.capacity = candidates.capacity;
  arguments.cluster_gap = static_cast<float>(config_.cluster_gap);
  arguments.cluster_orientation = static_cast<float>(config_.cluster_orientation_rad());
  arguments.cluster_size_max = kClusterSizeMax;
  arguments.cluster_sigma = static_cast<float>(kClusterSigma);
  arguments.similarity_min = static_cast<float>(config_.refined_ncc_min);
  arguments.mutual_radius = static_cast<float>(config_.mutual_radius);
  arguments.geometry = geometry;
  cluster_(range, arguments, candidates.first, candidates.target, right.packed, candidates.state, refined.position,
           refined.similarity, clusters.order, clusters.count, clusters.packed, clusters.anchor, clusters.best);
  claim_(range, arguments, clusters.best, clusters.anchor, clusters.packed, clusters.claimed);
  owner_(range, arguments, clusters.best, clusters.anchor, clusters.packed, clusters.claimed, clusters.owner);
  mutual_(range, arguments, clusters.best, clusters.anchor, left.packed, clusters.owner, clusters.keep);
  scan_.run(clusters.keep, n, n, clusters.keep_first, clusters.total);

  result.stride = n;
  result.left_index.ensure(context_, edges);
  result.right_index.ensure(context_, edges);
  result.packed.ensure(context_, 6 * edges);
  result.ncc.ensure(context_, edges);
  collect_(range, arguments, clusters.keep_first, clusters.best, left.packed, clusters.packed, clusters.anchor,
           result.left_index, result.right_index, result.packed, result.ncc);
  cl_int total[2];
  clusters.total.read(total, 2);
  result.count = total[0];
  right_patches.cut(result.positions(Side::right), result.right_patches);
}

}  // namespace quadedge::stages
