/// \file 01_track_recording.cpp  Tracks a recorded sequence and writes its trajectory.
///   01_track_recording kitti/sequences/06 trajectory.txt

#include <cstdio>
#include <quadedge/dataset.hpp>
#include <quadedge/error.hpp>
#include <quadedge/odometry.hpp>
#include <quadedge/trajectory.hpp>

int main(int count, char** arguments) try {
  if (count != 3) {
    std::fprintf(stderr, "usage: %s SEQUENCE TRAJECTORY\n", arguments[0]);
    return 2;
  }
  // The layout (KITTI, EuRoC, ETH3D ...) is recognised. Images are not decoded yet.
  const quadedge::Dataset data = quadedge::open_dataset(arguments[1]);

  // The first GPU, otherwise the first CPU, with the default configuration and the disparity range of such recordings.
  // The constructor builds the kernels.
  quadedge::StereoOdometry odometry(data.rig);

  // Decodes the next images in another thread during tracking.
  quadedge::FramePrefetcher frames(data);
  quadedge::Trajectory trajectory;
  while (const auto frame = frames.next()) {
    const quadedge::FrameResult result = odometry.track(frame->view());
    std::printf("frame %d: %s, %d quads, %.0f ms %s\n", frame->number, to_string(result.status), result.counts.quads,
                result.timing.latency_ms, result.message.c_str());
    // A lost frame has no pose; predicted_world_from_left repeats the last motion.
    if (result.world_from_left) trajectory.push_back({frame->stamp_ns, *result.world_from_left});
    for (const auto& warning : result.warnings) std::fprintf(stderr, "warning: %s\n", warning.text.c_str());
  }
  quadedge::write_tum(arguments[2], trajectory);
  return 0;
} catch (const quadedge::Error&
             error) {  // bad data or no device; the message names the file, what was found and what was expected
  std::fprintf(stderr, "error: %s\n", error.what());
  return static_cast<int>(error.exit_code());
}
