/// \file rig_monitor.cpp  Inexpensive measurements decide when to search for corners; thresholds give the findings.
#include "rig/rig_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "rig/corner_judgement.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// A hash that practically identifies an image.
std::uint64_t fingerprint(const ImageView& image) {
  const std::size_t bytes = bytes_per_pixel(image.max_value) * static_cast<std::size_t>(image.width);
  std::uint64_t hash = 0;
  for (int y = 0; y < image.height; ++y) hash = XXH3_64bits_withSeed(image.pixels + y * image.stride, bytes, hash);
  return hash;
}

/// Drops the warnings of a kind. \returns whether there was one
bool drop(WarningKind kind, RigReport& report) {
  const auto is_dropped = [&](const RigFinding& of) { return of.warning.kind == kind && !of.is_mismatch; };
  const auto kept = std::remove_if(report.findings.begin(), report.findings.end(), is_dropped);
  const bool is_there = kept != report.findings.end();
  report.findings.erase(kept, report.findings.end());
  return is_there;
}

/// Part of an image that two masks hide.
double hidden_ratio(const PixelMask& rig, const PixelMask& frame) {
  if (rig.empty() && frame.empty()) return 0;
  const PixelMask& first = rig.empty() ? frame : rig;
  std::size_t count = 0;
  for (std::size_t i = 0; i < first.hidden.size(); ++i)
    count += first.hidden[i] != 0 || (!frame.empty() && frame.hidden[i] != 0) ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(first.hidden.size());
}

/// Names masks that hide most of an image in place of the calibration.
void blame_masks(const StereoRig& rig, const HiddenPixels& hidden, RigReport& report) {
  const double left = hidden_ratio(rig.left_mask, hidden.left), right = hidden_ratio(rig.right_mask, hidden.right);
  if (std::max(left, right) < kMajority) return;
  const std::string text = "the masks hide " + percent(std::max(left, right)) + " of the " +
                           name(left < right ? Side::right : Side::left) +
                           " image, where they are black: are black and white exchanged?";
  for (const WarningKind kind : {WarningKind::doubtful_calibration, WarningKind::small_disparity_range})
    drop(kind, report);
  if (report.mismatch() != nullptr)
    report.findings.front().warning.text += "; " + text;
  else
    report.findings.push_back({{WarningKind::poor_images, text}});
}

/// \param frames by which the right camera lags
Warning late_camera(double frames) {
  return {WarningKind::unsynchronised_cameras,
          "the " + name(frames > 0 ? Side::right : Side::left) +
              printed(" camera seems to be %.1f frames late: distances from the epipolar lines are proportional to the "
                      "image motion; pair the images by their time of exposure. `quadedge check` looks for the delay",
                      std::abs(frames))};
}

}  // namespace

RigMonitor::RigMonitor(const StereoRig& rig, bool auto_mask)
    : rig_(rig), auto_mask_(auto_mask), corner_matcher_(rig), times_(rig.left, kTimeMemory) {}

std::optional<RigFinding> RigMonitor::find_repeated_images(const StereoFrame& frame) {
  const std::uint64_t left = fingerprint(frame.left), right = fingerprint(frame.right);
  const bool same_left = last_left_ == left, same_right = last_right_ == right;
  last_left_ = left;
  last_right_ = right;
  if (!same_left && !same_right) return std::nullopt;
  if (same_left && same_right)
    return RigFinding{{WarningKind::repeated_images,
                       "both images are identical to those of the previous frame: have both cameras frozen, or was a "
                       "frame stored twice?"}};
  const std::string camera = name(same_left ? Side::left : Side::right),
                    other = name(same_left ? Side::right : Side::left);
  return RigFinding{
      {WarningKind::doubtful_calibration, "the " + camera + " image is identical to that of the previous frame, the " +
                                              other + " one is not: has the " + camera + " camera frozen?"},
      true};
}

bool RigMonitor::needs_search(const RigEvidence& evidence) const {
  return !searched_ || !fits_ || frames_since_search_ >= kSearchPeriod || has_worsened(evidence);
}

bool RigMonitor::has_worsened(const RigEvidence& evidence) const {
  return searched_ && fits_ &&
         (evidence.matched_ratio < kMatchedDecrease * searched_->matched_ratio ||
          evidence.epipolar_residual > searched_->epipolar_residual + kResidualIncrease);
}

