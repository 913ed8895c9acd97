/// \file paper_reference_frontend.cpp  Edges, descriptions and stereo matches frame by frame, quads on request.
#include <utility>

#include "edges/tap_lists.hpp"
#include "oracle/reference_frontend.hpp"
#include "paper/grid_edges.hpp"
#include "reference/images.hpp"

namespace quadedge::frontend {
namespace {

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

}  // namespace

PaperReferenceFrontend::PaperReferenceFrontend(const StereoRig& rig, const Config& config)
    : PaperFrontend(rig, config), threshold_(config.edges) {}

EdgeSet PaperReferenceFrontend::detect(const Image& image, const PixelMask& mask) {
  const auto found = reference::outside_mask(paper::grid_edges(image.view(), config_.edges, counts_.edge_threshold),
                                             mask, config_.edges.margin);
  return reference::first_edges(found, config_.edges.max_edges, counts_.dropped_edges);
}

FrameEdges& PaperReferenceFrontend::detect(const StereoFrame& frame) {
  left_ = reference::pinhole_image(frame.left, calibration_.left_undistortion);
  right_ = reference::pinhole_image(frame.right, calibration_.right_undistortion);
  counts_.edge_threshold = threshold_.next({left_.view(), right_.view()});
  counts_.dropped_edges = 0;
  left_edges_ = detect(left_, masks_.left);
  right_edges_ = detect(right_, masks_.right);
  counts_.edges_left = static_cast<int>(left_edges_.size());
  counts_.edges_right = static_cast<int>(right_edges_.size());
  return frames_.next();
}

void PaperReferenceFrontend::find_stereo_edges(FrameEdges& current, paper::StereoMatching* all) {
  PaperFrameEdges& now = frames_.own(current);
  const double offset = config_.patches.offset;
  const auto view_of = [&](const Image& image, const EdgeSet& edges) {
    paper::Picture picture(image.view());
    auto described = paper::describe(image.view(), picture, edges.positions(), offset);
    return paper::View{std::move(picture), edges, std::move(described)};
  };
  paper::View left = view_of(left_, left_edges_), right = view_of(right_, right_edges_);
  auto matching = paper::match_stereo(left, right, geometry_, config_.stereo, offset, all != nullptr);
  now.edges = paper::stereo_edges(matching, left_edges_, geometry_);
  now.left_described = some_of(left.described, now.edges.left_index);
  now.right_described = paper::describe(right_.view(), right.picture, now.edges.positions(Side::right), offset);
  now.left = std::move(left.picture);
  now.right = std::move(right.picture);
  if (all != nullptr) *all = std::move(matching);
}

CandidateLists PaperReferenceFrontend::near_lines(const EpipolarGeometry& geometry) {
  const auto lists = reference::stereo_candidates(left_edges_, right_edges_, geometry, {});
  return {lists.first, lists.target, {}, {}, {}};
}

CandidateLists PaperReferenceFrontend::near_previous(const FrameEdges& before, const FrameEdges& now, Side side) {
  const PinholeCamera& camera = side == Side::left ? calibration_.left : calibration_.right;
  const auto lists = paper::near_previous(before.edges.positions(side), now.edges.positions(side), camera.width,
                                          camera.height, config_.temporal.radius, kAnyDirection);
  return {lists.first, lists.target, {}, {}, {}};
}

void PaperReferenceFrontend::find_quads(const FrameEdges& base, const FrameEdges& current,
                                        std::array<paper::SideMatching, 2>* all, TemporalMatches& matches) {
  const PaperFrameEdges &before = frames_.own(base), &now = frames_.own(current);
  const paper::RefinementSettings settings = paper::refinement_settings(config_.stereo);
  const auto seen = [&](const PaperFrameEdges& frame_edges, Side side) {
    const bool is_left = side == Side::left;
    const PinholeCamera& camera = is_left ? calibration_.left : calibration_.right;
    return paper::StereoEdgesInView{is_left ? *frame_edges.left : *frame_edges.right, frame_edges.edges.positions(side),
                                    is_left ? frame_edges.left_described : frame_edges.right_described, camera.width,
                                    camera.height};
  };
  std::array<paper::SideMatching, 2> sides;
  for (const Side side : kSides)
    sides[static_cast<std::size_t>(index_of(side))] =
        paper::match_side(seen(before, side), seen(now, side), config_.temporal, settings, all != nullptr);
  matches = paper::quads_of(sides[0], sides[1]);
  if (all != nullptr) *all = std::move(sides);
}

}  // namespace quadedge::frontend
