/// \file device_frontend.cpp  Enqueues the stages in order; the host waits only for counts and results.
#include "edges/device_frontend.hpp"

#include <algorithm>
#include <numeric>

#include "common/layouts.hpp"
#include "common/matching_constants.hpp"
#include "edges/memory_fit.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"

namespace quadedge::frontend {

DeviceFrameEdges::DeviceFrameEdges(const StereoRig& calibration) {
  on_device.left_image.width = calibration.left.width;
  on_device.left_image.height = calibration.left.height;
  on_device.right_image.width = calibration.right.width;
  on_device.right_image.height = calibration.right.height;
}

DeviceFrontend::Camera::Camera(opencl::Context& context, const PinholeCamera& camera, const UndistortionTable& table,
                               const PixelMask& hidden, int max_value, const Config& config)
    : undistortion(context, table, camera.width, camera.height, config.variants, max_value),
      plane(context, camera.width, camera.height, config.edges.sigma, max_value),
      detection(context, camera.width, camera.height, config.edges, config.variants),
      mask(context, hidden, config.edges.margin, detection.maxima()),
      patches(context, camera.width, camera.height, config.patches, config.variants, max_value),
      sift(context, camera.width, camera.height, config.variants, max_value) {}

DeviceFrontend::DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config)
    : StagedFrontend(rig, config),
      context_(context),
      left_(context, rig.left, rig.left_undistortion, rig.left_mask, rig.max_value, config),
      right_(context, rig.right, rig.right_undistortion, rig.right_mask, rig.max_value, config),
      threshold_(context, config.edges, config.variants),
      smoothed_threshold_(context, config.edges, config.variants),
      smoothing_(context, config.variants, rig.max_value),
      noise_gate_(rig, config.edges),
      selection_(context, config.edges, left_.detection.maxima()),
      stereo_candidates_(context, config.variants),
      filters_(context, config.variants),
      refinement_(context, config.stereo, config.patches.offset, config.variants, rig.max_value),
      clustering_(context, config.variants),
      coarse_(context, config.variants, rig.max_value),
      relaxation_(context, rig.left.width, rig.left.height, config.stereo, config.variants),
      mutual_(context, config.stereo, config.variants),
      point_index_(context, config.variants),
      temporal_candidates_(context, config.variants),
      temporal_quads_(context, config.temporal, config.variants),
      temporal_match_(context, config.temporal, config.variants),
      wide_description_(context, rig.left.width, rig.left.height, config.variants, rig.max_value),
      global_matching_(context, config.variants),
      left_index_(rig.left.width, rig.left.height),
      right_index_(rig.right.width, rig.right.height) {
  std::vector<cl_int> itself(static_cast<std::size_t>(config.edges.max_edges));
  std::iota(itself.begin(), itself.end(), 0);
  itself_.write(context, itself);
}

void DeviceFrontend::measure(const stages::DeviceStereoEdges& stereo_edges, stages::EdgeThreshold& threshold,
                             float known_noise) {
  context_.begin_stage("edge_detection");
  left_.plane.prepare(stereo_edges.left_image.pixels);
  right_.plane.prepare(stereo_edges.right_image.pixels);
  threshold.run(left_.plane, &right_.plane, known_noise);
  used_threshold_ = &threshold;
}

bool DeviceFrontend::smooth_if_noisy(FrameEdges& current) {
  if (is_smoothed_) return false;
  is_smoothed_ = noise_gate_.judge(threshold_.host_noise(), threshold_.host_gradient());
  if (!is_smoothed_) return false;
  stages::DeviceStereoEdges& stereo_edges = own(current).on_device;
  left_.undistortion.smooth(smoothing_, stereo_edges.left_image.pixels, smoothed_left_);
  right_.undistortion.smooth(smoothing_, stereo_edges.right_image.pixels, smoothed_right_);
  measure(stereo_edges, smoothed_threshold_, static_cast<float>(noise_gate_.smoothed_noise()));
  return true;
}

