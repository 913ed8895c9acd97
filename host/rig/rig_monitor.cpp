/// \file rig_monitor.cpp  Inexpensive measurements decide when to search for corners; thresholds give the findings.
#include "rig/rig_monitor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "rig/interlacing.hpp"
#include "rig/poor_images.hpp"
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

/// The transformation of the right image with which a search finds most corners; none if there is no such.
ImageTurn find_turn(const CornerMatcher& matcher, const StereoFrame& frame, double max_disparity,
                    const HiddenPixels& hidden) {
  for (const ImageTurn turn : {ImageTurn::mirrored, ImageTurn::half, ImageTurn::quarter, ImageTurn::three_quarters}) {
    const CornerSearch search = matcher.search(frame, max_disparity, turn, 1, hidden);
    if (static_cast<double>(search.found.size()) > kTransformedFoundRatio * search.searched) return turn;
  }
  return ImageTurn::none;
}

/// By how much farther along its line a match lies than rows and disparity offset predict of a point at infinity [px].
double disparity_of(const CornerMatch& match, const StereoRig& rig, const RigEstimate& known) {
  const double roll = known.rows.slope_x / rig.right.width;
  return match.along + known.added_disparity() - roll * (match.right.y() - rig.right.cy);
}

/// Adds the results of a search to the evidence.
void add_search_results(const CornerSearch& search, const EpipolarFit& fit, const StereoRig& rig,
                        const RigEstimate& known, RigEvidence& evidence) {
  if (search.searched == 0) return;
  evidence.found_ratio = static_cast<double>(search.found.size()) / search.searched;
  evidence.searched_residual = fit.samples > 0 ? fit.residual : RigEvidence::kUnknown;
  if (search.found.empty()) return;
  int aligned = 0, on_line = 0, negative = 0, beyond = 0;
  for (const CornerMatch& match : search.found) {
    negative += disparity_of(match, rig, known) < -1 - 2 * match.sigma ? 1 : 0;
    beyond += match.along > search.max_disparity + 1 + 2 * match.sigma ? 1 : 0;
    aligned += match.is_aligned ? 1 : 0;
    on_line += match.is_aligned && std::abs(match.across) < kOnLine ? 1 : 0;
  }
  const auto found = static_cast<double>(search.found.size());
  if (aligned > 0) evidence.on_line_ratio = static_cast<double>(on_line) / aligned;
  evidence.negative_ratio = negative / found;
  evidence.beyond_ratio = beyond / found;
}

/// Whether so few corners are found that transformed images should be tried.
bool finds_few_corners(const CornerSearch& search, const RigEvidence& evidence) {
  return search.searched >= kMinCorners && evidence.found_ratio < kLostFoundRatio &&
         !(evidence.matched_ratio > kLostMatchedRatio);
}

/// Fraction of the aligned corners that lie on their lines, although the fit to all puts these corners off them. Where
/// curves cross one another, corners are no points of the scene and agree on a distance that is none of the rig's.
double contradicting_ratio(const CornerSearch& search, const EpipolarFit& fit, const PinholeCamera& left) {
  int aligned = 0, contradicting = 0;
  for (const CornerMatch& match : search.found) {
    if (!match.is_aligned) continue;
    ++aligned;
    const double fitted = fit.offset + fit.slope_x * (match.left.x() / left.width - 0.5) +
                          fit.slope_y * (match.left.y() / left.height - 0.5);
    contradicting += std::abs(match.across) < kOnLine && std::abs(fitted) > kOffLine ? 1 : 0;
  }
  return aligned > 0 ? static_cast<double>(contradicting) / aligned : 0;
}

