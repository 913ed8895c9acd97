#include "frontend/device_frontend.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "common/coarse_search.hpp"
#include "common/epipolar_rows.hpp"
#include "common/layouts.hpp"
#include "frontend/global_search.hpp"
#include "frontend/memory_fit.hpp"

namespace quadedge::frontend {

DeviceRig::DeviceRig(const StereoRig& calibration) {
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
      sift(context, camera.width, camera.height, config.sift, config.variants, max_value) {}

DeviceFrontend::DeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config)
    : Frontend(rig, config.stereo),
      context_(context),
      config_(config),
      range_(rig, config),
      gate_(config.stereo, coarse_search(rig, range_.geometry()).has_value()),
      left_(context, rig.left, rig.left_undistortion, rig.left_mask, rig.max_value, config),
      right_(context, rig.right, rig.right_undistortion, rig.right_mask, rig.max_value, config),
      threshold_(context, config.edges, config.variants),
      selection_(context, config.edges, left_.detection.maxima()),
      stereo_candidates_(context, config.variants),
      filters_(context, config.variants),
      refinement_(context, config.stereo, config.patches.offset, config.variants, rig.max_value),
      clustering_(context, config.stereo, config.variants),
      coarse_(context, config.variants, rig.max_value),
      relaxation_(context, rig.left.width, rig.left.height, config.stereo, config.variants),
      mutual_(context, config.stereo, config.variants),
      point_index_(context, config.variants),
      temporal_candidates_(context, config.variants),
      temporal_quads_(context, config.temporal, config.variants),
      temporal_match_(context, config.temporal, config.variants),
      wide_description_(context, rig.left.width, rig.left.height, config.variants, rig.max_value),
      wide_matching_(context, config.temporal, config.variants),
      left_index_(rig.left.width, rig.left.height),
      right_index_(rig.right.width, rig.right.height) {
  std::vector<cl_int> itself(static_cast<std::size_t>(config.edges.max_edges));
  std::iota(itself.begin(), itself.end(), 0);
  itself_.write(context, itself);
}

void DeviceFrontend::detect(DeviceRig& current) {
  const stages::DeviceStereoEdges& rig = current.on_device;
  context_.begin_stage("edge_detection");
  left_.plane.prepare(rig.left_image.pixels);
  right_.plane.prepare(rig.right_image.pixels);
  threshold_.run(left_.plane, &right_.plane);
  left_.detection.find_maxima(left_.plane, threshold_.values());
  right_.detection.find_maxima(right_.plane, threshold_.values());
  context_.flush();
  left_.mask.run(left_.detection.maxima());
  right_.mask.run(right_.detection.maxima());
  selection_.run(selection_arguments(calibration_, Side::left, config_.stereo),
                 selection_arguments(calibration_, Side::right, config_.stereo, rectification_.error()),
                 left_.detection.maxima(), right_.detection.maxima());
  left_.detection.take_directions(left_.plane, left_.edges);
  right_.detection.take_directions(right_.plane, right_.edges);
  threshold_.request();
  selection_.request();
  left_.edges.request_count();
  right_.edges.request_count();
  context_.finish();
  counts_ = {};
  counts_.edge_threshold = threshold_.host_threshold();
  current.edges_spacing = std::max(selection_.host_spacing(), static_cast<double>(kClosestSelection));
  counts_.edges_left = left_.edges.host_count;
  counts_.edges_right = right_.edges.host_count;
  counts_.dropped_edges = left_.edges.host_dropped + right_.edges.host_dropped;
}

RigHandle DeviceFrontend::process(const StereoFrame& frame) {
  const opencl::CopyGuard guard(context_);  // of the images, which belong to the caller
  DeviceRig& current = rigs_.next(calibration_);
  stages::DeviceStereoEdges& rig = current.on_device;
  left_.undistortion.run(frame.left, rig.left_image.pixels);
  right_.undistortion.run(frame.right, rig.right_image.pixels);
  rectification_.start_frame();
  do {
    detect(current);
    left_.patches.prepare(rig.left_image.pixels);
    right_.patches.prepare(rig.right_image.pixels);
    if (tap_ != nullptr || config_.stereo.sift_max > 0) {
      left_.sift.prepare(rig.left_image.pixels);
      right_.sift.prepare(rig.right_image.pixels);
      left_.sift.describe(left_.edges.positions(), left_sift_);
      right_.sift.describe(right_.edges.positions(), right_sift_);
    }
    range_.start_frame();
    while (!find_stereo_edges(current)) {
    }
  } while (!rectification_.suffices(frame, current.edges));
  counts_.disparity_range = range_.disparity();
  counts_.epipolar_correction = rectification_.error().largest();
  rig.has_sift = false;
  current.is_restored = false;
  indexed_ = false;
  wide_rows_ = -1;
  context_.flush();  // the right patches, while the host goes on
  if (tap_ != nullptr) {
    tap_->edges(edges(Side::left), edges(Side::right));
    tap_candidates_without_limits();
    tap_stereo();
  }
  return rigs_.current_handle();
}

const stages::CoarseDisparity* DeviceFrontend::witness(const stages::DeviceStereoEdges& rig) {
  if (!gate_.is_open()) return nullptr;
  const auto search = coarse_search(calibration_, range_.geometry());
  if (!search ||
      !fits_beside(calibration_, config_, stages::CoarseDisparity::bytes(*search), context_.limits().memory_bytes))
    return nullptr;
  coarse_.run(rig.left_image, rig.right_image, *search);
  return &coarse_;
}

bool DeviceFrontend::find_stereo_edges(DeviceRig& current) {
  stages::DeviceStereoEdges& rig = current.on_device;
  const EpipolarGeometry geometry = corrected(range_.geometry(), rectification_.error(), calibration_.left);
  stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height, geometry,
                         range_.probe(left_.edges.host_count), candidates_);
  left_.patches.cut(left_.edges.positions(), candidates_.counts, rig.left_patches);
  right_.patches.cut(right_.edges.positions(), stereo_candidates_.listed(), right_patches_);
  filters_.run({rig.left_patches, itself_, left_sift_}, {right_patches_, itself_, right_sift_},
               stereo_limits(config_.stereo), 1, tap_ != nullptr, candidates_);
  refinement_.run(left_.patches.corners(), right_.patches.corners(), left_.edges, right_.edges, rig.left_patches,
                  geometry, candidates_, refined_);
  clustering_.run(left_.edges, right_.edges, candidates_, refined_, clusters_);
  context_.flush();
  relaxation_.run(left_.edges, geometry, candidates_, clusters_, relaxed_, witness(rig));
  mutual_.run(left_.edges, right_.edges, right_.patches, range_.geometry(), clusters_, relaxed_, owners_, rig,
              current.edges);
  const bool range_suffices = range_.suffices(current.edges, left_.edges.host_count);
  return gate_.suffices(relaxed_.host_tally) && range_suffices;
}

