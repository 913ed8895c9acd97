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
  // KITTI, EuRoC or ETH3D: the layout is recognised by its files. Nothing is decoded yet.
  const quadedge::Dataset data = quadedge::open_dataset(arguments[1]);

  // All defaults, but for the one thing that belongs to the recording: how far away from one another the two images of
  // a point can be.
  quadedge::Config config;
  config.stereo.max_disparity = data.max_disparity;

  // The first GPU, else the first CPU. The odometry builds its kernels here, once.
  quadedge::Device device("auto");
  quadedge::StereoOdometry odometry(data.rig, device, config);

  // Decodes the next images on another thread while this one tracks.
  quadedge::FramePrefetcher frames(data);
  quadedge::Trajectory trajectory;
  while (const auto frame = frames.next()) {
    const quadedge::FrameResult result = odometry.track(frame->view());
    std::printf("frame %d: %s, %d quads, %.0f ms %s\n", frame->number, to_string(result.status), result.counts.quads,
                result.latency_ms, result.message.c_str());
    // A lost frame has a predicted pose; the trajectory holds measured ones alone.
    if (is_tracked(result.status)) trajectory.push_back({frame->stamp_ns, result.world_from_left});
  }
  quadedge::write_tum(arguments[2], trajectory);
  return 0;
} catch (const quadedge::Error& error) {  // bad data or no device: one sentence that names file, found and expected
  std::fprintf(stderr, "error: %s\n", error.what());
  return static_cast<int>(error.exit_code());
}