/// Judges the rig by the results of a search.
/// \param turn transformation of the right image with which most corners are found, or none
std::vector<RigFinding> judge_search(const CornerSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                                     ImageTurn turn, const PinholeCamera& left) {
  std::vector<RigFinding> findings;
  const auto add = [&](RigFindingKind kind) {
    RigFinding finding{kind, evidence};
    finding.corners = search.searched;
    finding.inverted_ratio = search.searched > 0 ? static_cast<double>(search.negative) / search.searched : 0;
    finding.turn = turn;
    finding.fit = fit;
    finding.max_disparity = search.max_disparity;
    findings.push_back(finding);
  };
  if (finds_few_corners(search, evidence)) {
    if (search.negative > kMajority * search.searched) {
      add(RigFindingKind::negative_image);
    } else {
      add(turn == ImageTurn::none ? RigFindingKind::no_common_scene : RigFindingKind::turned_image);
    }
    return findings;
  }
  if (search.found.size() < static_cast<std::size_t>(kMinMatches)) return findings;
  const bool is_uncorrected = evidence.epipolar_correction == 0,
             finds_edges_on_lines = evidence.matched_ratio > kReliableMatchedRatio && is_uncorrected,
             is_contradicted = evidence.matched_ratio > kCertainMatchedRatio && is_uncorrected &&
                               contradicting_ratio(search, fit, left) >= kContradictingRatio,
             is_far = fit.residual > kLostResidual && !is_contradicted;
  if (evidence.negative_ratio > kMajority || is_far) {
    add(evidence.negative_ratio > kMajority ? RigFindingKind::negative_disparities : RigFindingKind::far_off_lines);
    return findings;
  }
  if (!fit.is_coarse && fit.residual > kDoubtfulResidual && !finds_edges_on_lines) add(RigFindingKind::off_lines);
  if (evidence.beyond_ratio > kWarningRatio) add(RigFindingKind::beyond_range);
  if (evidence.negative_ratio > kWarningRatio) add(RigFindingKind::some_negative_disparities);
  return findings;
}

/// Names the images in place of the calibration where they are to blame.
void blame_images(const CornerSearch& search, const StereoFrame& frame, std::vector<RigFinding>& findings) {
  for (RigFinding& finding : findings) {
    const bool is_unseen = finding.kind == RigFindingKind::no_common_scene && hides_corners(search);
    if (finding.kind != RigFindingKind::off_lines && !is_unseen) continue;
    auto poor = find_poor_images(search, frame);
    if (!poor) continue;
    poor->fit = finding.fit;
    finding = *poor;
  }
}

/// Adds a search for every `every`-th corner and its findings to the report. \returns the number of corners found
std::size_t search_and_judge(const CornerMatcher& matcher, const StereoRig& rig, const StereoFrame& frame,
                             double max_disparity, const RigEstimate& known, const HiddenPixels& hidden,
                             RigReport& report, std::size_t every = 1) {
  const CornerSearch search = matcher.search(frame, max_disparity, ImageTurn::none, every, hidden);
  // On thin curves, coarse positions do not determine the distance from the line.
  std::vector<CornerMatch> aligned;
  std::copy_if(search.found.begin(), search.found.end(), std::back_inserter(aligned),
               [](const CornerMatch& match) { return match.is_aligned; });
  EpipolarFit fit = fit_across(aligned, rig.left.width, rig.left.height);
  if (fit.samples == 0) {
    fit = fit_across(search.found, rig.left.width, rig.left.height);
    fit.is_coarse = true;
  }
  add_search_results(search, fit, rig, known, report.evidence);
  const ImageTurn turn =
      finds_few_corners(search, report.evidence) ? find_turn(matcher, frame, max_disparity, hidden) : ImageTurn::none;
  report.findings = judge_search(search, fit, report.evidence, turn, rig.left);
  blame_images(search, frame, report.findings);
  return search.found.size();
}

/// Adds a finding if the left image is interlaced. \returns whether it is
bool judge_rows(const ImageView& left, RigReport& report) {
  const double ratio = combed_ratio(left);
  if (ratio < kInterlacedRatio || report.mismatch() != nullptr) return false;
  report.findings.push_back({RigFindingKind::interlaced});
  report.findings.back().combed_ratio = ratio;
  return true;
}

}  // namespace