/// Without noise the host does not wait for its measurement before the edges are found.
void DeviceFrontend::detect(FrameEdges& current) {
  do {
    find_edges();
  } while (smooth_if_noisy(current));
  counts_.edge_threshold = used_threshold_->host_threshold();
  current.edges_spacing = std::max(selection_.host_spacing(), static_cast<double>(kClosestSelection));
  counts_.edges_left = left_.edges.host_count;
  counts_.edges_right = right_.edges.host_count;
  counts_.dropped_edges = left_.edges.host_dropped + right_.edges.host_dropped;
}

void DeviceFrontend::find_edges() {
  left_.detection.find_maxima(left_.plane, used_threshold_->values());
  right_.detection.find_maxima(right_.plane, used_threshold_->values());
  context_.flush();
  left_.mask.run(left_.detection.maxima());
  right_.mask.run(right_.detection.maxima());
  selection_.run(selection_arguments(calibration_, Side::left),
                 selection_arguments(calibration_, Side::right, rows().error()), left_.detection.maxima(),
                 right_.detection.maxima());
  left_.detection.take_directions(left_.plane, left_.edges);
  right_.detection.take_directions(right_.plane, right_.edges);
  used_threshold_->request();
  selection_.request();
  left_.edges.request_count();
  right_.edges.request_count();
  context_.finish();
}

FrameEdgesHandle DeviceFrontend::process(const StereoFrame& frame) {
  const opencl::CopyGuard guard(context_);  // of the images, which belong to the caller
  return StagedFrontend::process(frame);
}

FrameEdges& DeviceFrontend::start(const StereoFrame& frame) {
  DeviceFrameEdges& current = frames_.next(calibration_);
  left_.undistortion.run(frame.left, current.on_device.left_image.pixels);
  right_.undistortion.run(frame.right, current.on_device.right_image.pixels);
  is_smoothed_ = false;
  measure(current.on_device, threshold_, -1);
  if (noise_gate_.is_open()) {
    threshold_.request();
    context_.finish();
    smooth_if_noisy(current);
  }
  return current;
}

void DeviceFrontend::describe(const FrameEdges& current, bool by_sift) {
  const stages::DeviceStereoEdges& stereo_edges = own(current).on_device;
  left_.patches.prepare(stereo_edges.left_image.pixels);
  right_.patches.prepare(stereo_edges.right_image.pixels);
  if (!by_sift) return;
  left_.sift.prepare(stereo_edges.left_image.pixels);
  right_.sift.prepare(stereo_edges.right_image.pixels);
  left_.sift.describe(left_.edges.positions(), left_sift_);
  right_.sift.describe(right_.edges.positions(), right_sift_);
}

const stages::CoarseDisparity* DeviceFrontend::coarse_disparity(const stages::DeviceStereoEdges& stereo_edges,
                                                                const std::optional<CoarseDisparityArguments>& search) {
  if (!search ||
      !fits_beside(calibration_, config_, stages::CoarseDisparity::bytes(*search), context_.limits().memory_bytes))
    return nullptr;
  coarse_.run(stereo_edges.left_image, stereo_edges.right_image, *search);
  return &coarse_;
}

RelaxationTally DeviceFrontend::find_stereo_edges(FrameEdges& current, const EpipolarGeometry& geometry,
                                                  const DisparityProbe& probe,
                                                  const std::optional<CoarseDisparityArguments>& coarse) {
  stages::DeviceStereoEdges& stereo_edges = own(current).on_device;
  stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height, geometry, probe, candidates_);
  left_.patches.cut(left_.edges.positions(), candidates_.counts, stereo_edges.left_patches);
  right_.patches.cut(right_.edges.positions(), stereo_candidates_.listed(), right_patches_);
  filters_.run({stereo_edges.left_patches, itself_, left_sift_}, {right_patches_, itself_, right_sift_},
               stereo_limits(config_.stereo), 1, tap_ != nullptr, candidates_);
  refinement_.run(left_.patches.corners(), right_.patches.corners(), left_.edges, right_.edges,
                  stereo_edges.left_patches, geometry, candidates_, refined_);
  clustering_.run(left_.edges, right_.edges, candidates_, refined_, clusters_);
  context_.flush();
  relaxation_.run(left_.edges, geometry, candidates_, clusters_, relaxed_, coarse_disparity(stereo_edges, coarse));
  mutual_.run(left_.edges, right_.edges, right_.patches, range_.geometry(), corrects_rows() ? &geometry : nullptr,
              clusters_, relaxed_, stereo_edges, current.edges);
  return relaxed_.host_tally;
}

