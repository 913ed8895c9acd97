/// \file staged_frontend.cpp  Repeats the stereo search until range and coarse gate suffice, all until the rows do.
#include "edges/staged_frontend.hpp"

#include <stdexcept>

#include "common/filter_limits.hpp"
#include "geometry/epipolar_geometry.hpp"

namespace quadedge::frontend {
namespace {

/// The columns of the edges with these indices; left_index holds the indices themselves.
StereoEdges edges_of(const StereoEdges& edges, const std::vector<std::int32_t>& numbers) {
  StereoEdges some;
  some.left_index = numbers;
  for (const auto column : kStereoColumns) {
    if ((edges.*column).empty()) continue;  // not known
    for (const std::int32_t number : numbers)
      (some.*column).push_back((edges.*column)[static_cast<std::size_t>(number)]);
  }
  return some;
}

/// Replaces indices into the result of edges_of() by the indices of the same edges in the full list.
void renumber(const std::vector<std::int32_t>& numbers, std::vector<std::int32_t>& indices) {
  for (auto& index : indices) index = numbers[static_cast<std::size_t>(index)];
}

}  // namespace

StagedFrontend::StagedFrontend(const StereoRig& rig, const Config& config)
    : GlobalFrontend(rig, config),
      config_(config),
      range_(rig, config),
      gate_(config.stereo, coarse_search(rig, range_.geometry()).has_value()) {}

FrameEdgesHandle StagedFrontend::process(const StereoFrame& frame) {
  counts_ = {};
  searches_ = 0;
  auto hidden = take_masks(frame);
  FrameEdges& current = start(frame);
  current.stamp_ns = frame.stamp_ns;
  current.hidden = std::move(hidden);
  rows().start_frame();
  do {
    detect(current);
    describe(current, tap_ != nullptr || config_.stereo.sift_max > 0);
    range_.start_frame();
    while (!search_stereo(current)) {
    }
  } while (!rows().suffices(searched(frame), current.edges));
  counts_.disparity_range = range_.disparity();
  counts_.epipolar_correction = rows().error().largest();
  finish(current);
  if (tap_ != nullptr) {
    tap_->edges(edges(Side::left), edges(Side::right));
    tap_stereo();
    tap_->stereo(current.edges);
  }
  return latest();
}

bool StagedFrontend::search_stereo(FrameEdges& current) {
  const auto coarse = gate_.is_open() ? coarse_search(calibration_, range_.geometry()) : std::nullopt;
  const RelaxationTally tally =
      find_stereo_edges(current, corrected_geometry(), range_.probe(counts_.edges_left), coarse);
  const bool range_suffices = range_.suffices(current.edges, counts_.edges_left);
  return gate_.suffices(tally) && range_suffices;
}

void StagedFrontend::match(const FrameEdges& base_edges, const FrameEdges& current_edges, const TemporalSearch& search,
                           TemporalMatches& matches) {
  FrameEdges &base = own(base_edges), &current = own(current_edges);
  if (tap_ != nullptr || temporal_limits(config_.temporal, search).sift_max > 0) {
    describe_by_sift(base);
    describe_by_sift(current);
  }
  if (tap_ != nullptr)
    tap_->temporal_search({searches_, base.frame, search.left, search.right, search.radius, search.step});
  search_in_time(base, current, search, matches);
  matches.search = searches_++;
  if (tap_ != nullptr) tap_->quads(matches);
}

void StagedFrontend::match_globally(const FrameEdges& base, const FrameEdges& current, int edges,
                                    TemporalMatches& matches) {
  matches.clear();
  if (edges == 0) return;
  matches = search_globally(own(base), about(edges, base), own(current), about(2 * edges, current));
}

void StagedFrontend::match_globally(const FrameEdges& base, const FrameEdges& current, const GlobalSearch& among,
                                    TemporalMatches& matches) {
  matches.clear();
  own(base);
  const StereoEdges before = edges_of(base.edges, among.of_base), now = edges_of(current.edges, among.of_current);
  if ((!base.is_restored && before.size() == 0) || now.size() == 0) return;
  matches = search_globally(base, {before, 1}, own(current), {now, 1});
  if (!base.is_restored) renumber(among.of_base, matches.previous);
  renumber(among.of_current, matches.current);
}

FrameEdgesHandle StagedFrontend::restore(const KeptFrameEdges& kept) {
  if (tap_ != nullptr) throw std::logic_error("a restored rig has no images, which a tap needs");
  const std::shared_ptr<FrameEdges> restored = spare();
  restored->start(kept.frame);
  restored->edges = kept.edges;
  restored->edges_spacing = kept.edges_spacing;
  restored->own_calibration = kept.own_calibration;
  restored->is_restored = true;
  restored->set_rig(kept.rig);
  load(kept, *restored);
  return restored;
}

}  // namespace quadedge::frontend