std::vector<RigFinding> implausible_numbers(const StereoRig& rig) {
  std::vector<RigFinding> found;
  const auto add = [&](RigFindingKind kind, double number) -> RigFinding& {
    found.push_back({kind});
    found.back().number = number;
    return found.back();
  };
  const double baseline = rig.baseline();
  if (baseline > 5) add(RigFindingKind::long_baseline, baseline);
  if (baseline < 0.005) add(RigFindingKind::short_baseline, baseline);
  for (const Side side : kSides) {
    const PinholeCamera& camera = side == Side::left ? rig.left : rig.right;
    const double widths = camera.fx / camera.width, shape = camera.fx / camera.fy;
    if (widths < 0.2 || widths > 20) add(RigFindingKind::focal_length, widths).camera = side;
    if (shape < 1 / 1.5 || shape > 1.5) add(RigFindingKind::pixel_shape, shape).camera = side;
    if (camera.cx >= 0 && camera.cx < camera.width && camera.cy >= 0 && camera.cy < camera.height) continue;
    RigFinding& finding = add(RigFindingKind::principal_point, 0);
    finding.camera = side;
    finding.principal_point = {camera.cx, camera.cy};
  }
  return found;
}

std::optional<RigFinding> judge_disparity_offset(double learned, double free, double sigma) {
  const bool is_shown = sigma > 0 && std::abs(learned) > sigma && learned * free > 0;
  const double offset = is_shown && std::abs(free) > std::abs(learned) ? free : learned;
  if (!(std::abs(offset) > kMaxOffset)) return std::nullopt;
  RigFinding finding{RigFindingKind::large_disparity_offset};
  finding.disparity_offset = offset;
  return finding;
}

void Synchronisation::add(double u, double v, double across, double motion) {
  Terms row;
  row << 1, u, v, u * u, u * v, v * v, -motion;
  normal_ += row * row.transpose();
  right_side_ += row * across;
  squares_ += across * across;
  ++count_;
}

double Synchronisation::time_offset_frames() const {
  if (count_ < kMinSamples) return 0;
  const Eigen::FullPivLU<Eigen::Matrix<double, 7, 7>> solver(normal_);
  if (!solver.isInvertible()) return 0;
  const Terms terms = solver.solve(right_side_);
  const double variance = (squares_ - terms.dot(right_side_)) / (count_ - 7);
  const double sigma = std::sqrt(std::fmax(variance, 0) * solver.inverse()(6, 6));
  const double offset = std::abs(terms[6]);
  return offset > kMinTimeOffset && offset < kMaxTimeOffset && offset > kMinTimeSigmas * sigma ? terms[6] : 0;
}

RigMonitor::RigMonitor(const StereoRig& rig, bool auto_mask) : rig_(rig), auto_mask_(auto_mask), corner_matcher_(rig) {}

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
  const bool is_suspicious = searches_ < kNegativeSearches && negative_ratios_ > kWarningRatio * searches_;
  if (!searched_ || !fits_ || is_suspicious || frames_since_search_ >= kSearchPeriod) return true;
  return evidence.matched_ratio < kMatchedDecrease * searched_->matched_ratio ||
         evidence.epipolar_residual > searched_->epipolar_residual + kResidualIncrease;
}

void RigMonitor::confirm_negative_disparities(RigReport& report) {
  if (!(report.evidence.negative_ratio >= 0)) return;
  ++searches_;
  negative_ratios_ += report.evidence.negative_ratio;
  if (searches_ >= kNegativeSearches && negative_ratios_ > kWarningRatio * searches_) return;
  const auto is_doubtful = [](const RigFinding& of) { return of.kind == RigFindingKind::some_negative_disparities; };
  report.findings.erase(std::remove_if(report.findings.begin(), report.findings.end(), is_doubtful),
                        report.findings.end());
}