void DeviceFrontend::index_current() {
  if (indexed_) return;
  const stages::DeviceStereoEdges& edges = rigs_.current().on_device;
  point_index_.run(edges.positions(Side::left), edges.positions(Side::right), left_index_, right_index_);
  indexed_ = true;
}

stages::DescribedEdges DeviceFrontend::described(const stages::DeviceStereoEdges& rig, Side side) const {
  if (side == Side::right) return {rig.right_patches, itself_, rig.right_sift};
  return {rig.left_patches, rig.left_index, rig.left_sift};
}

void DeviceFrontend::describe_by_sift(DeviceRig& rig) {
  if (rig.on_device.has_sift) return;
  stages::DeviceStereoEdges& edges = rig.on_device;
  left_.sift.prepare(edges.left_image.pixels);
  left_.sift.describe(edges.positions(Side::left), edges.left_sift);
  right_.sift.prepare(edges.right_image.pixels);
  right_.sift.describe(edges.positions(Side::right), edges.right_sift);
  edges.has_sift = true;
}

void DeviceFrontend::match_side(Side side, DeviceRig& base, const TemporalSearch& search,
                                stages::DeviceCandidates& candidates) {
  DeviceRig& current = rigs_.current();
  temporal_candidates_.run(predicted_.list(index_of(side)), search.step, index(side), search.radius,
                           static_cast<float>(config_.temporal.orientation_rad()), candidates);
  const FilterLimits limits = temporal_limits(config_.temporal, search);
  if (limits.sift_max > 0) {
    describe_by_sift(base);
    describe_by_sift(current);
  }
  filters_.run(described(base.on_device, side), described(current.on_device, side), limits, search.step,
               tap_ != nullptr, candidates);
}

