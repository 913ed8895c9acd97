#include "stages/device_frontend.hpp"

#include "reference/temporal_quads.hpp"
#include "stages/filter_names.hpp"
#include "stages/point_index.hpp"

namespace quadedge::stages {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180.0;

CandidateLimits stereo_limits(const StereoConfig& config) {
  return {static_cast<float>(config.ncc_min),         static_cast<float>(config.sift_max),
          static_cast<float>(config.ncc_nearly_best), static_cast<float>(config.sift_nearly_best),
          kStereoNccOrder,                            kStereoSiftOrder};
}

CandidateLimits temporal_limits(const TemporalConfig& config, bool scout) {
  if (scout) {
    return {static_cast<float>(config.scout_ncc_min),         static_cast<float>(config.scout_sift_max),
            static_cast<float>(config.scout_ncc_nearly_best), static_cast<float>(config.scout_sift_nearly_best),
            kTemporalNccOrder,                                kTemporalSiftOrder};
  }
  return {static_cast<float>(config.ncc_min),         static_cast<float>(config.sift_max),
          static_cast<float>(config.ncc_nearly_best), static_cast<float>(config.sift_nearly_best),
          kTemporalNccOrder,                          kTemporalSiftOrder};
}

}  // namespace

DeviceFrontend::Camera::Camera(opencl::Context& context, const PinholeCamera& camera, const UndistortionTable& table,
                               const Config& config)
    : undistortion(context, table, camera.width, camera.height, config.variants),
      detection(context, camera.width, camera.height, config.edges, config.variants),
      description(context, camera.width, camera.height, config.patches, config.sift, config.variants) {}

DeviceFrontend::DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config)
    : context_(context),
      config_(config),
      epipolar_(make_epipolar_geometry(rig, config.stereo)),
      left_height_(rig.left.height),
      right_height_(rig.right.height),
      left_(context, rig.left, rig.left_undistortion, config),
      right_(context, rig.right, rig.right_undistortion, config),
      stereo_candidates_(context, config.variants),
      filters_(context, config.variants),
      refinement_(context, config.stereo, config.patches.offset, config.variants),
      clustering_(context, config.stereo, config.variants),
      temporal_candidates_(context, config.variants),
      temporal_quads_(context, config.temporal, config.variants) {
  geometry_.write(context, epipolar_.packed());
  left_image_.width = rig.left.width;
  left_image_.height = rig.left.height;
  right_image_.width = rig.right.width;
  right_image_.height = rig.right.height;
}

void DeviceFrontend::process(const StereoFrame& frame) {
  DeviceStereoEdges& rig = rigs_[now_];
  left_.undistortion.run(frame.left, left_image_.pixels);
  right_.undistortion.run(frame.right, right_image_.pixels);
  left_.detection.run(left_image_.pixels, left_.edges);
  right_.detection.run(right_image_.pixels, right_.edges);
  left_.edges.read_count();
  right_.edges.read_count();
  counts_ = {};
  counts_.edges_left = left_.edges.host_count;
  counts_.edges_right = right_.edges.host_count;
  counts_.dropped_edges = left_.edges.host_dropped + right_.edges.host_dropped;
  if (tap_ != nullptr) tap_->edges(edges(false), edges(true));

  for (auto* camera : {&left_, &right_}) {
    camera->description.prepare(camera == &left_ ? left_image_.pixels : right_image_.pixels);
    camera->description.describe(camera->edges.x, camera->edges.y, camera->edges.direction, camera->edges.host_count,
                                 camera->descriptions);
  }
  if (tap_ != nullptr) tap_candidates_without_limits();
  stereo_candidates_.run(left_.edges, right_.edges, right_height_, geometry_, candidates_);
  context_.begin_stage("stereo_filters");
  filters_.run(left_.descriptions.patches, left_.descriptions.sift, right_.descriptions.patches, right_.descriptions.sift,
               stereo_limits(config_.stereo), 1, tap_ != nullptr, candidates_);
  refinement_.run(left_image_, right_image_, left_.edges, right_.edges, geometry_, candidates_, refined_);
  clustering_.run(left_.edges, right_.edges, left_.descriptions, right_.descriptions, right_.description, geometry_,
                  candidates_, refined_, clusters_, rig);
  current_ = rig.read();
  if (tap_ != nullptr) tap_stereo();
}

void DeviceFrontend::keep(bool as_key) {
  previous_rig_ = now_;
  previous_ = current_;
  if (as_key) {
    key_rig_ = now_;
    key_ = current_;
  }
  while (now_ == previous_rig_ || now_ == key_rig_) now_ = (now_ + 1) % 3;
}

void DeviceFrontend::match_side(int side, Base base, const TemporalSearch& search, DeviceCandidates& candidates) {
  const DeviceStereoEdges& current = rigs_[now_];
  const DeviceStereoEdges& before = rigs_[base == Base::key ? key_rig_ : previous_rig_];
  const PlacedEdges& predicted = side == 0 ? search.left : search.right;
  DevicePlaces& places = predicted_[side];
  places.x.write(context_, predicted.x);
  places.y.write(context_, predicted.y);
  places.direction.write(context_, predicted.direction);
  places.count = static_cast<int>(predicted.x.size());
  temporal_candidates_.run(places, search.step, current, side, side == 0 ? left_index_ : right_index_,
                           side == 0 ? left_height_ : right_height_, search.radius,
                           static_cast<float>(config_.temporal.orientation * kDegree), candidates);
  context_.begin_stage("temporal_filters");
  filters_.run(side == 0 ? before.left_patches : before.right_patches, side == 0 ? before.left_sift : before.right_sift,
               side == 0 ? current.left_patches : current.right_patches, side == 0 ? current.left_sift : current.right_sift,
               temporal_limits(config_.temporal, search.scout), search.step, tap_ != nullptr, candidates);
  if (tap_ != nullptr) tap_temporal(side, search);
}

TemporalMatches DeviceFrontend::match(Base base, const TemporalSearch& search) {
  const auto left_index = make_point_index(current_.left_x, current_.left_y, left_height_);
  const auto right_index = make_point_index(current_.right_x, current_.right_y, right_height_);
  left_index_.row_first.write(context_, left_index.row_first);
  left_index_.order.write(context_, left_index.order);
  right_index_.row_first.write(context_, right_index.row_first);
  right_index_.order.write(context_, right_index.order);
  if (tap_ != nullptr) {
    tap_->temporal_search({search.left.x, search.left.y, search.left.direction}, {search.right.x, search.right.y, search.right.direction},
                          search.radius, search.step);
  }
  match_side(0, base, search, temporal_left_);
  match_side(1, base, search, temporal_right_);
  counts_.temporal_left = temporal_left_.living_rows();
  counts_.temporal_right = temporal_right_.living_rows();
  temporal_quads_.agree(temporal_left_, temporal_right_);
  if (tap_ != nullptr) {
    tap_->temporal_filter(reference::kAgreementOrder, kTemporalFilters[reference::kAgreementOrder], 0,
                          temporal_left_.alive_after(reference::kAgreementOrder, nullptr));
  }
  TemporalMatches matches = temporal_quads_.collect(rigs_[now_], current_, search, predicted_[0], temporal_left_);
  if (tap_ != nullptr) tap_->quads(matches);
  return matches;
}

EdgeSet DeviceFrontend::edges(bool right) {
  return right ? right_.edges.read(right_height_) : left_.edges.read(left_height_);
}

}  // namespace quadedge::stages