RigReport RigMonitor::judge(const StereoFrame& frame, const StereoEdges& edges, int left_edges, double max_disparity,
                            const RigEstimate& rig, const HiddenPixels& hidden) {
  RigReport report;
  RigEvidence& evidence = report.evidence;
  evidence.epipolar_correction = rig.rows.largest();
  if (left_edges > 0) evidence.matched_ratio = static_cast<double>(edges.size()) / left_edges;
  corner_matcher_.align(frame, edges, corner_matches_);
  report.matches = &corner_matches_;
  const EpipolarFit fit = fit_across(corner_matches_, rig_.left.width, rig_.left.height);
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
    if (searched_ && fits_ && frames_since_search_ < kSearchPeriod) delay_rounds_.hasten();
    // If the rig was right before, a third of the corners suffices to see that it still is.
    const bool is_right = searched_ && fits_ &&
                          search_and_judge(corner_matcher_, rig_, frame, max_disparity, rig, hidden, report,
                                           kSparseCorners) >= static_cast<std::size_t>(kMinMatches) &&
                          report.findings.empty();
    if (!is_right) search_and_judge(corner_matcher_, rig_, frame, max_disparity, rig, hidden, report);
    frames_since_search_ = 0;
    searched_ = evidence;
    fits_ = report.mismatch() == nullptr;
    confirm_negative_disparities(report);
  }
  if (!is_frozen) judge_delay(frame, max_disparity, report);
  if (repeated && report.mismatch() == nullptr) report.findings.push_back(*repeated);
  if (!is_interlaced_ && frames_++ % kCombPeriod == 0) is_interlaced_ = judge_rows(frame.left, report);
  const auto region = static_region_.observe({frame.left, rig_.left_undistortion, rig_.left}, corner_matches_);
  if (!region) return report;
  if (auto_mask_ && region->is_released) report.new_mask = region->mask;  // else nobody would uncover it
  if (report.mismatch() != nullptr) return report;
  const bool is_masked = !region->mask.empty();
  if (auto_mask_ && is_masked) report.new_mask = region->mask;
  if (region->is_released || (is_masked && !auto_mask_)) return report;
  report.findings.push_back({is_masked ? RigFindingKind::masked_region : RigFindingKind::static_region});
  report.findings.back().region = *region;
  return report;
}

/// Whether the frame's corners ask for other partners of its images.
bool RigMonitor::doubts_partners(const RigReport& report) const {
  const double on_line = searched_ ? searched_->on_line_ratio : RigEvidence::kUnknown;
  return on_line < kDoubtfulOnLine || report.evidence.epipolar_residual > kDoubtfulResidual ||
         report.mismatch() != nullptr;
}

/// Refuses a frame whose images fit those of other frames. Until that could be seen, distances from the lines that no
/// fit explains are not blamed on the calibration.
void RigMonitor::judge_delay(const StereoFrame& frame, double max_disparity, RigReport& report) {
  const bool is_at_start = delays_.is_at_start();
  const DelaySizes due = is_at_start ? DelaySizes{} : delay_rounds_.next_frame();
  std::optional<ImageDelay> found;
  if (const auto known = delay_votes_.decided()) {
    found = delays_.measure(corner_matcher_, frame, max_disparity, *known);
  } else if (due.least <= due.most && doubts_partners(report)) {
    found = delays_.find(corner_matcher_, frame, max_disparity, due);
    if (!is_at_start) delay_rounds_.add(found.has_value(), report.mismatch() != nullptr);
  }
  delay_votes_.add(found);
  delays_.keep(frame);
  if (found) {
    held_.reset();
    fits_ = false;
    RigFinding delayed{RigFindingKind::delayed_images};
    delayed.delay = *found;
    report.findings.assign(1, delayed);
    return;
  }
  const auto waits = [](const RigFinding& finding) {
    return finding.kind == RigFindingKind::off_lines && finding.fit.scatter > kHeldScatter;
  };
  const auto waiting = std::find_if(report.findings.begin(), report.findings.end(), waits);
  if (waiting != report.findings.end() && delays_.frames() <= kHeldFrames) {
    held_ = *waiting;
    report.findings.erase(waiting);
  } else if (held_ && delays_.frames() > kHeldFrames && report.mismatch() == nullptr) {
    report.findings.push_back(*std::exchange(held_, std::nullopt));
  }
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
  search_and_judge(CornerMatcher(rig), rig, frame, max_disparity, {}, {}, report);
  judge_rows(frame.left, report);
  return report;
}

}  // namespace quadedge::rig