RigReport RigMonitor::judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, double max_disparity,
                            const RigEstimate& rig, const HiddenPixels& hidden) {
  RigReport report;
  RigEvidence& evidence = report.evidence;
  evidence.epipolar_correction = rig.rows.largest();
  if (left_edges > 0) evidence.matched_ratio = static_cast<double>(edges.size()) / left_edges;
  corner_matcher_.align(frame, edges, corner_matches_);
  report.matches = &corner_matches_;
  std::vector<double> distances;
  for (const CornerMatch& match : corner_matches_) distances.push_back(std::abs(match.across));
  if (distances.size() >= kMinMatches) evidence.epipolar_residual = upper_median(distances);
  ++frames_since_search_;
  const auto repeated = find_repeated_images(frame);
  const bool is_frozen = repeated && repeated->is_mismatch;
  if (has_worsened(evidence)) {
    time_searches_ = 0;
    if (times_.delay() == 0) forget_motions();
  }
  const bool seeks_time = doubts_time(evidence) && time_searches_ < kTimeSearches && !times_.would_show_delay();
  if (!is_frozen && left_edges > 0 && (seeks_time || needs_search(evidence))) {
    time_searches_ = seeks_time ? time_searches_ + 1 : 0;
    search(frame, max_disparity, rig, hidden, report);
  }
  if (repeated && report.mismatch() == nullptr) report.findings.push_back(*repeated);
  blame_masks(rig_, hidden, report);
  const auto region = static_region_.observe({frame.left, rig_.left_undistortion, rig_.left}, corner_matches_);
  if (!region) return report;
  if (auto_mask_ && region->is_released) report.new_mask = region->mask;  // else nobody would uncover it
  if (report.mismatch() != nullptr) return report;
  const bool is_masked = !region->mask.empty();
  if (auto_mask_ && is_masked) report.new_mask = region->mask;
  if (region->is_released || (is_masked && !auto_mask_)) return report;
  report.findings.push_back({{WarningKind::static_region, region->text()}});
  return report;
}

/// Whether the images may show different moments.
bool RigMonitor::doubts_time(const RigEvidence& evidence) const {
  return (searched_ && searched_->on_line_ratio < kSoundOnLine) || evidence.epipolar_residual > kDoubtfulResidual;
}

/// Looks for corners, for displacements since the last frame, too, if that was searched; they show whether a camera is
/// late. Before that, distances from the lines that no fit explains are not blamed on the calibration.
void RigMonitor::search(const StereoFrame& frame, double max_disparity, const RigEstimate& rig,
                        const HiddenPixels& hidden, RigReport& report) {
  const GreyPlane last = std::exchange(last_view_, {});
  const CornerQuestion question{corner_matcher_,
                                rig_,
                                frame,
                                max_disparity,
                                rig,
                                hidden,
                                frames_since_search_ == 1 && !last.grey.empty() ? &last : nullptr};
  CornerAnswer answer;
  // If the rig was right before, a third of the corners suffices to see that it still is.
  if (searched_ && fits_) answer = search_and_judge(question, report, kSparseCorners);
  if (answer.search.found.size() < kMinMatches || !report.findings.empty() || doubts_time(report.evidence))
    answer = search_and_judge(question, report);
  last_view_ = std::move(answer.search.left_view);
  frames_since_search_ = 0;
  searched_ = report.evidence;
  judge_time(answer.search.found, report);
  fits_ = report.mismatch() == nullptr;
  const bool may_be_late = question.last_view == nullptr && answer.fit.scatter > kDoubtfulResidual && fits_;
  if (may_be_late && drop(WarningKind::doubtful_calibration, report)) searched_.reset();  // the next frame is searched
}

/// Refuses a frame whose images show different moments, unless edges lie on their lines: where thin structures cross,
/// corners are no points of the scene, and move with the camera as they do between the cameras.
void RigMonitor::judge_time(const std::vector<CornerMatch>& found, RigReport& report) {
  if (report.evidence.matched_ratio > kCertainMatchedRatio) return;
  std::vector<CornerMatch> moved;
  std::vector<double> motions;
  for (const CornerMatch& match : found) {
    if (!match.is_aligned || !match.is_unique || !match.motion) continue;
    motions.push_back(match.motion->norm());
    moved.push_back(match);
    moved.back().right = match.left;  // where the motion is known
  }
  const double motion = motions.empty() ? RigEvidence::kUnknown : upper_median(motions);
  if (motion > kMinImageMotion) times_.add(moved);
  const double late = times_.delay();
  if (late == 0 || times_.is_delay_contradicted_by(moved)) return;
  const bool is_off = std::isnan(motion) ? report.evidence.searched_residual > kDoubtfulResidual
                                         : std::abs(late) * motion > kDoubtfulResidual;
  const bool is_delayed = std::abs(late) > kWrongPartner && is_off;
  if (is_delayed) report.findings.clear();
  if (report.mismatch() == nullptr) report.findings.push_back({late_camera(late), is_delayed});
}

std::optional<RigFinding> RigMonitor::observe_motion(const Eigen::Isometry3d& current_from_last) {
  if (searched_ && doubts_time(*searched_)) return std::nullopt;  // edges then lie where matches were looked for
  const Eigen::Isometry3d last_from_current = current_from_last.inverse();
  for (CornerMatch& match : corner_matches_) {
    const Eigen::Vector3d last =
        last_from_current.linear() * rig_.left.ray(match.left) + last_from_current.translation() * match.inverse_depth;
    if (last.z() > 0) match.motion = match.left - rig_.left.project(last);
    match.right = match.left;
  }
  const auto stands = [](const CornerMatch& match) { return !match.motion; };
  corner_matches_.erase(std::remove_if(corner_matches_.begin(), corner_matches_.end(), stands), corner_matches_.end());
  times_.add(corner_matches_);
  const double late = times_.delay();
  return late == 0 ? std::nullopt : std::optional(RigFinding{late_camera(late)});
}

RigReport RigMonitor::examine(const StereoRig& rig, const StereoFrame& frame, double max_disparity) {
  RigReport report;
  search_and_judge({CornerMatcher(rig), rig, frame, max_disparity, {}, {}, nullptr}, report);
  blame_masks(rig, {}, report);
  return report;
}

}  // namespace quadedge::rig
