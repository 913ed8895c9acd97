/// \file reference_frontend_taps.cpp  Passes data of the reference to a tap after each filter, from the candidate lists
/// on.
#include "edges/tap_lists.hpp"
#include "oracle/reference_frontend.hpp"
#include "reference/temporal_matching.hpp"

namespace quadedge::frontend {
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
