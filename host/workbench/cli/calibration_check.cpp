/// \file calibration_check.cpp  Corner searches in the first, middle and last frame; delay in some.
#include "cli/calibration_check.hpp"

#include <cmath>

#include "common/printed.hpp"
#include "geometry/disparity_range.hpp"
#include "rig/rig_monitor.hpp"

namespace quadedge::cli {
namespace {

/// Tests the calibration on one frame: adds the figures, and warnings where it does not fit.
void check_rig_evidence(const Dataset& dataset, const StereoPair& pair, DatasetCheck& check) {
  const rig::RigReport report = rig::RigMonitor::examine(
      dataset.rig, {pair.stamp_ns, pair.left.view(), pair.right.view()}, disparity_limit(dataset.rig));
  const RigEvidence& evidence = report.evidence;
  const std::string frame = "frame " + std::to_string(pair.number) + ": ";
  if (evidence.is_searched() && std::isfinite(evidence.searched_residual)) {
    check.facts.push_back(
        frame + printed("epipolar residual %.2f px, %.0f %% of corners found, %.0f %% of these on their line",
                        evidence.searched_residual, 100 * evidence.found_ratio, 100 * evidence.on_line_ratio));
  } else {
    check.facts.push_back(frame + "too little texture to test the calibration");
  }
  for (const auto& finding : report.findings) check.warnings.push_back(frame + finding.warning.text);
  if (pair.number > 0) return;
  if (const std::string proposal = rectified_proposal(dataset, pair); !proposal.empty())
    check.warnings.push_back(frame + proposal);
}

}  // namespace

std::string rectified_proposal(const Dataset& dataset, const StereoPair& pair) {
  if (!dataset.calibration || dataset.calibration->of_rectified.empty()) return {};
  const auto evidence_of = [&](StereoRig rig) {
    rig.max_value = dataset.rig.max_value;
    return rig::RigMonitor::examine(rig, {pair.stamp_ns, pair.left.view(), pair.right.view()}, disparity_limit(rig))
        .evidence;
  };
  const RigEvidence recorded = evidence_of(dataset.rig),
                    rectified = evidence_of(make_rig(dataset.calibration->of_rectified.front()));
  constexpr double kMinFound = 0.3, kFits = 1, kDoubtful = 0.25, kBetter = 0.5;  // the rows of KITTI are off by 0.4 px
  if (!(rectified.found_ratio > kMinFound && rectified.searched_residual < kFits)) return {};
  const bool is_off =
      recorded.searched_residual > kDoubtful && rectified.searched_residual < kBetter * recorded.searched_residual;
  if (!is_off && !(recorded.found_ratio < kBetter * rectified.found_ratio)) return {};
  const auto figures = [](const RigEvidence& evidence) {
    return printed("%.0f %% of the corners found, %.2f px off their lines", 100 * evidence.found_ratio,
                   evidence.searched_residual);
  };
  return "the images fit the calibration's projection matrices P (" + figures(rectified) + ") better than K and D (" +
         figures(recorded) + "): are they rectified? --rectified takes P";
}

void RigEvidenceCollector::see(const Dataset& dataset, const StereoPair& pair) {
  if (!dataset_) {
    dataset_ = dataset;
    dataset_->stream = nullptr;  // which is read elsewhere
    for (const auto& finding : rig::implausible_numbers(dataset.rig)) found_.warnings.push_back(finding.warning.text);
  }
  const auto frames = static_cast<int>(dataset.frames.size());
  last_ = std::nullopt;
  constexpr int kFrames = 12;
  const bool is_due = frames == 0 ? (pair.number & (pair.number - 1)) == 0  // ever fewer
                                  : pair.number * kFrames % frames < kFrames;
  delays_.add(dataset.rig, pair.left, pair.right, disparity_limit(dataset.rig), is_due);
  if (pair.number == 0 || pair.number == frames / 2) {
    check_rig_evidence(dataset, pair, found_);
  } else {
    last_ = pair;
  }
}

void RigEvidenceCollector::finish(DatasetCheck& check) {
  if (last_) check_rig_evidence(*dataset_, *last_, found_);
  if (const std::string delay = delays_.text(); !delay.empty()) found_.warnings.push_back(delay);
  check.facts.insert(check.facts.end(), found_.facts.begin(), found_.facts.end());
  check.warnings.insert(check.warnings.end(), found_.warnings.begin(), found_.warnings.end());
}

}  // namespace quadedge::cli
