/// \file calibration.cpp  Corner searches in the first, middle and last frame; delay and combing in some. Learns from
/// short stretches spread over the recording, or longer ones if these move little.
#include "cli/calibration.hpp"

#include <cmath>
#include <cstdio>

#include "cli/console.hpp"
#include "common/printed.hpp"
#include "data/text.hpp"
#include "geometry/disparity_range.hpp"
#include "output/output_folder.hpp"
#include "quadedge/error.hpp"
#include "rig/rig_constants.hpp"
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
  if (is_due) combing_.add(pair.left.view());
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
  if (combing_.ratio() > rig::kInterlacedRatio)
    found_.warnings.push_back(printed(
        "odd and even rows are shifted against one another in %.0f %% of the left images' texture: is the video "
        "interlaced? ffmpeg -vf bwdif deinterlaces it",
        100 * combing_.ratio()));
  check.facts.insert(check.facts.end(), found_.facts.begin(), found_.facts.end());
  check.warnings.insert(check.warnings.end(), found_.warnings.begin(), found_.warnings.end());
}

void CalibrationExport::declare(Options& options) {
  options.output("--kalibr", kalibr_, "also write it as Kalibr's camera chain, whose lenses have no k3");
  options.output("--opencv", opencv_, "also write it as matrices of OpenCV (M1 D1 M2 D2 R T)");
  options.output("--ros", ros_, "also write it as camera_info of ROS, with R and P that rectify: LEFT,RIGHT");
}

bool CalibrationExport::empty() const { return kalibr_.empty() && opencv_.empty() && ros_.empty(); }

void CalibrationExport::check(bool force) const {
  report::check_output_file(kalibr_, force);
  report::check_output_file(opencv_, force);
  if (ros_.empty()) return;
  const std::vector<std::string> both = data::file_list(ros_);
  if (both.size() != 2) throw UsageError("--ros " + ros_ + ": expected two files: LEFT,RIGHT");
  for (const std::string& file : both) report::check_output_file(file, force);
}

void CalibrationExport::write(const StereoCalibration& calibration) const {
  std::string refused;
  for (const auto& [format, files] : {std::pair{"kalibr", kalibr_}, {"opencv", opencv_}, {"ros", ros_}}) {
    if (files.empty()) continue;
    try {
      write_calibration(files, calibration, format);
    } catch (const UsageError& problem) {
      refused += (refused.empty() ? "" : "; ") + files + ": " + problem.what();
    }
  }
  if (!refused.empty()) throw UsageError(refused);
}

namespace {

constexpr int kStretch = 12;  // frames

/// Which frames to read: all, or evenly spread stretches of so many.
std::vector<int> chosen_frames(int frames, int most, int length) {
  std::vector<int> chosen;
  const int stretches = std::max(1, most / std::max(1, length));
  for (int i = 0; i < frames; ++i) {
    // The stretch that would begin last before this frame.
    const auto begin = static_cast<int>(static_cast<std::int64_t>(i) * stretches / frames * frames / stretches);
    if (frames <= most || i - begin < length) chosen.push_back(i);
  }
  return chosen;
}

/// Learns from the chosen frames, or from all if none are chosen.
DriveCalibration learn_from(const std::vector<int>& chosen, const Dataset& dataset, const LearningLimits& limits,
                            bool quiet, const Interruption& interruption) {
  Dataset read = dataset;
  const auto frames = static_cast<int>(dataset.frames.size());
  if (!chosen.empty()) {
    read.frames.clear();
    for (const int frame : chosen) read.frames.push_back(dataset.frames[static_cast<std::size_t>(frame)]);
  }
  DriveCalibrator calibrator(dataset.calibration.value_or(pinhole_calibration(dataset.rig)), dataset.rig,
                             DriveCalibrator::kMostPairs, limits.has_k3);
  FramePrefetcher source(read, 2, [&] { return interruption.signal() != 0; });
  Progress progress(quiet, "frames");
  int done = 0;
  while (const auto pair = source.next()) {
    const auto number = static_cast<std::size_t>(done++);
    if (number > 0 && number < chosen.size() && chosen[number] != chosen[number - 1] + 1) calibrator.restart();
    calibrator.see(pair->view());
    const std::string found = std::to_string(calibrator.pairs()) + " pairs with motion";
    progress.update("learning from frame", done, chosen.empty() ? frames : static_cast<int>(chosen.size()), found);
    if (limits.enough_pairs > 0 && calibrator.pairs() >= limits.enough_pairs) break;
  }
  if (interruption.signal() != 0) interruption.end_process();
  return calibrator.finish();
}

}  // namespace

DriveCalibration learn_rig(const Dataset& dataset, const LearningLimits& limits, bool quiet,
                           const Interruption& interruption) {
  if (dataset.stream || limits.enough_pairs > 0) return learn_from({}, dataset, limits, quiet, interruption);
  const auto frames = static_cast<int>(dataset.frames.size());
  DriveCalibration learned =
      learn_from(chosen_frames(frames, limits.frames, kStretch), dataset, limits, quiet, interruption);
  if (learned.verdict != CalibrationVerdict::cannot_show || frames <= limits.frames) return learned;
  // A camera that moves little between frames shows its motion only in a longer stretch.
  return learn_from(chosen_frames(frames, limits.frames, limits.frames / 2), dataset, limits, quiet, interruption);
}

}  // namespace quadedge::cli