void DeviceFrontend::match_by_lists(DeviceRig& base, const TemporalSearch& search, TemporalMatches& matches) {
  match_side(Side::left, base, search, temporal_left_);
  match_side(Side::right, base, search, temporal_right_);
  counts_.temporal_left = temporal_left_.living_rows();
  counts_.temporal_right = temporal_right_.living_rows();
  temporal_quads_.agree(temporal_left_, temporal_right_);
  const DeviceRig& current = rigs_.current();
  matches = temporal_quads_.collect(current.on_device, current.edges, search, predicted_.list(index_of(Side::left)),
                                    temporal_left_);
  if (tap_ == nullptr) return;
  tap_temporal(search);
}

bool DeviceFrontend::match_fused(DeviceRig& base, const TemporalSearch& search, TemporalMatches& matches) {
  DeviceRig& current = rigs_.current();
  const auto alive = temporal_match_.run(predicted_, search, base.on_device, current.on_device, left_index_,
                                         right_index_, current.edges, matches);
  if (!alive) return false;
  counts_.temporal_left = alive->left;
  counts_.temporal_right = alive->right;
  return true;
}

void DeviceFrontend::match(const Rig& base_rig, const TemporalSearch& search, TemporalMatches& matches) {
  DeviceRig& base = rigs_.own(base_rig);
  const opencl::CopyGuard guard(context_);  // of the predictions
  index_current();
  predicted_.write(context_, {search.left, search.right});
  if (tap_ != nullptr) {
    tap_search(base, search);
    describe_by_sift(base);
    describe_by_sift(rigs_.current());
  }
  const bool fused =
      tap_ == nullptr && temporal_match_.serves(search);  // a tap sees the lists, which a fused one lacks
  if (!fused || !match_fused(base, search, matches)) match_by_lists(base, search, matches);
  matches.search = counts_.searches++;
  if (tap_ != nullptr) tap_->quads(matches);
}

stages::DeviceWideEdges DeviceFrontend::describe_current(int wanted) {
  const stages::DeviceStereoEdges& current = rigs_.current().on_device;
  const int step = wide_step(static_cast<std::size_t>(current.count), wanted);
  if (wide_rows_ < 0 || wide_step_ != step) {
    wide_description_.prepare(current.left_image.pixels, small_);
    wide_rows_ = wide_description_.describe(small_, current, step, wide_now_);
    wide_step_ = step;
  }
  return {current, step, wide_rows_, wide_now_};
}

void DeviceFrontend::match_globally(const Rig& base, int edges, TemporalMatches& matches) {
  const DeviceRig& own = rigs_.own(base);
  const stages::DeviceStereoEdges& before = own.on_device;
  const StereoEdges& current = rigs_.current().edges;
  if (own.is_restored) {
    matches = wide_matching_.run({before, 1, before.count, own.wide}, describe_current(2 * edges), current);
    return;
  }
  const int step = wide_step(static_cast<std::size_t>(before.count), edges);
  wide_description_.prepare(before.left_image.pixels, small_);
  const int rows = wide_description_.describe(small_, before, step, wide_before_);
  matches = wide_matching_.run({before, step, rows, wide_before_}, describe_current(2 * edges), current);
}

