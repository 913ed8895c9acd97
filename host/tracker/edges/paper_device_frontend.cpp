/// \file paper_device_frontend.cpp  Enqueues the stages of the paper's cascades; the host collects edges and quads.
#include "edges/paper_device_frontend.hpp"

#include <numeric>
#include <utility>

#include "common/matching_constants.hpp"
#include "edges/tap_lists.hpp"

namespace quadedge::frontend {
namespace {

Candidates lists_of(const stages::DeviceCandidates& candidates) {
  const CandidateLists lists = candidates.read();
  return {lists.first, lists.target};
}

CandidateScores scores_of(const stages::DeviceCandidates& candidates) {
  const auto count = static_cast<std::size_t>(candidates.host_total);
  return {candidates.ncc.read(count), candidates.sift.read(count), candidates.state.read(count)};
}

std::vector<std::vector<paper::Cluster>> rows_of(const stages::DevicePaperClusters::Lists& lists) {
  std::vector<std::vector<paper::Cluster>> rows(lists.first.size() - 1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (auto k = static_cast<std::size_t>(lists.first[i]); k < static_cast<std::size_t>(lists.first[i + 1]); ++k) {
      const auto members = lists.members.begin();
      rows[i].push_back({{lists.x[k], lists.y[k], lists.direction[k]},
                         {members + lists.member_first[k], members + lists.member_first[k + 1]}});
    }
  }
  return rows;
}

/// Clusters on the left edges' epipolar lines.
StereoClusters on_lines(const stages::DevicePaperClusters::Lists& lists, const EdgeSet& left,
                        const EpipolarGeometry& geometry) {
  StereoClusters clusters;
  clusters.first = lists.first;
  clusters.direction.assign(lists.direction.begin(), lists.direction.end());
  clusters.similarity.assign(lists.similarity.begin(), lists.similarity.end());
  for (std::size_t i = 0; i + 1 < lists.first.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    for (auto k = static_cast<std::size_t>(lists.first[i]); k < static_cast<std::size_t>(lists.first[i + 1]); ++k) {
      clusters.position.push_back(
          static_cast<double>((lists.x[k] - line.x) * line.ex + (lists.y[k] - line.y) * line.ey));
      clusters.anchor.push_back(lists.members[static_cast<std::size_t>(lists.member_first[k])]);
    }
  }
  return clusters;
}

}  // namespace

PaperDeviceFrameEdges::PaperDeviceFrameEdges(const StereoRig& calibration) {
  left.picture.width = calibration.left.width;
  left.picture.height = calibration.left.height;
  right.picture.width = calibration.right.width;
  right.picture.height = calibration.right.height;
}

PaperDeviceFrontend::Camera::Camera(opencl::Context& context, const PinholeCamera& camera,
                                    const UndistortionTable& table, const PixelMask& hidden, int max_value,
                                    const Config& config)
    : undistortion(context, table, camera.width, camera.height, config.variants, max_value),
      plane(context, camera.width, camera.height, config.edges.sigma, max_value),
      detection(context, camera.width, camera.height, config.edges, hidden, config.variants),
      patches(context, camera.width, camera.height, config.variants, max_value),
      sift(context, camera.width, camera.height, config.variants, max_value) {}

void PaperDeviceFrontend::Camera::describe(double offset) {
  patches.prepare(image);
  patches.cut(edges.positions(), offset, patches_of_edges);
  sift.prepare(image);
  sift.describe(edges.positions(), sift_of_edges);
}

PaperDeviceFrontend::PaperDeviceFrontend(const StereoRig& rig, opencl::Context& context, const Config& config)
    : PaperFrontend(rig, config),
      context_(context),
      left_(context, rig.left, rig.left_undistortion, rig.left_mask, rig.max_value, config),
      right_(context, rig.right, rig.right_undistortion, rig.right_mask, rig.max_value, config),
      threshold_(context, config.edges, config.variants),
      stereo_candidates_(context, config.variants, stages::Turns::half),
      filters_(context, config.variants),
      refinement_(context, config.stereo, config.variants, rig.max_value),
      clustering_(context, config.variants, rig.max_value),
      point_index_(context, config.variants),
      temporal_candidates_(context, config.variants, stages::Turns::half),
      quads_(context, config.variants),
      left_index_(rig.left.width, rig.left.height),
      right_index_(rig.right.width, rig.right.height) {
  std::vector<cl_int> itself(static_cast<std::size_t>(config.edges.max_edges));
  std::iota(itself.begin(), itself.end(), 0);
  itself_.write(context, itself);
}

void PaperDeviceFrontend::masks_changed() {
  left_.detection.set_mask(masks_.left);
  right_.detection.set_mask(masks_.right);
}

EdgeSet PaperDeviceFrontend::edges(Side side) {
  return side == Side::left ? left_.edges.read(calibration_.left.height) : right_.edges.read(calibration_.right.height);
}

FrameEdgesHandle PaperDeviceFrontend::process(const StereoFrame& frame) {
  const opencl::CopyGuard guard(context_);  // of the images, which belong to the caller
  return PaperFrontend::process(frame);
}

FrameEdges& PaperDeviceFrontend::detect(const StereoFrame& frame) {
  left_.undistortion.run(frame.left, left_.image);
  right_.undistortion.run(frame.right, right_.image);
  context_.begin_stage("edge_detection");
  left_.plane.prepare(left_.image);
  right_.plane.prepare(right_.image);
  threshold_.run(left_.plane, &right_.plane);
  left_.detection.run(left_.plane, threshold_.values(), left_.edges);
  right_.detection.run(right_.plane, threshold_.values(), right_.edges);
  threshold_.request();
  left_.edges.request_count();
  right_.edges.request_count();
  context_.finish();
  counts_.edge_threshold = threshold_.host_threshold();
  counts_.edges_left = left_.edges.host_count;
  counts_.edges_right = right_.edges.host_count;
  counts_.dropped_edges = left_.edges.host_dropped + right_.edges.host_dropped;
  return frames_.next(calibration_);
}

void PaperDeviceFrontend::find_stereo_edges(FrameEdges& current, paper::StereoMatching* all) {
  PaperDeviceFrameEdges& now = frames_.own(current);
  const double offset = config_.patches.offset;
  left_.describe(offset);
  right_.describe(offset);
  stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height, geometry_, {}, candidates_);
  filters_.run({left_.patches_of_edges, itself_, left_.sift_of_edges},
               {right_.patches_of_edges, itself_, right_.sift_of_edges}, stereo_limits(config_.stereo), 1,
               all != nullptr, candidates_);
  refinement_.in_stereo({left_.patches.picture(), left_.edges.positions(), left_.patches_of_edges},
                        {right_.patches.picture(), right_.edges.positions(), right_.patches_of_edges}, geometry_,
                        candidates_, refined_);
  clustering_.cluster(right_.edges.positions(), candidates_, refined_, clusters_);
  clustering_.compare(right_.patches.picture(), left_.patches_of_edges, offset, config_.stereo.refined_ncc_min,
                      clusters_);
  const auto clusters = clusters_.read(true);
  collect_stereo_edges(clusters, now.edges);
  if (all != nullptr)
    *all = {lists_of(candidates_), scores_of(candidates_), on_lines(clusters, edges(Side::left), geometry_),
            clusters.chosen};
  keep_descriptions(now);
}

