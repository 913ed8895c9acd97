#include "odometry/rig_findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace quadedge::odometry {
namespace {

constexpr int kMinCorners = 20, kMinMatches = 12;
/// Fraction of the corners; valid recordings have 0.7 to 0.95, with strong noise 0.25.
constexpr double kLostFoundRatio = 0.2;
/// Fraction of the left edges; valid recordings have more than 0.4, with strong noise 0.13.
constexpr double kLostMatchedRatio = 0.1;
constexpr double kMajority = 0.5;
constexpr double kWarningRatio = 0.1;  // valid recordings have up to 0.03 beyond either end
/// Distance from the line beyond which an edge lies outside the patches that the cascade compares (half side 3.5 px).
/// [px]
constexpr double kLostResidual = 3;
/// Distance from the line that the cascade searches; valid recordings have up to 0.4. [px]
constexpr double kDoubtfulResidual = 0.5;
/// If more of the edges than this have a match on their epipolar lines, corners off their lines are mostly on thin
/// structures. Doubtful rigs reach 0.51, valid ones 0.72 and more.
constexpr double kReliableMatchedRatio = 0.65;

std::string number(double value, int decimals) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string percent(double ratio) { return number(100 * ratio, 0) + " %"; }

std::string matched(const RigEvidence& evidence) {
  if (!(evidence.matched_ratio >= 0)) return {};
  return percent(evidence.matched_ratio) + " of the left edges have a match, ";
}

std::string seen_across(const EpipolarFit& fit) {
  return "corners are found " + number(fit.residual, 1) + " px off their epipolar lines (" + number(fit.offset, 1) +
         " px in the middle of the image, changing by " + number(fit.slope_x, 1) + " px over its width and " +
         number(fit.slope_y, 1) + " px over its height)";
}

/// Likely cause of the distances from the lines.
std::string cause_across(const EpipolarFit& fit) {
  const double x = std::abs(fit.slope_x) / 2, y = std::abs(fit.slope_y) / 2, middle = std::abs(fit.offset);
  if (fit.scatter > kMajority * fit.residual) {
    return "is the direction of the baseline or the right camera's yaw wrong, or are distorted images used with a "
           "pinhole calibration?";
  }
  if (y >= x && y >= middle) return "is a focal length in the calibration wrong?";
  if (x >= middle) return "is one camera rolled relative to the calibration?";
  return "is one camera pitched relative to the calibration, is its principal point wrong, or are left and right "
         "exchanged?";
}

}  // namespace

std::vector<Warning> implausible_numbers(const StereoRig& rig) {
  std::vector<Warning> found;
  const auto add = [&](const std::string& text) { found.push_back({WarningKind::implausible_calibration, text}); };
  const double baseline = rig.baseline();
  if (baseline > 5) add("the baseline is " + number(baseline, 3) + " m: is it given in millimetres?");
  if (baseline < 0.005) add("the baseline is " + number(baseline, 6) + " m: is it given in metres?");
  for (const bool is_left : {true, false}) {
    const PinholeCamera& camera = is_left ? rig.left : rig.right;
    const std::string name = is_left ? "the left camera's " : "the right camera's ";
    const double widths = camera.fx / camera.width, shape = camera.fx / camera.fy;
    if (widths < 0.2 || widths > 20)
      add(name + "focal length is " + number(widths, 2) + " image widths: is it given in pixels?");
    if (shape < 1 / 1.5 || shape > 1.5)
      add(name + "fx is " + number(shape, 2) + " times its fy: are the pixels really not square?");
    if (!(camera.cx >= 0 && camera.cx < camera.width && camera.cy >= 0 && camera.cy < camera.height))
      add(name + "principal point (" + number(camera.cx, 1) + ", " + number(camera.cy, 1) + ") lies outside its image");
  }
  return found;
}

void add_search_results(const ProbeSearch& search, const EpipolarFit& fit, RigEvidence& evidence) {
  if (search.searched == 0) return;
  evidence.found_ratio = static_cast<double>(search.found.size()) / search.searched;
  evidence.searched_residual = fit.samples > 0 ? fit.residual : RigEvidence::kUnknown;
  if (search.found.empty()) return;
  int aligned = 0, on_line = 0, negative = 0, beyond = 0;
  for (const CornerMatch& match : search.found) {
    negative += match.along < -1 - 2 * match.sigma ? 1 : 0;
    beyond += match.along > search.max_disparity + 1 + 2 * match.sigma ? 1 : 0;
    aligned += match.is_aligned ? 1 : 0;
    on_line += match.is_aligned && std::abs(match.across) < 1 ? 1 : 0;
  }
  const auto found = static_cast<double>(search.found.size());
  if (aligned > 0) evidence.on_line_ratio = static_cast<double>(on_line) / aligned;
  evidence.negative_ratio = negative / found;
  evidence.beyond_ratio = beyond / found;
}

bool finds_few_corners(const ProbeSearch& search, const RigEvidence& evidence) {
  return search.searched >= kMinCorners && evidence.found_ratio < kLostFoundRatio &&
         !(evidence.matched_ratio > kLostMatchedRatio);
}

RigFindings judge_search(const ProbeSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                         const std::string& turned) {
  RigFindings findings;
  const auto does_not_fit = [&](const std::string& seen, const std::string& cause) {
    findings.mismatch = "the images do not fit the calibration: " + matched(evidence) + seen + "; " + cause;
  };
  if (finds_few_corners(search, evidence)) {
    const std::string seen = percent(evidence.found_ratio) + " of " + std::to_string(search.searched) +
                             " corners of the left image are found in the right one";
    if (search.negative > kMajority * search.searched) {
      does_not_fit(
          seen + ", and " + percent(static_cast<double>(search.negative) / search.searched) + " as their negative",
          "is one image a negative?");
    } else if (!turned.empty()) {
      does_not_fit(seen + ", but most are found if it is " + turned, "is the right image " + turned + "?");
    } else {
      does_not_fit(seen, "do both cameras see the same scene at the same time? is one image mirrored or rotated?");
    }
    return findings;
  }
  if (search.found.size() < static_cast<std::size_t>(kMinMatches)) return findings;
  if (evidence.negative_ratio > kMajority) {
    does_not_fit(
        percent(evidence.negative_ratio) + " of the disparities are negative",
        "are left and right exchanged, are the images mirrored, is the sign of the baseline wrong, or the right "
        "camera's yaw?");
  } else if (fit.residual > kLostResidual) {
    does_not_fit(seen_across(fit), cause_across(fit));
  } else if (!fit.is_coarse && fit.residual > kDoubtfulResidual && !(evidence.matched_ratio > kReliableMatchedRatio)) {
    findings.warnings.push_back(
        {WarningKind::doubtful_calibration,
         "the calibration is doubtful: " + matched(evidence) + seen_across(fit) + "; " + cause_across(fit)});
  }
  if (!findings.mismatch.empty()) return findings;
  if (evidence.beyond_ratio > kWarningRatio) {
    findings.warnings.push_back({WarningKind::small_disparity_range,
                                 percent(evidence.beyond_ratio) + " of the corners exceed the maximum disparity, " +
                                     number(search.max_disparity, 1) +
                                     " px: is stereo.max_disparity too small, or stereo.min_depth too large?"});
  }
  if (evidence.negative_ratio > kWarningRatio) {
    findings.warnings.push_back(
        {WarningKind::negative_disparities,
         percent(evidence.negative_ratio) +
             " of the disparities are negative: is the right camera's yaw or principal point wrong?"});
  }
  return findings;
}

}  // namespace quadedge::odometry
