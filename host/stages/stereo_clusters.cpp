#include "stages/stereo_clusters.hpp"

#include <limits>

#include "opencl/variants.hpp"

namespace quadedge::stages {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

}  // namespace

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

void StereoClusters::run(const DeviceEdges& left, const DeviceEdges& right, EdgeDescription& right_description,
                         const opencl::Buffer<cl_float>& geometry, const DeviceCandidates& candidates,
                         const DeviceRefined& refined, DeviceClusters& clusters, DeviceStereoEdges& result) {
  context_.begin_stage("stereo_clusters");
  const int n = left.host_count;
  const auto edges = static_cast<std::size_t>(n), right_edges = static_cast<std::size_t>(right.host_count);
  const auto capacity = static_cast<std::size_t>(candidates.capacity);
  clusters.order.ensure(context_, capacity);
  clusters.position.ensure(context_, capacity);
  clusters.direction.ensure(context_, capacity);
  clusters.anchor.ensure(context_, capacity);
  clusters.similarity.ensure(context_, capacity);
  clusters.count.ensure(context_, edges);
  clusters.best.ensure(context_, edges);
  clusters.keep.ensure(context_, edges);
  clusters.claimed.ensure(context_, right_edges);
  clusters.owner.ensure(context_, right_edges);
  clusters.claimed.fill(0, right_edges);
  clusters.owner.fill(std::numeric_limits<cl_int>::max(), right_edges);

  const opencl::Range range(edges, local_size_);
  cluster_(range, candidates.first, candidates.target, candidates.capacity, n, right.direction, candidates.state,
           refined.position, refined.similarity, static_cast<float>(config_.cluster_gap),
           static_cast<float>(config_.cluster_orientation * kDegree), config_.cluster_size_max,
           static_cast<float>(config_.cluster_sigma), static_cast<float>(config_.refined_ncc_min), clusters.order,
           clusters.count, clusters.position, clusters.direction, clusters.anchor, clusters.similarity, clusters.best);
  claim_(range, clusters.best, clusters.anchor, clusters.similarity, n, clusters.claimed);
  owner_(range, clusters.best, clusters.anchor, clusters.similarity, n, clusters.claimed, clusters.owner);
  mutual_(range, clusters.best, clusters.anchor, n, left.x, left.y, static_cast<float>(config_.mutual_radius),
          clusters.owner, clusters.keep);
  scan_.run(clusters.keep, n, n, clusters.keep_first, clusters.total);

  result.stride = n;
  result.left_index.ensure(context_, edges);
  result.right_index.ensure(context_, edges);
  result.packed.ensure(context_, 6 * edges);
  result.right_x.ensure(context_, edges);
  result.right_y.ensure(context_, edges);
  result.right_direction.ensure(context_, edges);
  result.ncc.ensure(context_, edges);
  collect_(range, clusters.keep_first, n, clusters.best, left.x, left.y, left.direction, geometry, clusters.position,
           clusters.direction, clusters.anchor, clusters.similarity, result.stride, result.left_index,
           result.right_index, result.packed, result.right_x, result.right_y, result.right_direction, result.ncc);
  cl_int total[2];
  clusters.total.read(total, 2);
  result.count = total[0];
  right_description.cut_patches(result.right_x, result.right_y, result.right_direction, result.count,
                                result.right_patches);
}

}  // namespace quadedge::stages
