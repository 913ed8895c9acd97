/// \file paper_frontend.cpp  The order of a frame in the paper's method; feeds a tap.
#include "edges/paper_frontend.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/filter_limits.hpp"
#include "edges/prediction.hpp"
#include "edges/tap_lists.hpp"
#include "geometry/disparity_range.hpp"

namespace quadedge::frontend {
namespace {

[[noreturn]] void refuse() { throw std::logic_error("the paper's method keeps no rigs"); }

/// Clusters as lists; those for which `wanted(row, number)` holds.
template <class Wanted>
CandidateLists lists_of(const std::vector<std::vector<paper::Cluster>>& rows, const Wanted& wanted) {
  CandidateLists lists;
  lists.first.push_back(0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t k = 0; k < rows[i].size(); ++k) {
      if (!wanted(i, k)) continue;
      lists.target.push_back(rows[i][k].members.front());
      lists.x.push_back(rows[i][k].centre.x);
      lists.y.push_back(rows[i][k].centre.y);
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace

PaperFrontend::PaperFrontend(const StereoRig& rig, const Config& config)
    : Frontend(rig, config),
      config_(config),
      geometry_(make_epipolar_geometry(rig, with_disparity_range(config, rig).stereo)) {
  counts_.disparity_range = static_cast<double>(
      epipolar_line(geometry_, static_cast<float>(rig.left.width) / 2, static_cast<float>(rig.left.height) / 2).s_max);
}

FrameEdgesHandle PaperFrontend::process(const StereoFrame& frame) {
  auto hidden = take_masks(frame);
  searches_ = 0;
  FrameEdges& now = detect(frame);
  now.stamp_ns = frame.stamp_ns;
  now.hidden = std::move(hidden);
  paper::StereoMatching all;
  find_stereo_edges(now, tap_ == nullptr ? nullptr : &all);
  if (tap_ != nullptr) {
    tap_->edges(edges(Side::left), edges(Side::right));
    tap_stereo(all);
    tap_->stereo(now.edges);
  }
  return latest();
}

void PaperFrontend::match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch&,
                          TemporalMatches& matches) {
  if (tap_ != nullptr) {
    const TemporalSearch around = search_without_motion(base.edges, config_.temporal, false);
    tap_->temporal_search({searches_, base.frame, around.left, around.right, around.radius, 1});
  }
  std::array<paper::SideMatching, 2> all;
  find_quads(base, current, tap_ == nullptr ? nullptr : &all, matches);
  matches.search = searches_++;
  if (tap_ == nullptr) return;
  for (const Side side : kSides) tap_temporal(base, current, all[static_cast<std::size_t>(index_of(side))], side);
  tap_quads(all[0], all[1]);
  tap_->quads(matches);
}

void PaperFrontend::tap_stereo(const paper::StereoMatching& matching) {
  const EdgeSet left = edges(Side::left);
  for (const auto filter : {StereoFilter::epipolar_distance, StereoFilter::disparity})
    tap_->stereo_filter(filter, near_lines(without_limits(geometry_, filter < StereoFilter::disparity, true)));
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, alive_after(filter, matching.candidates, matching.scores));
  for (const auto filter : {StereoFilter::refinement, StereoFilter::similarity}) {
    const auto passes = [&](std::size_t, std::size_t k) {
      return filter == StereoFilter::refinement || matching.clusters.similarity[k] >= config_.stereo.refined_ncc_min;
    };
    tap_->stereo_filter(filter, clusters_that(matching.clusters, geometry_, left.x, left.y, passes));
  }
}

void PaperFrontend::tap_temporal(const FrameEdges& before, const FrameEdges& now, const paper::SideMatching& matching,
                                 Side side) {
  tap_->temporal_filter(TemporalFilter::displacement, side, near_previous(before, now, side));
  for (auto filter = TemporalFilter::orientation; filter < TemporalFilter::refinement; filter = next(filter))
    tap_->temporal_filter(filter, side, alive_after(filter, matching.candidates, matching.scores));
  tap_->temporal_filter(TemporalFilter::refinement, side,
                        lists_of(matching.clusters, [](std::size_t, std::size_t) { return true; }));
}

void PaperFrontend::tap_quads(const paper::SideMatching& left, const paper::SideMatching& right) {
  for (const Side side : kSides) {
    const auto is_closed = [&](std::size_t row, std::size_t number) {
      const auto quads = paper::close_loop(left.clusters[row], right.clusters[row]);
      return std::any_of(quads.begin(), quads.end(), [&](const paper::Quad& quad) {
        return (side == Side::left ? quad.left : quad.right) == number;
      });
    };
    tap_->temporal_filter(TemporalFilter::agreement, side,
                          lists_of(side == Side::left ? left.clusters : right.clusters, is_closed));
  }
}

void PaperFrontend::match_globally(const FrameEdges&, const FrameEdges&, int, TemporalMatches&) { refuse(); }
void PaperFrontend::match_globally(const FrameEdges&, const FrameEdges&, const GlobalSearch&, TemporalMatches&) {
  refuse();
}
KeptFrameEdges PaperFrontend::keep() { refuse(); }
FrameEdgesHandle PaperFrontend::restore(const KeptFrameEdges&) { refuse(); }

}  // namespace quadedge::frontend
