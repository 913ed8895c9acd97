#pragma once
/// \file made_up_run.hpp  Made-up results of runs, for tests of evaluation and reports.

#include <cmath>
#include <filesystem>
#include <string>

#include "dataset_files.hpp"
#include "report/batch_summary.hpp"
#include "report/json.hpp"
#include "report/result_rows.hpp"

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

/// Writes a batch's results of one sequence.
inline void write_member(const std::string& output, const std::string& name, const quadedge::report::RunRecord& run) {
  const std::string folder = quadedge::report::member_folder(output, name);
  dataset_files::write_text(folder + "/report.json", quadedge::report::report_json(run));
  dataset_files::write_text(folder + "/member.json",
                            quadedge::report::member_json({name, run.input.path, "eth3d-slam", "key", 0, "", 1}));
  quadedge::report::AppendFile frames(folder + "/frames.csv");
  frames.append(quadedge::report::frames_row(0, {}).heading());
  quadedge::Trajectory estimate, truth;
  for (const auto& frame : run.frames) {
    frames.append(quadedge::report::frames_row(0, frame.result).line());
    estimate.push_back({frame.result.stamp_ns, *frame.result.world_from_left});
    truth.push_back({frame.result.stamp_ns, made_up_truth(frame.result.stamp_ns)});
  }
  quadedge::write_tum(folder + "/trajectory.txt", estimate);
  quadedge::write_tum(folder + "/groundtruth.txt", truth);
  std::filesystem::create_directories(folder + "/pictures");
}
