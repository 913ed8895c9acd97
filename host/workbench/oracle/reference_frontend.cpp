/// \file reference_frontend.cpp  Calls the plain C++ twins of the kernels, stage by stage.
#include "oracle/reference_frontend.hpp"

#include <numeric>

#include "edges/tap_lists.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/images.hpp"

namespace quadedge::frontend {
namespace {

template <class T>
std::vector<T> rows_of(const std::vector<T>& values, const std::vector<std::int32_t>& indices, std::size_t width) {
  std::vector<T> result;
  result.reserve(indices.size() * width);
  for (const auto index : indices) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(index) * width);
    result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
  }
  return result;
}

std::vector<std::uint8_t> sift_of(const Image& image, const EdgePositionsView& edges) {
  return reference::sift_descriptors(image.view(), edges.x, edges.y, edges.direction);
}

reference::WideEdges describe_widely(const ReferenceFrameEdges& frame_edges, const WideSubset& subset) {
  if (frame_edges.is_restored) return {frame_edges.edges, 1, frame_edges.wide};
  return {subset.edges, subset.step,
          reference::wide_descriptions(reference::shrink(frame_edges.left.view()), subset.edges, subset.step)};
}

}  // namespace

ReferenceFrontend::ReferenceFrontend(const StereoRig& rig, const Config& config)
    : StagedFrontend(rig, config),
      threshold_(config.edges),
      smoothed_threshold_(config.edges),
      noise_gate_(rig, config.edges) {}

FrameEdges& ReferenceFrontend::start(const StereoFrame& frame) {
  ReferenceFrameEdges& now = frames_.next();
  now.left = reference::pinhole_image(frame.left, calibration_.left_undistortion);
  now.right = reference::pinhole_image(frame.right, calibration_.right_undistortion);
  counts_.edge_threshold = threshold_.next({now.left.view(), now.right.view()});
  is_smoothed_ = noise_gate_.judge(threshold_.noise(), threshold_.gradient());
  if (is_smoothed_) {
    smoothed_left_ = reference::smoothed(frame.left);
    smoothed_right_ = reference::smoothed(frame.right);
    now.left = reference::pinhole_image(smoothed_left_.view(), calibration_.left_undistortion);
    now.right = reference::pinhole_image(smoothed_right_.view(), calibration_.right_undistortion);
    counts_.edge_threshold =
        smoothed_threshold_.next({now.left.view(), now.right.view()}, noise_gate_.smoothed_noise());
  }
  return now;
}

void ReferenceFrontend::detect(FrameEdges& current) {
  const ReferenceFrameEdges& now = own(current);
  const double threshold = counts_.edge_threshold;
  reference::ReferenceEdges left = reference::outside_mask(
      reference::detect_edges(now.left.view(), config_.edges, threshold), masks_.left, config_.edges.margin);
  reference::ReferenceEdges right = reference::outside_mask(
      reference::detect_edges(now.right.view(), config_.edges, threshold), masks_.right, config_.edges.margin);
  float spacing = 0;
  if (config_.edges.budget > 0) {
    const SelectionArguments in_left = selection_arguments(calibration_, Side::left),
                             in_right = selection_arguments(calibration_, Side::right, rows().error());
    const reference::GradientMaxima left_maxima = maxima_of(left), right_maxima = maxima_of(right);
    spacing = reference::selection_spacing(in_left, left_maxima, in_right, right_maxima, config_.edges);
    left = select_edges(left, kept_by_selection(in_left, left_maxima, spacing));
    right = select_edges(right, kept_by_selection(in_right, right_maxima, spacing));
  }
  current.edges_spacing = static_cast<double>(std::max(spacing, kClosestSelection));
  counts_.dropped_edges = 0;
  left_edges_ = reference::first_edges(left, config_.edges.max_edges, counts_.dropped_edges);
  right_edges_ = reference::first_edges(right, config_.edges.max_edges, counts_.dropped_edges);
  counts_.edges_left = static_cast<int>(left_edges_.size());
  counts_.edges_right = static_cast<int>(right_edges_.size());
}

void ReferenceFrontend::describe(const FrameEdges& current, bool by_sift) {
  const ReferenceFrameEdges& now = own(current);
  const auto describe_side = [&](const Image& image, const EdgeSet& edges, reference::EdgeDescriptions& described) {
    described.patches = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, config_.patches);
    described.sift.clear();
    if (by_sift) described.sift = sift_of(image, edges.positions());
  };
  describe_side(now.left, left_edges_, left_described_);
  describe_side(now.right, right_edges_, right_described_);
}

RelaxationTally ReferenceFrontend::find_stereo_edges(FrameEdges& current, const EpipolarGeometry& geometry,
                                                     const DisparityProbe& probe,
                                                     const std::optional<CoarseDisparityArguments>& coarse) {
  const ReferenceFrameEdges& now = own(current);
  candidates_ = reference::stereo_candidates(left_edges_, right_edges_, geometry, probe);
  scores_ = reference::candidate_filters(candidates_, left_described_, right_described_, stereo_limits(config_.stereo));
  const auto refined = reference::stereo_refinement(now.left.view(), now.right.view(), left_described_.patches,
                                                    left_edges_, right_edges_, geometry, candidates_, config_.stereo,
                                                    config_.patches.offset, scores_);
  clusters_ = reference::stereo_clusters(candidates_, scores_, refined, right_edges_);
  std::optional<reference::CoarseDisparity> coarse_disparity;
  if (coarse) coarse_disparity = reference::coarse_disparity(now.left.view(), now.right.view(), *coarse);
  relaxation_ =
      reference::stereo_relaxation(clusters_, left_edges_, geometry, calibration_.left.width, calibration_.left.height,
                                   config_.stereo, coarse_disparity ? &*coarse_disparity : nullptr);
  const auto edges_on = [&](const EpipolarGeometry& lines) {
    return reference::stereo_mutual(clusters_, relaxation_, left_edges_, lines, config_.stereo);
  };
  current.edges = edges_on(range_.geometry());
  seen_ = corrects_rows() ? edges_on(geometry) : current.edges;
  return relaxation_.tally;
}

