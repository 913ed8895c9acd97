/// \file rig_learning.cpp  Learns from short stretches spread over the recording, or longer ones if these move little.
#include "cli/rig_learning.hpp"

#include <string>
#include <vector>

#include "cli/console.hpp"

namespace quadedge::cli {
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
