/// \file opencv_baseline_main.cpp  The OpenCV baseline as a program: tracks a sequence that `quadedge run` can
/// read, or a rendered scene, and writes trajectories for `quadedge evaluate trajectory`.
///
///   opencv_baseline PATH -o OUT         a recorded sequence
///   opencv_baseline cables -o OUT       a rendered scene: room, cables, facade, yard; ./cables is a folder

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "cli/frame_source.hpp"
#include "data/trajectory_rows.hpp"
#include "opencv_baseline.hpp"
#include "output/output_folder.hpp"
#include "output/result_rows.hpp"
#include "quadedge/error.hpp"

namespace {

using namespace quadedge;

cli::FrameSource open_source(const std::string& path, int frames, SyntheticOptions scene) {
  if (const auto& scenes = synthetic_scenes(); std::count(scenes.begin(), scenes.end(), path) > 0) {
    scene.scene = path;
    if (frames > 0) scene.frames = frames;
    return cli::FrameSource(scene);
  }
  DatasetOptions options;
  if (frames > 0) options.last_frame = frames;
  return cli::FrameSource(open_dataset(path, options));
}

/// trajectory.txt, trajectory_kitti.txt and groundtruth.txt as `quadedge run` writes them.
void run(cli::FrameSource source, const std::string& output, bool force) {
  const report::FolderLock lock = report::prepare_output_folder(output, force);
  report::AppendFile tum(output + "/trajectory.txt"), kitti(output + "/trajectory_kitti.txt");
  tum.append(data::tum_header());
  bench::OpencvBaseline baseline(source.rig());
  int frames = 0, tracked = 0;
  while (const auto frame = source.next()) {
    const auto result = baseline.track(frame->view());
    const StampedPose pose{frame->stamp_ns, result.world_from_left};
    if (result.tracked) tum.append(data::tum_row(pose));
    kitti.append(data::kitti_row(pose));
    ++frames;
    tracked += result.tracked ? 1 : 0;
  }
  const Trajectory& truth = source.dataset().truth;
  if (!truth.empty()) write_tum(output + "/groundtruth.txt", truth);
  std::printf("tracked %d of %d frames; results in %s\n", tracked, frames, output.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App program("Stereo visual odometry with OpenCV's SIFT and PnP, to compare with", "opencv_baseline");
  std::string path, output;
  SyntheticOptions scene;
  int frames = 0;
  bool force = false;
  program.add_option("PATH", path, "folder of a sequence, or a rendered scene: room, cables, facade")->required();
  program.add_option("-o,--output", output, "folder for the results")->required();
  program.add_option("--frames", frames, "only the first N frames; 0: all, of a rendered scene 60");
  program.add_option("--path", scene.path, "of a rendered scene: ellipse, handheld, drive, loop");
  program.add_flag("--force", force, "replace the results in OUT");
  CLI11_PARSE(program, argc, argv);
  try {
    if (frames < 0) throw UsageError("--frames " + std::to_string(frames) + ": expected 0 or more");
    run(open_source(path, frames, scene), output, force);
    return static_cast<int>(ExitCode::done);
  } catch (const Error& error) {
    std::fprintf(stderr, "opencv_baseline: %s\n", error.what());
    return static_cast<int>(error.exit_code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "opencv_baseline: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::internal);
  }
}
