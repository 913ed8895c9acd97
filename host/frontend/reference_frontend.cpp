#include "frontend/reference_frontend.hpp"

#include <numeric>
#include <stdexcept>

#include "common/coarse_search.hpp"
#include "common/epipolar_rows.hpp"
#include "frontend/global_search.hpp"
#include "reference/edge_detection.hpp"
#include "reference/edge_mask.hpp"
#include "reference/edge_selection.hpp"
#include "reference/patches.hpp"
#include "reference/sift.hpp"
#include "reference/stereo_mutual.hpp"
#include "reference/temporal_match.hpp"
#include "reference/undistortion.hpp"
#include "reference/wide_description.hpp"
#include "reference/wide_matching.hpp"

namespace quadedge::frontend {
namespace {

Image pinhole_image(const ImageView& recorded, const UndistortionTable& table) {
  if (!table.empty()) return reference::undistort(recorded, table);
  Image image(recorded.width, recorded.height, recorded.max_value);
  const std::ptrdiff_t row = image.view().stride;
  for (int y = 0; y < recorded.height; ++y) {
    std::copy_n(recorded.pixels + y * recorded.stride, row, image.pixels.begin() + y * row);
  }
  return image;
}

/// The first edges.max_edges edges in scan order.
EdgeSet limited(const reference::ReferenceEdges& all, const EdgesConfig& config, int& dropped) {
  EdgeSet edges = reference::to_edge_set(all);
  const auto limit = static_cast<std::size_t>(config.max_edges);
  if (edges.size() > limit) {
    dropped += static_cast<int>(edges.size() - limit);
    for (auto* values : {&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_drift})
      values->resize(limit);
    for (auto& first : edges.row_first) first = std::min(first, static_cast<std::int32_t>(limit));
  }
  return edges;
}

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

reference::EdgeDescriptions describe(const Image& image, const EdgeSet& edges, const Config& config) {
  return {reference::side_patches(image.view(), edges.x, edges.y, edges.direction, config.patches),
          reference::sift_descriptors(image.view(), edges.x, edges.y, edges.direction, config.sift)};
}

}  // namespace

ReferenceFrontend::ReferenceFrontend(const StereoRig& rig, const Config& config)
    : Frontend(rig, config.stereo),
      config_(config),
      threshold_(config.edges),
      range_(rig, config),
      gate_(config.stereo, coarse_search(rig, range_.geometry()).has_value()) {}

void ReferenceFrontend::detect(ReferenceRig& now, double threshold) {
  reference::ReferenceEdges left = reference::outside_mask(
      reference::detect_edges(now.left.view(), config_.edges, threshold), calibration_.left_mask, config_.edges.margin);
  reference::ReferenceEdges right =
      reference::outside_mask(reference::detect_edges(now.right.view(), config_.edges, threshold),
                              calibration_.right_mask, config_.edges.margin);
  float spacing = 0;
  if (config_.edges.budget > 0) {
    const SelectionArguments in_left = selection_arguments(calibration_, Side::left, config_.stereo),
                             in_right =
                                 selection_arguments(calibration_, Side::right, config_.stereo, rectification_.error());
    const reference::GradientMaxima left_maxima = maxima_of(left), right_maxima = maxima_of(right);
    spacing = reference::selection_spacing(in_left, left_maxima, in_right, right_maxima, config_.edges.budget);
    left = select_edges(left, kept_by_selection(in_left, left_maxima, spacing));
    right = select_edges(right, kept_by_selection(in_right, right_maxima, spacing));
  }
  now.edges_spacing = static_cast<double>(std::max(spacing, kClosestSelection));
  left_edges_ = limited(left, config_.edges, counts_.dropped_edges);
  right_edges_ = limited(right, config_.edges, counts_.dropped_edges);
}

RigHandle ReferenceFrontend::process(const StereoFrame& frame) {
  ReferenceRig& now = rigs_.next();
  counts_ = {};
  now.wide.clear();
  now.left = pinhole_image(frame.left, calibration_.left_undistortion);
  now.right = pinhole_image(frame.right, calibration_.right_undistortion);
  const double threshold = threshold_.next({now.left.view(), now.right.view()});
  counts_.edge_threshold = threshold;
  reference::EdgeDescriptions left;
  rectification_.start_frame();
  do {
    counts_.dropped_edges = 0;
    detect(now, threshold);
    counts_.edges_left = static_cast<int>(left_edges_.size());
    counts_.edges_right = static_cast<int>(right_edges_.size());
    left = describe(now.left, left_edges_, config_);
    const auto right = describe(now.right, right_edges_, config_);
    range_.start_frame();
    while (!search_stereo(now, left, right)) {
    }
  } while (!rectification_.suffices(frame, now.edges));
  counts_.disparity_range = range_.disparity();
  counts_.epipolar_correction = rectification_.error().largest();
  if (tap_ != nullptr) {
    tap_->edges(left_edges_, right_edges_);
    tap_candidates();
    tap_clusters();
    tap_->stereo(now.edges);
  }

  now.left_descriptions = {rows_of(left.patches, now.edges.left_index, kEdgePatchBytes),
                           rows_of(left.sift, now.edges.left_index, kEdgeSiftBytes)};
  now.right_descriptions = {reference::side_patches(now.right.view(), now.edges.right_x, now.edges.right_y,
                                                    now.edges.right_direction, config_.patches),
                            reference::sift_descriptors(now.right.view(), now.edges.right_x, now.edges.right_y,
                                                        now.edges.right_direction, config_.sift)};
  return rigs_.current_handle();
}

bool ReferenceFrontend::search_stereo(ReferenceRig& now, const reference::EdgeDescriptions& left,
                                      const reference::EdgeDescriptions& right) {
  const EpipolarGeometry geometry = corrected(range_.geometry(), rectification_.error(), calibration_.left);
  candidates_ = reference::stereo_candidates(left_edges_, right_edges_, geometry, range_.probe(counts_.edges_left));
  scores_ = reference::candidate_filters(candidates_, left, right, stereo_limits(config_.stereo));
  const auto refined =
      reference::stereo_refinement(now.left.view(), now.right.view(), left.patches, left_edges_, right_edges_, geometry,
                                   candidates_, config_.stereo, config_.patches.offset, scores_);
  clusters_ = reference::stereo_clusters(candidates_, scores_, refined, right_edges_, config_.stereo);
  const auto search = gate_.is_open() ? coarse_search(calibration_, range_.geometry()) : std::nullopt;
  std::optional<reference::CoarseDisparity> witness;
  if (search) witness = reference::coarse_disparity(now.left.view(), now.right.view(), *search);
  relaxation_ = reference::stereo_relaxation(clusters_, left_edges_, geometry, calibration_.left.width,
                                             calibration_.left.height, config_.stereo, witness ? &*witness : nullptr);
  now.edges = reference::stereo_mutual(clusters_, relaxation_, left_edges_, range_.geometry(), config_.stereo);
  const bool range_suffices = range_.suffices(now.edges, counts_.edges_left);
  return gate_.suffices(relaxation_.tally) && range_suffices;
}

void ReferenceFrontend::match(const Rig& base, const TemporalSearch& search, TemporalMatches& matches) {
  const ReferenceRig& before = rigs_.own(base);
  const ReferenceRig& now = rigs_.current();
  auto result = reference::temporal_match(
      search, now.edges,
      {before.left_descriptions, now.left_descriptions, calibration_.left.width, calibration_.left.height},
      {before.right_descriptions, now.right_descriptions, calibration_.right.width, calibration_.right.height},
      config_.temporal);
  counts_.temporal_left = result.left.alive_rows;
  counts_.temporal_right = result.right.alive_rows;
  matches = std::move(result.matches);
  matches.search = counts_.searches++;
}

namespace {

reference::WideEdges describe_some(const ReferenceRig& rig, int wanted) {
  if (!rig.wide.empty()) return {rig.edges, 1, rig.wide};
  const int step = wide_step(rig.edges.size(), wanted);
  return {rig.edges, step, reference::wide_descriptions(reference::shrink(rig.left.view()), rig.edges, step)};
}

}  // namespace

void ReferenceFrontend::match_globally(const Rig& base, int edges, TemporalMatches& matches) {
  matches = reference::wide_matches(describe_some(rigs_.own(base), edges), describe_some(rigs_.current(), 2 * edges),
                                    config_.temporal);
}

void ReferenceFrontend::match_globally(const Rig& base, const GlobalSearch& among, TemporalMatches& matches) {
  const ReferenceRig &own = rigs_.own(base), &current = rigs_.current();
  const StereoEdges before = edges_of(own.edges, among.of_base), now = edges_of(current.edges, among.of_current);
  const auto describe = [](const ReferenceRig& rig, const StereoEdges& edges) {
    return reference::WideEdges{edges, 1, reference::wide_descriptions(reference::shrink(rig.left.view()), edges, 1)};
  };
  const bool is_restored = !own.wide.empty();
  matches = reference::wide_matches(is_restored ? describe_some(own, 1) : describe(own, before), describe(current, now),
                                    config_.temporal);
  if (!is_restored) renumber(among.of_base, matches.previous);
  renumber(among.of_current, matches.current);
}

KeptRig ReferenceFrontend::keep() {
  const ReferenceRig& now = rigs_.current();
  const reference::WideEdges described = describe_some(now, 2 * config_.temporal.wide_edges);
  std::vector<std::int32_t> itself(now.edges.size());
  std::iota(itself.begin(), itself.end(), 0);
  return keep_edges(now, {described.step, described.descriptors}, now.left_descriptions.patches, itself,
                    now.right_descriptions.patches);
}

RigHandle ReferenceFrontend::restore(const KeptRig& kept) {
  if (tap_ != nullptr) throw std::logic_error("a restored rig has no images, which a tap needs");
  const std::shared_ptr<ReferenceRig>& restored = rigs_.restored();
  restored->start(kept.frame);
  restored->edges = kept.edges;
  restored->edges_spacing = kept.edges_spacing;
  restored->own_calibration = kept.own_calibration;
  KeptPatches patches = unpack_patches(kept);
  const std::vector<std::uint8_t> no_sift(kept.edges.size() * kEdgeSiftBytes);
  restored->left_descriptions = {std::move(patches.left), no_sift};
  restored->right_descriptions = {std::move(patches.right), no_sift};
  restored->wide = unpack_wide(kept);
  return restored;
}

}  // namespace quadedge::frontend
