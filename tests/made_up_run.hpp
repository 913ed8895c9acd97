#pragma once
/// \file made_up_run.hpp  Made-up results of runs, for tests of evaluation and reports.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "dataset_files.hpp"
#include "output/json.hpp"
#include "output/json_values.hpp"

/// True pose on the made-up path, ten frames per second.
inline Eigen::Isometry3d made_up_truth(std::int64_t stamp_ns) {
  const double i = static_cast<double>(stamp_ns) * 1e-8;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << std::sin(0.3 * i), 0.1 * i, i + std::cos(0.2 * i);
  return pose;
}

/// A made-up run of `frames` frames along a bent path whose estimate drifts by `drift` metres and `drift` radians per
/// frame.
inline quadedge::report::RunRecord made_up_run(int frames, double drift) {
  quadedge::report::RunRecord run;
  run.input = {"made/up", "eth3d-slam", "made_up", frames, 640, 480};
  run.device.name = "abacus";
  quadedge::Trajectory estimate, truth;
  for (int i = 0; i < frames; ++i) {
    quadedge::report::FrameRecord frame;
    frame.result.stamp_ns = 100'000'000LL * i;
    frame.result.status = i == 0 ? quadedge::FrameStatus::first : quadedge::FrameStatus::tracked;
    frame.result.timing.latency_ms = 10 + i * 7 % 5;
    frame.result.timing.stages = {{"stereo", 4}, {"temporal", 3}};
    frame.result.counts.edges_left = 100 + i;
    Eigen::Isometry3d pose = made_up_truth(frame.result.stamp_ns);
    truth.push_back({frame.result.stamp_ns, pose});
    pose.translation().x() += drift * i;
    pose.rotate(Eigen::AngleAxisd(drift * i, Eigen::Vector3d(1, i, 2).normalized()));
    frame.result.world_from_left = pose;
    estimate.push_back({frame.result.stamp_ns, pose});
    run.frames.push_back(frame);
  }
  run.truth_file = "truth.txt";
  run.accuracy = quadedge::evaluate_trajectory(estimate, truth);
  return run;
}

/// Folder of a sequence's results within a batch.
inline std::string member_folder(const std::string& output, const std::string& name) {
  return output + "/sequences/" + name;
}

/// Writes a batch of the given runs, all tracked, with the parts of its summary that programs read.
inline void write_batch(const std::string& output,
                        const std::vector<std::pair<std::string, quadedge::report::RunRecord>>& runs) {
  auto summary = quadedge::report::Json{{"schema", 1}, {"min_tracked_percent", 50}};
  for (const auto& [name, run] : runs) {
    const std::string folder = member_folder(output, name), report = quadedge::report::report_json(run);
    dataset_files::write_text(folder + "/report.json", report);
    const auto parsed = quadedge::report::Json::parse(report);
    summary["sequences"].push_back({{"name", name},
                                    {"status", "done"},
                                    {"frames", run.frames.size()},
                                    {"frames_tracked", run.tracked()},
                                    {"latency_ms", parsed["latency_ms"]},
                                    {"accuracy", parsed["accuracy"]}});
    quadedge::Trajectory estimate, truth;
    for (const auto& frame : run.frames) {
      estimate.push_back({frame.result.stamp_ns, *frame.result.world_from_left});
      truth.push_back({frame.result.stamp_ns, made_up_truth(frame.result.stamp_ns)});
    }
    quadedge::write_tum(folder + "/trajectory.txt", estimate);
    quadedge::write_tum(folder + "/groundtruth.txt", truth);
  }
  dataset_files::write_text(output + "/summary.json", quadedge::report::json_text(summary));
}
