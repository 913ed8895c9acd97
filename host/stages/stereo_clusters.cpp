#include "stages/stereo_clusters.hpp"

#include "common/stereo_constants.hpp"
#include "opencl/variants.hpp"

namespace quadedge::stages {

StereoClusters::StereoClusters(opencl::Context& context, const StereoConfig& config,
                               const std::map<std::string, std::string>& variants)
    : context_(context), config_(config) {
  const auto& variant = opencl::choose_variant("stereo_clusters", context, variants);
  local_size_ = static_cast<std::size_t>(variant.local_size);
  const auto program = variant.program(context);
  cluster_ = {context, program, "stereo_clusters"};
}

void StereoClusters::run(const DeviceEdges& left, const DeviceEdges& right, const DeviceCandidates& candidates,
                         const DeviceRefined& refined, DeviceClusters& clusters) {
  context_.begin_stage("stereo_clusters");
  const auto edges = static_cast<std::size_t>(left.host_count);
  const auto capacity = static_cast<std::size_t>(candidates.capacity);
  clusters.order.ensure(context_, capacity);
  clusters.packed.ensure(context_, 3 * capacity);
  clusters.stride = candidates.capacity;
  clusters.anchor.ensure(context_, capacity);
  clusters.count.ensure(context_, edges);

  StereoClusterArguments arguments{};
  arguments.left = left.positions().at;
  arguments.right = right.positions().at;
  arguments.capacity = candidates.capacity;
  arguments.cluster_gap = static_cast<float>(config_.cluster_gap);
  arguments.cluster_orientation = static_cast<float>(config_.cluster_orientation_rad());
  arguments.cluster_size_max = kClusterSizeMax;
  arguments.cluster_sigma = static_cast<float>(kClusterSigma);
  cluster_(opencl::Range(edges, local_size_), arguments, candidates.first, candidates.target, right.packed,
           candidates.state, refined.position, refined.similarity, clusters.order, clusters.count, clusters.packed,
           clusters.anchor);
}

}  // namespace quadedge::stages
