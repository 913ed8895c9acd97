#include "cli/calibration_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "common/disparity_range.hpp"
#include "rig/rig_correction.hpp"
#include "rig/rig_monitor.hpp"

namespace quadedge::cli {

void check_numbers(const StereoRig& rig, DatasetCheck& check) {
  for (const auto& finding : rig::implausible_numbers(rig)) check.warnings.push_back(rig::warning(finding).text);
}

void check_rig_evidence(const Dataset& dataset, const StereoPair& pair, DatasetCheck& check) {
  const rig::RigReport report = rig::RigMonitor::examine(
      dataset.rig, {pair.stamp_ns, pair.left.view(), pair.right.view()}, disparity_limit(dataset.rig));
  const RigEvidence& evidence = report.evidence;
  const std::string frame = "frame " + std::to_string(pair.number) + ": ";
  char text[160];
  if (evidence.is_searched() && std::isfinite(evidence.searched_residual)) {
    std::snprintf(text, sizeof text,
                  "epipolar residual %.2f px, %.0f %% of corners found, %.0f %% of these on their line",
                  evidence.searched_residual, 100 * evidence.found_ratio, 100 * evidence.on_line_ratio);
    check.facts.push_back(frame + text);
  } else {
    check.facts.push_back(frame + "too little texture to test the calibration");
  }
  for (const auto& finding : report.findings) check.warnings.push_back(frame + rig::warning(finding).text);
  if (pair.number > 0) return;
  if (const std::string proposal = rectified_proposal(dataset, pair); !proposal.empty())
    check.warnings.push_back(frame + proposal);
}

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
    char text[64];
    std::snprintf(text, sizeof text, "%.0f %% of the corners found, %.2f px off their lines",
                  100 * evidence.found_ratio, evidence.searched_residual);
    return std::string(text);
  };
  return "the images fit the calibration's projection matrices P (" + figures(rectified) + ") better than K and D (" +
         figures(recorded) + "): are they rectified? --rectified takes P";
}

bool RowEvidence::wants(int frame, std::size_t frames) {
  constexpr int kFrames = 12;
  if (frames == 0) return (frame & (frame - 1)) == 0;  // ever fewer
  return frame % std::max(1, static_cast<int>(frames) / kFrames) == 0;
}

void RowEvidence::see(const StereoRig& rig, const StereoPair& pair) {
  std::vector<rig::CornerMatch> matches =
      rig::CornerMatcher(rig).search({pair.stamp_ns, pair.left.view(), pair.right.view()}, disparity_limit(rig)).found;
  matches.erase(std::remove_if(matches.begin(), matches.end(), [](const auto& match) { return !match.is_aligned; }),
                matches.end());
  if (!rows_) rows_.emplace(rig.right);
  rows_->add(matches);
}

StereoCalibration RowEvidence::finish(const Dataset& dataset, DatasetCheck& check) const {
  StereoCalibration calibration = dataset.calibration.value_or(pinhole_calibration(dataset.rig));
  if (!rows_ || rows_->sums().frames < 2) return calibration;  // one frame does not show how certain its rows are
  const rig::RigCorrection correction = rig::correction_of(dataset.rig, *rows_);
  check.facts.push_back(correction.text());
  return correction.applied(calibration);
}

StereoCalibration check_rig_evidence(const Dataset& dataset, DatasetCheck& check) {
  check_numbers(dataset.rig, check);
  RowEvidence rows;
  if (dataset.frames.empty()) return rows.finish(dataset, check);
  for (const std::size_t i : std::set<std::size_t>{0, dataset.frames.size() / 2, dataset.frames.size() - 1}) {
    const FrameFiles& files = dataset.frames[i];
    check_rig_evidence(dataset,
                       {static_cast<int>(i), files.stamp_ns, read_grey_image(files.left), read_grey_image(files.right)},
                       check);
  }
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    if (!RowEvidence::wants(static_cast<int>(i), dataset.frames.size())) continue;
    const FrameFiles& files = dataset.frames[i];
    rows.see(dataset.rig,
             {static_cast<int>(i), files.stamp_ns, read_grey_image(files.left), read_grey_image(files.right)});
  }
  return rows.finish(dataset, check);
}

void RigEvidenceCollector::see(const Dataset& dataset, const StereoPair& pair) {
  if (!dataset_) {
    dataset_ = dataset;
    dataset_->stream = nullptr;  // which is read elsewhere
    check_numbers(dataset.rig, found_);
  }
  const auto middle = static_cast<int>(dataset.frames.size() / 2);
  last_ = std::nullopt;
  if (RowEvidence::wants(pair.number, dataset.frames.size())) rows_.see(dataset.rig, pair);
  if (pair.number == 0 || pair.number == middle) {
    check_rig_evidence(dataset, pair, found_);
  } else {
    last_ = pair;
  }
}

StereoCalibration RigEvidenceCollector::finish(DatasetCheck& check) {
  if (last_) check_rig_evidence(*dataset_, *last_, found_);
  check.facts.insert(check.facts.end(), found_.facts.begin(), found_.facts.end());
  check.warnings.insert(check.warnings.end(), found_.warnings.begin(), found_.warnings.end());
  return rows_.finish(*dataset_, check);
}

}  // namespace quadedge::cli