void ReferenceFrontend::finish(FrameEdges& current) {
  ReferenceFrameEdges& now = own(current);
  const StereoEdges& edges = now.edges;
  now.wide.clear();
  now.left_descriptions = {rows_of(left_described_.patches, edges.left_index, kEdgePatchBytes), {}};
  now.right_descriptions = {
      reference::side_patches(now.right.view(), seen_.right_x, seen_.right_y, seen_.right_direction, config_.patches),
      {}};
}

void ReferenceFrontend::describe_by_sift(FrameEdges& frame_edges) {
  ReferenceFrameEdges& now = own(frame_edges);
  if (!now.left_descriptions.sift.empty()) return;
  now.left_descriptions.sift = sift_of(now.left, now.edges.positions(Side::left));
  now.right_descriptions.sift = sift_of(now.right, now.edges.positions(Side::right));
}

void ReferenceFrontend::search_in_time(FrameEdges& base, FrameEdges& current, const TemporalSearch& search,
                                       TemporalMatches& matches) {
  const ReferenceFrameEdges &before = own(base), &now = own(current);
  auto result = reference::temporal_match(
      search, now.edges,
      {before.left_descriptions, now.left_descriptions, calibration_.left.width, calibration_.left.height},
      {before.right_descriptions, now.right_descriptions, calibration_.right.width, calibration_.right.height},
      config_.temporal);
  if (tap_ != nullptr) tap_temporal(search, now, result);
  matches = std::move(result.matches);
}

TemporalMatches ReferenceFrontend::search_globally(const FrameEdges& base, const WideSubset& of_base,
                                                   const FrameEdges& current, const WideSubset& of_current) {
  return reference::find_global_matches(describe_widely(own(base), of_base), describe_widely(own(current), of_current));
}

KeptFrameEdges ReferenceFrontend::keep() {
  const ReferenceFrameEdges& now = frames_.current();
  const reference::WideEdges described = describe_widely(now, about(static_cast<int>(kKeptEdges), now));
  std::vector<std::int32_t> itself(now.edges.size());
  std::iota(itself.begin(), itself.end(), 0);
  return keep_edges(now, {described.step, described.descriptors}, now.left_descriptions.patches, itself,
                    now.right_descriptions.patches);
}

void ReferenceFrontend::load(const KeptFrameEdges& kept, FrameEdges& restored) {
  ReferenceFrameEdges& frame_edges = own(restored);
  KeptPatches patches = unpack_patches(kept);
  const std::vector<std::uint8_t> no_sift(kept.edges.size() * kEdgeSiftBytes);
  frame_edges.left_descriptions = {std::move(patches.left), no_sift};
  frame_edges.right_descriptions = {std::move(patches.right), no_sift};
  frame_edges.wide = unpack_wide(kept);
}

// What taps receive after each filter, from the candidate lists on.

void ReferenceFrontend::tap_stereo() {
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, alive_after(filter, candidates_, scores_));
  const auto tap_clusters = [&](StereoFilter filter, const auto& passes) {
    tap_->stereo_filter(filter, clusters_that(clusters_, range_.geometry(), left_edges_.x, left_edges_.y, passes));
  };
  tap_clusters(StereoFilter::refinement, [](std::size_t, std::size_t) { return true; });
  tap_clusters(StereoFilter::relaxation,
               [&](std::size_t i, std::size_t k) { return relaxation_.chosen[i] == static_cast<std::int32_t>(k); });
}

void ReferenceFrontend::tap_temporal(const TemporalSearch& search, const FrameEdges& current,
                                     const reference::TemporalMatchResult& result) {
  for (const Side side : kSides) {
    const bool is_left = side == Side::left;
    const PinholeCamera& camera = is_left ? calibration_.left : calibration_.right;
    const EdgePositionsView edges = current.edges.positions(side);
    reference::PointIndex index;
    reference::make_point_index(edges.x, edges.y, camera.width, camera.height, index);
    const auto displaced = reference::temporal_candidates(is_left ? search.left : search.right, edges, index,
                                                          search.radius, kAnyDirection, search.step);
    tap_->temporal_filter(TemporalFilter::displacement, side, {displaced.first, displaced.target, {}, {}, {}});
    const reference::TemporalMatchLists& lists = is_left ? result.left : result.right;
    for (auto filter = TemporalFilter::orientation; filter < TemporalFilter::refinement; filter = next(filter))
      tap_->temporal_filter(filter, side, alive_after(filter, lists.candidates, lists.scores));
    tap_->temporal_filter(TemporalFilter::agreement, side,
                          alive_after(TemporalFilter::agreement, result.left.candidates, result.left.scores));
  }
}

}  // namespace quadedge::frontend
