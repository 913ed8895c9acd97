/// \file corner_judgement.cpp  Ratios and a fit of what a search found; thresholds; the largest term of the fit names
/// the likely cause.
#include "rig/corner_judgement.hpp"

#include <algorithm>
#include <cmath>

#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// By how much farther along its line a match lies than rows and disparity offset predict of a point at infinity [px].
double disparity_of(const CornerMatch& match, const StereoRig& rig, const RigEstimate& known) {
  const double roll = known.rows.slope_x / rig.right.width;
  return match.along + known.added_disparity() - roll * (match.right.y() - rig.right.cy);
}

/// Adds the results of a search to the evidence. Where texture repeats, a corner's match may lie anywhere, so that only
/// unique ones have a say.
void add_search_results(CornerAnswer& answer, const CornerQuestion& question, RigEvidence& evidence) {
  const CornerSearch& search = answer.search;
  if (search.searched == 0) return;
  evidence.found_ratio = static_cast<double>(search.found.size()) / search.searched;
  if (search.found.size() >= kMinMatches) evidence.searched_residual = answer.fit.residual;
  int unique = 0, all_negative = 0, negative = 0, beyond = 0;
  for (const CornerMatch& match : search.found) {
    const int is_negative = disparity_of(match, question.rig, question.known) < -1 - 2 * match.sigma ? 1 : 0;
    all_negative += is_negative;
    if (!match.is_unique) continue;
    ++unique;
    negative += is_negative;
    beyond += match.along > question.max_disparity + 1 + 2 * match.sigma ? 1 : 0;
  }
  if (search.aligned > 0) evidence.on_line_ratio = static_cast<double>(search.on_line) / search.aligned;
  if (!search.found.empty()) {
    answer.unique_ratio = static_cast<double>(unique) / static_cast<double>(search.found.size());
    answer.negative_ratio = static_cast<double>(all_negative) / static_cast<double>(search.found.size());
  }
  if (unique < static_cast<int>(kMinMatches)) return;
  evidence.negative_ratio = static_cast<double>(negative) / unique;
  evidence.beyond_ratio = static_cast<double>(beyond) / unique;
}

bool is_uneven(const CornerSearch& search) {
  return std::max(search.brightness, 1 / std::max(search.brightness, 1e-3)) > kUnevenBrightness;
}

/// Why corners leave their lines, if the images are to blame, saturated or unequally exposed, in a sentence; else
/// empty. \param seen what was found, between the figure and the cause
std::string poor_images(const CornerSearch& search, const std::string& seen) {
  const double saturated = static_cast<double>(search.saturated) / std::max(1, search.searched + search.saturated);
  if (saturated > kSaturatedRatio)
    return printed("%.0f %% of the corners lie beside saturated pixels", 100 * saturated) + seen +
           ": is the exposure too long?";
  if (!is_uneven(search)) return {};
  return printed("the right image is %.1f times as bright as the left one", search.brightness) + seen +
         ": do both cameras have the same exposure and gain?";
}

/// Whether so few corners are found that transformed images should be tried.
bool finds_few_corners(const CornerSearch& search, const RigEvidence& evidence) {
  return search.searched >= kMinCorners && evidence.found_ratio < kLostFoundRatio &&
         !(evidence.matched_ratio > kLostMatchedRatio);
}

/// Those of an EpipolarFit.
Eigen::Vector3d terms_of(const CornerMatch& match, const PinholeCamera& left) {
  return {1, match.left.x() / left.width - 0.5, match.left.y() / left.height - 0.5};
}

/// Fraction of the aligned corners that lie on their lines, although the fit to all puts these corners off them. Where
/// curves cross one another, corners are no points of the scene and agree on a distance that is none of the rig's.
double contradicting_ratio(const CornerSearch& search, const EpipolarFit& fit, const PinholeCamera& left) {
  int contradicting = 0;
  for (const CornerMatch& match : search.found) {
    if (!match.is_aligned) continue;
    const double fitted = fit.terms.dot(terms_of(match, left));
    contradicting += std::abs(match.across) < kOnLine && std::abs(fitted) > kOffLine ? 1 : 0;
  }
  return static_cast<double>(contradicting) / std::max(1, search.aligned);
}

std::string seen_across(const EpipolarFit& fit) {
  return printed(
      "corners are found %.1f px off their epipolar lines (%.1f px in the middle of the image, changing by %.1f px "
      "over "
      "its width and %.1f px over its height)",
      fit.residual, fit.terms[0], fit.terms[1], fit.terms[2]);
}

/// Likely cause of the distances from the lines.
std::string cause_across(const EpipolarFit& fit) {
  const double middle = std::abs(fit.terms[0]), x = std::abs(fit.terms[1]) / 2, y = std::abs(fit.terms[2]) / 2;
  if (fit.scatter > 0.5 * fit.residual) {
    return "is the direction of the baseline or the right camera's yaw wrong, are distorted images used with a pinhole "
           "calibration, or do the images show different moments (`quadedge check` looks for a delay)?";
  }
  if (y >= x && y >= middle) return "is a focal length in the calibration wrong?";
  if (x >= middle) return "is one camera rolled relative to the calibration?";
  return "is one camera pitched relative to the calibration, is its principal point wrong, or are left and right "
         "exchanged?";
}