void PaperDeviceFrontend::collect_stereo_edges(const stages::DevicePaperClusters::Lists& clusters, StereoEdges& found) {
  const EdgeSet left = edges(Side::left);
  found = {};
  for (std::size_t i = 0; i < left.size(); ++i) {
    if (clusters.chosen[i] < 0) continue;
    const auto k = static_cast<std::size_t>(clusters.chosen[i]);
    found.left_index.push_back(static_cast<std::int32_t>(i));
    found.right_index.push_back(clusters.members[static_cast<std::size_t>(clusters.member_first[k])]);
    found.left_x.push_back(left.x[i]);
    found.left_y.push_back(left.y[i]);
    found.left_direction.push_back(left.direction[i]);
    found.right_x.push_back(clusters.x[k]);
    found.right_y.push_back(clusters.y[k]);
    found.right_direction.push_back(clusters.direction[k]);
    found.ncc.push_back(clusters.similarity[k]);
  }
}

/// Those of left edges are at hand, those of right ones are made at the refined positions.
void PaperDeviceFrontend::keep_descriptions(PaperDeviceFrameEdges& now) {
  const opencl::CopyGuard guard(context_);  // of the positions
  now.positions.write(context_, {now.edges.positions(Side::left), now.edges.positions(Side::right)});
  right_.patches.cut(now.positions.list(1), config_.patches.offset, now.right.patches);
  right_.sift.describe(now.positions.list(1), now.right.sift);
  std::swap(now.left.patches, left_.patches_of_edges);
  std::swap(now.left.sift, left_.sift_of_edges);
  now.left.number.write(context_, now.edges.left_index);
  left_.patches.swap(now.left.picture);
  right_.patches.swap(now.right.picture);
  context_.finish();
}