void DeviceFrontend::match_globally(const Rig& base, const GlobalSearch& among, TemporalMatches& matches) {
  matches.clear();
  const DeviceRig &own = rigs_.own(base), &current = rigs_.current();
  const StereoEdges before = edges_of(own.edges, among.of_base), now = edges_of(current.edges, among.of_current);
  if ((!own.is_restored && before.size() == 0) || now.size() == 0) return;
  std::vector<cl_float> packed[2];
  const opencl::CopyGuard guard(context_);  // until both lists have been copied
  const auto describe = [&](const StereoEdges& edges, const stages::DeviceImage& image, std::vector<cl_float>& values,
                            stages::DeviceStereoEdges& some, opencl::Buffer<cl_uchar>& descriptors) {
    for (const auto* column : {&edges.left_x, &edges.left_y, &edges.left_direction})
      values.insert(values.end(), column->begin(), column->end());
    some.reserve(context_, edges.size());
    some.count = some.stride = static_cast<cl_int>(edges.size());
    some.packed.write(values.data(), values.size());
    wide_description_.prepare(image.pixels, small_);
    return stages::DeviceWideEdges{some, 1, wide_description_.describe(small_, some, 1, descriptors), descriptors};
  };
  const auto described = describe(now, current.on_device.left_image, packed[0], some_now_, wide_some_);
  if (own.is_restored) {
    matches = wide_matching_.run({own.on_device, 1, own.on_device.count, own.wide}, described, now);
  } else {
    matches = wide_matching_.run(describe(before, own.on_device.left_image, packed[1], some_before_, wide_before_),
                                 described, now);
    renumber(among.of_base, matches.previous);
  }
  renumber(among.of_current, matches.current);
}

KeptRig DeviceFrontend::keep() {
  const DeviceRig& current = rigs_.current();
  const stages::DeviceStereoEdges& rig = current.on_device;
  const stages::DeviceWideEdges described = describe_current(2 * config_.temporal.wide_edges);
  const auto wide = described.descriptors.read(static_cast<std::size_t>(described.rows) * kWideBytes);
  const auto left = rig.left_patches.read(static_cast<std::size_t>(left_.edges.host_count) * kEdgePatchBytes);
  const auto right = rig.right_patches.read(current.edges.size() * kEdgePatchBytes);
  return keep_edges(current, {described.step, wide}, left, current.edges.left_index, right);
}

RigHandle DeviceFrontend::restore(const KeptRig& kept) {
  if (tap_ != nullptr) throw std::logic_error("a restored rig has no images, which a tap needs");
  const std::shared_ptr<DeviceRig>& restored = rigs_.restored(calibration_);
  restored->start(kept.frame);
  restored->edges = kept.edges;
  restored->edges_spacing = kept.edges_spacing;
  restored->own_calibration = kept.own_calibration;
  restored->is_restored = true;
  const std::size_t count = kept.edges.size();
  stages::DeviceStereoEdges& rig = restored->on_device;
  rig.reserve(context_, count);
  rig.count = rig.stride = static_cast<cl_int>(count);
  rig.has_sift = false;
  rig.left_index.write(kept.edges.left_index.data(), count);
  std::vector<cl_float> packed;
  for (const auto* column : {&kept.edges.left_x, &kept.edges.left_y, &kept.edges.left_direction, &kept.edges.right_x,
                             &kept.edges.right_y, &kept.edges.right_direction, &kept.edges.left_scale_drift})
    packed.insert(packed.end(), column->begin(), column->end());
  rig.packed.write(packed.data(), packed.size());
  const KeptPatches patches = unpack_patches(kept);
  rig.left_patches.write(context_, patches.left);
  rig.right_patches.write(context_, patches.right);
  restored->wide.write(context_, unpack_wide(kept));
  return restored;
}

EdgeSet DeviceFrontend::edges(Side side) {
  if (side == Side::right) return right_.edges.read(calibration_.right.height);
  return left_.edges.read(calibration_.left.height);
}

}  // namespace quadedge::frontend
