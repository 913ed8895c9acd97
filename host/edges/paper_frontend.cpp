/// \file paper_frontend.cpp  Edges, descriptions and stereo matches frame by frame, quads on request; feeds a tap.
#include "edges/paper_frontend.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "edges/prediction.hpp"
#include "edges/tap_lists.hpp"
#include "geometry/disparity_range.hpp"
#include "paper/grid_edges.hpp"
#include "reference/edge_detection.hpp"
#include "reference/images.hpp"

namespace quadedge::frontend {
namespace {

constexpr double kAnyDirection = kPi / 2;  // modulo half a turn

[[noreturn]] void refuse() { throw std::logic_error("the paper's method keeps no rigs"); }

/// The descriptions of some of the edges.
paper::Described some_of(const paper::Described& all, const std::vector<std::int32_t>& numbers) {
  paper::Described some;
  for (const auto number : numbers) {
    const auto i = static_cast<std::size_t>(number);
    some.patches.push_back(all.patches[i]);
    const auto sift = all.sift.begin() + static_cast<std::ptrdiff_t>(i * kEdgeSiftBytes);
    some.sift.insert(some.sift.end(), sift, sift + kEdgeSiftBytes);
  }
  return some;
}

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
      geometry_(make_epipolar_geometry(rig, with_disparity_range(config, rig).stereo)),
      threshold_(config.edges) {
  counts_.disparity_range = static_cast<double>(
      epipolar_line(geometry_, static_cast<float>(rig.left.width) / 2, static_cast<float>(rig.left.height) / 2).s_max);
}

EdgeSet PaperFrontend::detect(const Image& image, const PixelMask& mask) {
  const auto found = reference::outside_mask(paper::grid_edges(image.view(), config_.edges, counts_.edge_threshold),
                                             mask, config_.edges.margin);
  return reference::first_edges(found, config_.edges.max_edges, counts_.dropped_edges);
}

FrameEdgesHandle PaperFrontend::process(const StereoFrame& frame) {
  PaperFrameEdges& now = frames_.next();
  now.stamp_ns = frame.stamp_ns;
  now.hidden = take_masks(frame);
  searches_ = 0;
  const Image left = reference::pinhole_image(frame.left, calibration_.left_undistortion),
              right = reference::pinhole_image(frame.right, calibration_.right_undistortion);
  counts_.edge_threshold = threshold_.next({left.view(), right.view()});
  counts_.dropped_edges = 0;
  left_edges_ = detect(left, masks_.left);
  right_edges_ = detect(right, masks_.right);
  counts_.edges_left = static_cast<int>(left_edges_.size());
  counts_.edges_right = static_cast<int>(right_edges_.size());
  const auto view_of = [&](const Image& image, const EdgeSet& edges) {
    paper::Picture picture(image.view());
    auto described = paper::describe(image.view(), picture, edges.positions(), config_.patches.offset);
    return paper::View{std::move(picture), edges, std::move(described)};
  };
  paper::View in_left = view_of(left, left_edges_), in_right = view_of(right, right_edges_);
  const auto matching =
      paper::match_stereo(in_left, in_right, geometry_, config_.stereo, config_.patches.offset, tap_ != nullptr);
  now.edges = paper::stereo_edges(matching, left_edges_, geometry_);
  now.left_described = some_of(in_left.described, now.edges.left_index);
  now.right_described =
      paper::describe(right.view(), in_right.picture, now.edges.positions(Side::right), config_.patches.offset);
  now.left = std::move(in_left.picture);
  now.right = std::move(in_right.picture);
  if (tap_ != nullptr) {
    tap_->edges(left_edges_, right_edges_);
    tap_stereo(matching);
    tap_->stereo(now.edges);
  }
  return frames_.current_handle();
}

void PaperFrontend::match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch&,
                          TemporalMatches& matches) {
  const PaperFrameEdges &before = frames_.own(base), &now = frames_.own(current);
  const paper::RefinementSettings settings = paper::refinement_settings(config_.stereo);
  const auto seen = [&](const PaperFrameEdges& frame_edges, Side side) {
    const bool is_left = side == Side::left;
    const PinholeCamera& camera = is_left ? calibration_.left : calibration_.right;
    return paper::StereoEdgesInView{is_left ? *frame_edges.left : *frame_edges.right, frame_edges.edges.positions(side),
                                    is_left ? frame_edges.left_described : frame_edges.right_described, camera.width,
                                    camera.height};
  };
  if (tap_ != nullptr) {
    const TemporalSearch around = search_without_motion(before.edges, config_.temporal, false);
    tap_->temporal_search({searches_, before.frame, around.left, around.right, around.radius, 1});
  }
  std::array<paper::SideMatching, 2> sides;
  for (const Side side : kSides) {
    auto& matching = sides[static_cast<std::size_t>(index_of(side))];
    matching = paper::match_side(seen(before, side), seen(now, side), config_.temporal, settings, tap_ != nullptr);
    if (tap_ != nullptr) tap_temporal(seen(before, side), seen(now, side), matching, side);
  }
  matches = paper::quads_of(sides[0], sides[1]);
  matches.search = searches_++;
  if (tap_ == nullptr) return;
  tap_quads(sides[0], sides[1]);
  tap_->quads(matches);
}

void PaperFrontend::tap_stereo(const paper::StereoMatching& matching) {
  for (const auto filter : {StereoFilter::epipolar_distance, StereoFilter::disparity}) {
    const auto lists = reference::stereo_candidates(
        left_edges_, right_edges_, without_limits(geometry_, filter < StereoFilter::disparity, true), {});
    tap_->stereo_filter(filter, {lists.first, lists.target, {}, {}, {}});
  }
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, reference::alive_after(filter, matching.candidates, matching.scores));
  for (const auto filter : {StereoFilter::refinement, StereoFilter::similarity}) {
    const auto passes = [&](std::size_t, std::size_t k) {
      return filter == StereoFilter::refinement || matching.clusters.similarity[k] >= config_.stereo.refined_ncc_min;
    };
    tap_->stereo_filter(filter, clusters_that(matching.clusters, geometry_, left_edges_.x, left_edges_.y, passes));
  }
}

void PaperFrontend::tap_temporal(const paper::StereoEdgesInView& before, const paper::StereoEdgesInView& now,
                                 const paper::SideMatching& matching, Side side) {
  const auto displaced = paper::near_previous(before, now, config_.temporal.radius, kAnyDirection);
  tap_->temporal_filter(TemporalFilter::displacement, side, {displaced.first, displaced.target, {}, {}, {}});
  for (auto filter = TemporalFilter::orientation; filter < TemporalFilter::refinement; filter = next(filter))
    tap_->temporal_filter(filter, side, reference::alive_after(filter, matching.candidates, matching.scores));
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