void PaperDeviceFrontend::match_side(PaperDeviceFrameEdges& before, PaperDeviceFrameEdges& now, Side side,
                                     bool all_scores, TimeSide& found) {
  const bool is_left = side == Side::left;
  const auto described = [&](PaperDeviceFrameEdges& frame_edges) {
    PaperSide& of = frame_edges.side(side);
    return stages::PaperDescribedEdges{of.patches, is_left ? of.number : itself_, of.sift};
  };
  const auto seen = [&](PaperDeviceFrameEdges& frame_edges) {
    PaperSide& of = frame_edges.side(side);
    return stages::PaperEdges{of.picture, frame_edges.positions.list(index_of(side)), of.patches};
  };
  temporal_candidates_.run(before.positions.list(index_of(side)), 1, is_left ? left_index_ : right_index_,
                           static_cast<float>(config_.temporal.radius), static_cast<float>(kTemporalOrientation),
                           found.candidates);
  filters_.run(described(before), described(now), temporal_limits(config_.temporal, {}), 1, all_scores,
               found.candidates);
  refinement_.in_time(seen(before), seen(now), found.candidates, found.refined);
  clustering_.cluster(now.positions.list(index_of(side)), found.candidates, found.refined, found.clusters);
}

CandidateLists PaperDeviceFrontend::near_lines(const EpipolarGeometry& geometry) {
  stages::DeviceCandidates lists;
  stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height, geometry, {}, lists);
  return lists.read();
}

CandidateLists PaperDeviceFrontend::near_previous(const FrameEdges& before, const FrameEdges&, Side side) {
  stages::DeviceCandidates lists;
  temporal_candidates_.run(frames_.own(before).positions.list(index_of(side)), 1,
                           side == Side::left ? left_index_ : right_index_, static_cast<float>(config_.temporal.radius),
                           kAnyDirection, lists);
  return lists.read();
}

void PaperDeviceFrontend::find_quads(const FrameEdges& base, const FrameEdges& current,
                                     std::array<paper::SideMatching, 2>* all, TemporalMatches& matches) {
  PaperDeviceFrameEdges &before = frames_.own(base), &now = frames_.own(current);
  point_index_.run(now.positions.list(0), now.positions.list(1), left_index_, right_index_);
  for (const Side side : kSides)
    match_side(before, now, side, all != nullptr, in_time_[static_cast<std::size_t>(index_of(side))]);
  const TimeSide &left = in_time_[0], &right = in_time_[1];
  quads_.run({left.candidates, left.clusters}, {right.candidates, right.clusters}, matches);
  if (all == nullptr) return;
  for (std::size_t side = 0; side < all->size(); ++side) {
    const TimeSide& found = in_time_[side];
    (*all)[side] = {lists_of(found.candidates), scores_of(found.candidates), rows_of(found.clusters.read(false))};
  }
}

}  // namespace quadedge::frontend