void DeviceFrontend::finish(FrameEdges& current) {
  own(current).on_device.has_sift = false;
  indexed_ = described_ = nullptr;
  context_.flush();  // the right patches, while the host goes on
}

void DeviceFrontend::index_current(const DeviceFrameEdges& current) {
  if (indexed_ == &current) return;
  const stages::DeviceStereoEdges& edges = current.on_device;
  point_index_.run(edges.positions(Side::left), edges.positions(Side::right), left_index_, right_index_);
  indexed_ = &current;
}

stages::DescribedEdges DeviceFrontend::described(const stages::DeviceStereoEdges& stereo_edges, Side side) const {
  if (side == Side::right) return {stereo_edges.right_patches, itself_, stereo_edges.right_sift};
  return {stereo_edges.left_patches, stereo_edges.left_index, stereo_edges.left_sift};
}

void DeviceFrontend::describe_by_sift(FrameEdges& frame_edges) {
  stages::DeviceStereoEdges& edges = own(frame_edges).on_device;
  if (edges.has_sift) return;
  left_.sift.prepare(edges.left_image.pixels);
  left_.sift.describe(edges.positions(Side::left), edges.left_sift);
  right_.sift.prepare(edges.right_image.pixels);
  right_.sift.describe(edges.positions(Side::right), edges.right_sift);
  edges.has_sift = true;
}

void DeviceFrontend::match_side(Side side, const DeviceFrameEdges& base, const DeviceFrameEdges& current,
                                const TemporalSearch& search, stages::DeviceCandidates& candidates) {
  temporal_candidates_.run(predicted_.list(index_of(side)), search.step, index(side), search.radius,
                           static_cast<float>(kTemporalOrientation), candidates);
  filters_.run(described(base.on_device, side), described(current.on_device, side),
               temporal_limits(config_.temporal, search), search.step, tap_ != nullptr, candidates);
}

void DeviceFrontend::match_by_lists(const DeviceFrameEdges& base, const DeviceFrameEdges& current,
                                    const TemporalSearch& search, TemporalMatches& matches) {
  match_side(Side::left, base, current, search, temporal_left_);
  match_side(Side::right, base, current, search, temporal_right_);
  const int alive_left = temporal_left_.living_rows(), alive_right = temporal_right_.living_rows();
  temporal_quads_.agree(temporal_left_, temporal_right_);
  matches = temporal_quads_.collect(current.on_device, current.edges, search, predicted_.list(index_of(Side::left)),
                                    temporal_left_);
  matches.alive_left = alive_left;
  matches.alive_right = alive_right;
  if (tap_ != nullptr) tap_temporal(search);
}

void DeviceFrontend::search_in_time(FrameEdges& base_edges, FrameEdges& current_edges, const TemporalSearch& search,
                                    TemporalMatches& matches) {
  const DeviceFrameEdges &base = own(base_edges), &current = own(current_edges);
  const opencl::CopyGuard guard(context_);  // of the predictions
  index_current(current);
  predicted_.write(context_, {search.left, search.right});
  // A tap sees the lists, which the fused kernel lacks.
  const bool found = tap_ == nullptr && temporal_match_.serves(search) &&
                     temporal_match_.run(predicted_, search, base.on_device, current.on_device, left_index_,
                                         right_index_, current.edges, matches);
  if (!found) match_by_lists(base, current, search, matches);
}

