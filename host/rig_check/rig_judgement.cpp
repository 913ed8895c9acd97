#include "rig_check/rig_judgement.hpp"

#include <cmath>

#include "rig_check/rig_check_constants.hpp"

namespace quadedge::rig_check {

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

std::optional<RigFinding> judge_disparity_offset(double offset) {
  if (!(std::abs(offset) > kMaxOffset)) return std::nullopt;
  RigFinding finding{RigFindingKind::large_disparity_offset};
  finding.disparity_offset = offset;
  return finding;
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

std::vector<RigFinding> judge_search(const ProbeSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                                     ImageTurn turn) {
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
  if (evidence.negative_ratio > kMajority || fit.residual > kLostResidual) {
    add(evidence.negative_ratio > kMajority ? RigFindingKind::negative_disparities : RigFindingKind::far_off_lines);
    return findings;
  }
  const bool finds_edges_on_lines = evidence.matched_ratio > kReliableMatchedRatio && evidence.epipolar_correction == 0;
  if (!fit.is_coarse && fit.residual > kDoubtfulResidual && !finds_edges_on_lines) add(RigFindingKind::off_lines);
  if (evidence.beyond_ratio > kWarningRatio) add(RigFindingKind::beyond_range);
  if (evidence.negative_ratio > kWarningRatio) add(RigFindingKind::some_negative_disparities);
  return findings;
}

}  // namespace quadedge::rig_check
