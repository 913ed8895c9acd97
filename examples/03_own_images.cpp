/// \file 03_own_images.cpp  Tracks images in memory, as a camera driver delivers them. A rendered room replaces the
/// camera.

#include <cmath>
#include <cstdio>
#include <quadedge/error.hpp>
#include <quadedge/odometry.hpp>
#include <quadedge/synthetic.hpp>

int main() try {
  quadedge::SyntheticOptions options;
  options.frames = 3;
  options.width = 320, options.height = 200;
  options.focal = 184.0;  // px
  const quadedge::SyntheticSequence camera(options);

  // The calibration of a rectified stereo camera: two equal pinhole cameras, the right one 6 cm to the right. An
  // unrectified rig also has a rotation in right_from_left, and an undistortion table per camera.
  const double baseline = camera.rig().baseline();  // m
  quadedge::StereoRig rig;
  rig.left.fx = rig.left.fy = 184.0;
  rig.left.cx = camera.rig().left.cx;
  rig.left.cy = camera.rig().left.cy;
  rig.left.width = 320;
  rig.left.height = 200;
  rig.right = rig.left;
  rig.right_from_left.translation() = Eigen::Vector3d(-baseline, 0, 0);

  // If nothing is known, objects are expected at least 0.5 m away. This scene begins at 1 m.
  quadedge::Config config;
  config.stereo.min_depth = 1;

  quadedge::StereoOdometry odometry(rig, config);
  for (int i = 0; i < camera.frames(); ++i) {
    const quadedge::Image left = camera.render(i, quadedge::Side::left).image,
                          right = camera.render(i, quadedge::Side::right).image;
    // A non-owning view of 8-bit grey pixels: pointer, width, height, bytes per row. It must stay valid until track()
    // returns.
    const quadedge::ImageView left_view{left.pixels.data(), left.width, left.height, left.width};
    const quadedge::ImageView right_view{right.pixels.data(), right.width, right.height, right.width};
    const quadedge::FrameResult result = odometry.track({camera.stamp_ns(i), left_view, right_view});

    if (!result.world_from_left) {
      std::fprintf(stderr, "%s: %s\n", to_string(result.status), result.message.c_str());
      return 1;
    }
    // Position [m] in the frame of the first left camera: x right, y down, z forward. The covariance is in the order of
    // ROS: translation first, then rotation.
    const Eigen::Vector3d position = result.world_from_left->translation();
    const double deviation = std::sqrt(result.covariance->topLeftCorner<3, 3>().trace());  // m
    std::printf("%s at %.4f %.4f %.4f m, +- %.5f m\n", to_string(result.status), position.x(), position.y(),
                position.z(), deviation);
  }
  return 0;
} catch (const quadedge::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return static_cast<int>(error.exit_code());
}