stages::DeviceWideEdges DeviceFrontend::describe_widely(const DeviceFrameEdges& frame_edges, const WideSubset& subset,
                                                        WideSide& side) {
  if (frame_edges.is_restored) return {frame_edges.on_device, 1, frame_edges.on_device.count, frame_edges.wide};
  const bool is_given = &subset.edges != &frame_edges.edges;
  if (is_given) {
    side.packed.clear();
    for (const auto* column : {&subset.edges.left_x, &subset.edges.left_y, &subset.edges.left_direction})
      side.packed.insert(side.packed.end(), column->begin(), column->end());
    side.given.reserve(context_, subset.edges.size());
    side.given.count = side.given.stride = static_cast<cl_int>(subset.edges.size());
    side.given.packed.write(side.packed.data(), side.packed.size());
  }
  const bool is_known = &side == &wide_now_ && described_ == &frame_edges && global_step_ == subset.step;
  const stages::DeviceStereoEdges& edges = is_given ? side.given : frame_edges.on_device;
  if (!is_known) {
    wide_description_.prepare(frame_edges.on_device.left_image.pixels, small_);
    side.rows = wide_description_.describe(small_, edges, subset.step, side.descriptors);
  }
  if (&side == &wide_now_) {
    described_ = &frame_edges;
    global_step_ = subset.step;
  }
  return {edges, subset.step, side.rows, side.descriptors};
}

TemporalMatches DeviceFrontend::search_globally(const FrameEdges& base, const WideSubset& of_base,
                                                const FrameEdges& current_edges, const WideSubset& of_current) {
  const DeviceFrameEdges& current = own(current_edges);
  const opencl::CopyGuard guard(context_);  // until the given edges have been copied
  // Descriptions of every step-th edge of a current frame serve all of its searches in a row.
  WideSide& now = &of_current.edges == &current.edges ? wide_now_ : wide_some_;
  const auto earlier = describe_widely(own(base), of_base, wide_before_);
  return global_matching_.run(earlier, describe_widely(current, of_current, now), of_current.edges);
}

KeptFrameEdges DeviceFrontend::keep() {
  const DeviceFrameEdges& current = frames_.current();
  const stages::DeviceStereoEdges& stereo_edges = current.on_device;
  const stages::DeviceWideEdges described =
      describe_widely(current, about(static_cast<int>(kKeptEdges), current), wide_now_);
  const auto wide = described.descriptors.read(static_cast<std::size_t>(described.rows) * kWideBytes);
  const auto left = stereo_edges.left_patches.read(static_cast<std::size_t>(left_.edges.host_count) * kEdgePatchBytes);
  const auto right = stereo_edges.right_patches.read(current.edges.size() * kEdgePatchBytes);
  return keep_edges(current, {described.step, wide}, left, current.edges.left_index, right);
}

void DeviceFrontend::load(const KeptFrameEdges& kept, FrameEdges& restored) {
  const std::size_t count = kept.edges.size();
  stages::DeviceStereoEdges& stereo_edges = own(restored).on_device;
  stereo_edges.reserve(context_, count);
  stereo_edges.count = stereo_edges.stride = static_cast<cl_int>(count);
  stereo_edges.has_sift = false;
  stereo_edges.left_index.write(kept.edges.left_index.data(), count);
  std::vector<cl_float> packed;
  for (const auto column : kStereoColumns)
    packed.insert(packed.end(), (kept.edges.*column).begin(), (kept.edges.*column).end());
  stereo_edges.packed.write(packed.data(), packed.size());
  const KeptPatches patches = unpack_patches(kept);
  stereo_edges.left_patches.write(context_, patches.left);
  stereo_edges.right_patches.write(context_, patches.right);
  own(restored).wide.write(context_, unpack_wide(kept));
}

EdgeSet DeviceFrontend::edges(Side side) {
  if (side == Side::right) return right_.edges.read(calibration_.right.height);
  return left_.edges.read(calibration_.left.height);
}

}  // namespace quadedge::frontend
