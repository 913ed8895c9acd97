#include "rig_check/rig_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "rig_check/rig_check_constants.hpp"

namespace quadedge::rig_check {
namespace {

/// A hash that practically identifies an image. Four hashes of every fourth word each are computed side by side.
std::uint64_t fingerprint(const ImageView& image) {
  constexpr std::size_t kHashes = 4, kStep = kHashes * sizeof(std::uint64_t);
  std::uint64_t hashes[kHashes] = {1469598103934665603U, 2, 3, 4};
  const auto add = [](std::uint64_t word, std::uint64_t& hash) {
    hash = (hash ^ word) * 1099511628211U;
    hash ^= hash >> 29U;
  };
  const std::size_t bytes = bytes_per_pixel(image.max_value) * static_cast<std::size_t>(image.width);
  for (int y = 0; y < image.height; ++y) {
    const std::uint8_t* row = image.pixels + y * image.stride;
    for (std::size_t i = 0; i < bytes; i += kStep) {
      std::uint64_t words[kHashes] = {};
      std::memcpy(words, row + i, std::min(kStep, bytes - i));
      for (std::size_t k = 0; k < kHashes; ++k) add(words[k], hashes[k]);
    }
  }
  for (std::size_t k = 1; k < kHashes; ++k) add(hashes[k], hashes[0]);
  return hashes[0];
}

/// The transformation of the right image with which a search finds most corners; none if there is no such.
ImageTurn find_turn(const EpipolarProbe& probe, const StereoFrame& frame, double max_disparity) {
  for (const ImageTurn turn : {ImageTurn::mirrored, ImageTurn::half, ImageTurn::quarter, ImageTurn::three_quarters}) {
    const ProbeSearch search = probe.search(frame, max_disparity, turn);
    if (static_cast<double>(search.found.size()) > kTransformedFoundRatio * search.searched) return turn;
  }
  return ImageTurn::none;
}

/// Adds a search and its findings to the report.
void search_and_judge(const EpipolarProbe& probe, const StereoRig& rig, const StereoFrame& frame, double max_disparity,
                      RigReport& report) {
  const ProbeSearch search = probe.search(frame, max_disparity);
  // On thin curves, coarse positions do not determine the distance from the line.
  std::vector<CornerMatch> aligned;
  std::copy_if(search.found.begin(), search.found.end(), std::back_inserter(aligned),
               [](const CornerMatch& match) { return match.is_aligned; });
  EpipolarFit fit = fit_across(aligned, rig.left.width, rig.left.height);
  if (fit.samples == 0) {
    fit = fit_across(search.found, rig.left.width, rig.left.height);
    fit.is_coarse = true;
  }
  add_search_results(search, fit, report.evidence);
  const ImageTurn turn =
      finds_few_corners(search, report.evidence) ? find_turn(probe, frame, max_disparity) : ImageTurn::none;
  report.findings = judge_search(search, fit, report.evidence, turn);
}

}  // namespace

RigMonitor::RigMonitor(const StereoRig& rig) : rig_(rig), probe_(rig) {}

std::optional<RigFinding> RigMonitor::find_repeated_images(const StereoFrame& frame) {
  const std::uint64_t left = fingerprint(frame.left), right = fingerprint(frame.right);
  const bool same_left = last_left_ == left, same_right = last_right_ == right;
  last_left_ = left;
  last_right_ = right;
  if (!same_left && !same_right) return std::nullopt;
  RigFinding repeated{same_left && same_right ? RigFindingKind::repeated_images : RigFindingKind::frozen_camera};
  repeated.camera = same_left ? Side::left : Side::right;
  return repeated;
}

bool RigMonitor::needs_search(const RigEvidence& evidence) const {
  if (!searched_ || !fits_ || frames_since_search_ >= kSearchPeriod) return true;
  return evidence.matched_ratio < kMatchedDecrease * searched_->matched_ratio ||
         evidence.epipolar_residual > searched_->epipolar_residual + kResidualIncrease;
}

RigReport RigMonitor::judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, double max_disparity,
                            double correction) {
  RigReport report;
  RigEvidence& evidence = report.evidence;
  evidence.epipolar_correction = correction;
  if (left_edges > 0) evidence.matched_ratio = static_cast<double>(edges.size()) / left_edges;
  probe_.align(frame, edges, corner_matches_);
  const EpipolarFit& fit = report.fit = fit_across(corner_matches_, rig_.left.width, rig_.left.height);
  if (fit.samples > 0) {
    evidence.epipolar_residual = fit.residual;
    evidence.epipolar_offset = fit.offset;
    evidence.epipolar_slope_x = fit.slope_x;
    evidence.epipolar_slope_y = fit.slope_y;
    evidence.epipolar_samples = fit.samples;
  }
  ++frames_since_search_;
  const auto repeated = find_repeated_images(frame);
  const bool is_frozen = repeated && is_mismatch(repeated->kind);
  if (!is_frozen && left_edges > 0 && needs_search(evidence)) {
    search_and_judge(probe_, rig_, frame, max_disparity, report);
    frames_since_search_ = 0;
    searched_ = evidence;
    fits_ = report.mismatch() == nullptr;
  }
  if (repeated && report.mismatch() == nullptr) report.findings.push_back(*repeated);
  if (const auto region = static_region_.observe({frame.left, rig_.left_undistortion, rig_.left}, corner_matches_);
      region && report.mismatch() == nullptr) {
    report.findings.push_back({RigFindingKind::static_region});
    report.findings.back().region = *region;
  }
  return report;
}

std::optional<RigFinding> RigMonitor::observe_motion(const Eigen::Isometry3d& current_from_last) {
  const Eigen::Isometry3d last_from_current = current_from_last.inverse();
  for (const CornerMatch& match : corner_matches_) {
    const Eigen::Vector3d last =
        last_from_current.linear() * rig_.left.ray(match.left) + last_from_current.translation() * match.inverse_depth;
    if (!(last.z() > 0)) continue;
    const Eigen::Vector2d motion = match.left - rig_.left.project(last);
    synchronisation_.add(match.left.x() / rig_.left.width - 0.5, match.left.y() / rig_.left.height - 0.5, match.across,
                         motion.dot(match.normal));
  }
  const double time_offset = synchronisation_.time_offset_frames();
  if (time_offset == 0) return std::nullopt;
  RigFinding late{RigFindingKind::late_camera};
  late.time_offset = time_offset;
  return late;
}

RigReport RigMonitor::examine(const StereoRig& rig, const StereoFrame& frame, double max_disparity) {
  RigReport report;
  search_and_judge(EpipolarProbe(rig), rig, frame, max_disparity, report);
  return report;
}

}  // namespace quadedge::rig_check
