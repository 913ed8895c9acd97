#include "cli/rig_check.hpp"

#include <cstdio>
#include <set>

#include "odometry/rig_evidence.hpp"

namespace quadedge::cli {

void check_rig_evidence(const Dataset& dataset, DatasetCheck& check) {
  for (const auto& warning : odometry::implausible_numbers(dataset.rig)) check.warnings.push_back(warning);
  if (dataset.frames.empty()) return;
  for (const std::size_t i : std::set<std::size_t>{0, dataset.frames.size() / 2, dataset.frames.size() - 1}) {
    const FrameFiles& files = dataset.frames[i];
    const Image left = read_grey_image(files.left), right = read_grey_image(files.right);
    RigEvidence evidence;
    const odometry::RigFindings findings = odometry::examine_frame(
        dataset.rig, {files.stamp_ns, left.view(), right.view()}, dataset.max_disparity, evidence);
    const std::string frame = "frame " + std::to_string(i) + ": ";
    char text[160];
    if (evidence.is_searched()) {
      std::snprintf(text, sizeof text,
                    "epipolar residual %.2f px, %.0f %% of sought spots found, %.0f %% of these on their line",
                    evidence.searched_residual, 100 * evidence.found_ratio, 100 * evidence.on_line_ratio);
      check.facts.push_back(frame + text);
    } else {
      check.facts.push_back(frame + "no spot to ask whether the calibration fits");
    }
    if (!findings.mismatch.empty()) check.warnings.push_back(frame + findings.mismatch);
    for (const auto& doubt : findings.doubts) check.warnings.push_back(frame + doubt);
  }
}

}  // namespace quadedge::cli
