/// \file 03_own_images.cpp  A robot's program: a calibration file, images in memory, a thread for the camera and one
/// that tracks, lost frames. A rendered room replaces the camera.
///   03_own_images CALIBRATION      of images of 320 x 200 px

#include <cmath>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <quadedge/calibration.hpp>
#include <quadedge/error.hpp>
#include <quadedge/odometry.hpp>
#include <quadedge/synthetic.hpp>
#include <thread>
#include <utility>

namespace {

/// What a driver delivers: 8-bit grey pixels, row by row.
struct Pair {
  std::int64_t stamp_ns = 0;
  quadedge::Image left, right;
};

/// Holds the newest pair. A robot drops a pair that is still here when the next one comes; this program lets the camera
/// wait, so that every run prints the same.
class Mailbox {
 public:
  void put(Pair pair) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !pair_ || closed_; });  // for a robot: without this line
    pair_ = std::move(pair);
    changed_.notify_all();
  }
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }
  std::optional<Pair> take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return pair_ || closed_; });
    changed_.notify_all();
    return std::exchange(pair_, std::nullopt);
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Pair> pair_;
  bool closed_ = false;
};

/// The camera's thread.
void deliver(const quadedge::SyntheticSequence& camera, Mailbox& mailbox) {
  for (int i = 0; i < camera.frames(); ++i) {
    Pair pair{camera.stamp_ns(i), camera.render(i, quadedge::Side::left).image,
              camera.render(i, quadedge::Side::right).image};
    if (i == 3) pair.left.pixels.assign(pair.left.pixels.size(), 0);  // a hand before the lens
    mailbox.put(std::move(pair));
  }
  mailbox.close();
}

/// A non-owning view: pointer, width, height, bytes per row. It must stay valid until track() returns.
quadedge::ImageView view(const quadedge::Image& image) {
  return {image.pixels.data(), image.width, image.height, image.width};
}

/// Ends the camera's thread, also when tracking throws.
struct Driver {
  ~Driver() {
    mailbox.close();
    thread.join();
  }
  Mailbox& mailbox;
  std::thread thread;
};

void report(const quadedge::FrameResult& result) {
  for (const auto& warning : result.warnings) std::fprintf(stderr, "warning: %s\n", warning.text.c_str());
  if (!result.world_from_left) {  // no pose: use other sensors. Tracking goes on by itself with the next frame
    std::printf("%s: %s\n", to_string(result.status), result.message.c_str());
    return;
  }
  // Position [m] in the frame of the first left camera: x right, y down, z forward. Covariance in ROS's order.
  const Eigen::Vector3d position = result.world_from_left->translation();
  const double deviation = std::sqrt(result.covariance->topLeftCorner<3, 3>().trace());  // m
  std::printf("%s at %.4f %.4f %.4f m, +- %.5f m, segment %d%s\n", to_string(result.status), position.x(), position.y(),
              position.z(), deviation, result.segment, result.ambiguous_motion ? ", may follow a moving object" : "");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) throw quadedge::UsageError("expected a calibration file: 03_own_images CALIBRATION");
  // Kalibr, OpenCV, ROS and others; for two files: "left.yaml,right.yaml". The rig undistorts the images itself.
  const quadedge::StereoRig rig = quadedge::make_rig(quadedge::read_calibration(argv[1]));

  quadedge::SyntheticOptions options;
  options.frames = 6;
  options.width = 320, options.height = 200;
  options.focal = 541.764 * 320 / 942;  // px
  const quadedge::SyntheticSequence camera(options);

  quadedge::StereoOdometry odometry(rig);  // first GPU, else first CPU; kernels are built here
  Mailbox mailbox;
  const Driver driver{mailbox, std::thread(deliver, std::cref(camera), std::ref(mailbox))};
  bool is_tracked = false;
  while (const auto pair = mailbox.take()) {
    const quadedge::FrameResult result = odometry.track({pair->stamp_ns, view(pair->left), view(pair->right)});
    report(result);
    is_tracked = result.world_from_left.has_value();
  }
  return is_tracked ? 0 : 1;
} catch (const quadedge::Error& error) {  // a wrong file, option or image, or no device; never a lost frame
  std::fprintf(stderr, "error: %s\n", error.what());
  return static_cast<int>(error.exit_code());
}