/// What is wrong where few corners are found.
std::string cause_of_few(const CornerSearch& search, const RigEvidence& evidence) {
  const std::string found = percent(evidence.found_ratio) + " of " + std::to_string(search.searched) +
                            " corners of the left image are found in the right one";
  if (search.negative > kMajority * search.searched)
    return found + ", and " + percent(static_cast<double>(search.negative) / search.searched) +
           " as their negative; is one image a negative?";
  return found + "; do both cameras see the same scene at the same time? is one image mirrored or rotated?";
}

/// Judges the rig by the results of a search.
// LONG: a sentence per finding.
std::vector<RigFinding> judge(const CornerAnswer& answer, const CornerQuestion& question, const RigEvidence& evidence) {
  const CornerSearch& search = answer.search;
  const EpipolarFit& fit = answer.fit;
  const std::string matched =
      evidence.matched_ratio >= 0 ? percent(evidence.matched_ratio) + " of the left edges have a match, " : "";
  const auto mismatch = [&](const std::string& seen) {
    const std::string text = "the images do not fit the calibration: " + matched + seen;
    return std::vector<RigFinding>{{{WarningKind::doubtful_calibration, text}, true}};
  };
  if (finds_few_corners(search, evidence)) {
    if (const std::string poor = is_uneven(search) && search.more_saturated > kUnevenSaturation &&
                                         !(search.negative > kMajority * search.searched)
                                     ? poor_images(search, "; few corners are found in both images")
                                     : "";
        !poor.empty())
      return {{{WarningKind::poor_images, poor}}};
    // Few corners have a partner where something comes near the lenses, but chance puts none on their lines.
    if (!(evidence.matched_ratio >= 0) && !fit.is_coarse && evidence.on_line_ratio > kSoundOnLine) return {};
    return mismatch(cause_of_few(search, evidence));
  }
  if (search.found.size() < kMinMatches) return {};
  const bool is_uncorrected = evidence.epipolar_correction == 0,
             finds_edges_on_lines = evidence.matched_ratio > kReliableMatchedRatio && is_uncorrected,
             is_contradicted = evidence.matched_ratio > kCertainMatchedRatio && is_uncorrected &&
                               contradicting_ratio(search, fit, question.rig.left) >= kContradictingRatio;
  if (evidence.negative_ratio > kMajority)
    return mismatch(percent(evidence.negative_ratio) +
                    " of the disparities are negative; are left and right exchanged, are the images mirrored, is the "
                    "sign of the baseline wrong, or the right camera's yaw?");
  if (answer.negative_ratio > kMajority)
    return {{{WarningKind::doubtful_calibration,
              percent(1 - answer.unique_ratio) +
                  " of the corners found look like other places: texture that repeats along the epipolar lines leaves "
                  "depths open"},
             true}};
  if (fit.residual > kLostResidual && !is_contradicted) return mismatch(seen_across(fit) + "; " + cause_across(fit));
  std::vector<RigFinding> findings;
  const auto warn = [&](WarningKind kind, const std::string& text) { findings.push_back({{kind, text}}); };
  if (!fit.is_coarse && fit.residual > kDoubtfulResidual && !finds_edges_on_lines) {
    const std::string poor = poor_images(
        search,
        printed("; corners are found %.1f px off their epipolar lines, which says nothing about the calibration "
                "in such images",
                fit.residual));
    if (poor.empty())
      warn(WarningKind::doubtful_calibration,
           "the calibration is doubtful: " + matched + seen_across(fit) + "; " + cause_across(fit) + kMends);
    else
      warn(WarningKind::poor_images, poor);
  }
  if (evidence.beyond_ratio > kWarningRatio)
    warn(WarningKind::small_disparity_range,
         percent(evidence.beyond_ratio) +
             printed(" of the corners exceed the maximum disparity, %.1f px: is stereo.max_disparity too small, or "
                     "stereo.min_depth too large?",
                     question.max_disparity));
  return findings;
}

/// The fit to unique corners that were aligned; with too few of them to all that were, and then to all corners: on thin
/// curves, coarse positions do not determine the distance from the line.
EpipolarFit fit_of(const CornerSearch& search, const PinholeCamera& left) {
  EpipolarFit fit;
  std::vector<EpipolarFit::Row> unique, aligned, all;
  for (const CornerMatch& match : search.found) {
    all.push_back({match.across, terms_of(match, left)});
    if (match.is_aligned) aligned.push_back(all.back());
    if (match.is_aligned && match.is_unique) unique.push_back(all.back());
  }
  fit.is_coarse = aligned.size() < kMinMatches;
  const auto& rows = fit.is_coarse ? all : unique.size() < kMinMatches ? aligned : unique;
  if (rows.size() < kMinMatches) return fit;
  fit.measure(rows);
  fit.residual = fit.scatter;
  fit.fit(rows, kMinScale);
  return fit;
}

}  // namespace

CornerAnswer search_and_judge(const CornerQuestion& question, RigReport& report, std::size_t every) {
  CornerAnswer answer{
      question.matcher.search(question.frame, question.max_disparity, every, question.hidden, question.last_view), {}};
  answer.fit = fit_of(answer.search, question.rig.left);
  add_search_results(answer, question, report.evidence);
  report.findings = judge(answer, question, report.evidence);
  return answer;
}

}  // namespace quadedge::rig
