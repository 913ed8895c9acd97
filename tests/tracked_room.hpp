#pragma once
/// \file tracked_room.hpp  A small rendered room, its trajectory, and comparisons of poses and results.

#include "frontends.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"

namespace tracked_room {

using namespace quadedge;
using matching::RenderedScene;

/// Eight frames of the room, rendered once.
inline const RenderedScene& room() {
  static const RenderedScene scene("room", 240, 150, 8);
  return scene;
}

/// A device, built before the odometry on it and destroyed after it.
struct OwnDevice {
  Device own;
};

/// An odometry with a device of its own.
struct Tracker : OwnDevice, StereoOdometry {
  explicit Tracker(const StereoRig& rig = room().rig, const Config& config = room().config,
                   const std::string& device_name = all_devices().front())
      : OwnDevice{Device(device_name, kept_programs())}, StereoOdometry(rig, own, config) {}
};

inline std::vector<FrameResult> track(const RenderedScene& scene, const std::string& device_name,
                                      const Config& config) {
  Tracker odometry(scene.rig, config, device_name);
  std::vector<FrameResult> results;
  for (std::size_t i = 0; i < scene.left.size(); ++i) results.push_back(odometry.track(scene.frame(i)));
  return results;
}

inline double turn_between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd((a.inverse() * b).linear()).angle();
}

/// The room, whose right images lie lower than the calibration says.
inline RenderedScene room_with_rows_off_by(double pixels) {
  RenderedScene scene = room();
  scene.rig.right.cy -= pixels;
  return scene;
}

/// The first frame is the origin in both. Metres and degrees.
inline void check_pose(const std::optional<Eigen::Isometry3d>& world_from_left, const Eigen::Isometry3d& truth,
                       double metres, double degrees) {
  INFO("moved " << truth.translation().norm() << " m");
  REQUIRE(world_from_left);
  CHECK((world_from_left->translation() - truth.translation()).norm() < metres);
  CHECK(turn_between(*world_from_left, truth) < degrees * kDegree);
}

/// A view of a scene without noise.
inline Image render_view(const synthetic::Scene& scene, const PinholeCamera& camera,
                         const Eigen::Isometry3d& camera_from_scene) {
  const auto view = synthetic::render(scene, camera, camera_from_scene, 3, 0);
  return matching::image_of(camera.width, camera.height, [&](double x, double y) {
    return view.grey[static_cast<std::size_t>(y * camera.width + x)];
  });
}

/// The frame at another time, for sequences in another order.
inline StereoFrame at(std::int64_t stamp_ns, StereoFrame frame) {
  frame.stamp_ns = stamp_ns;
  return frame;
}

inline bool same_bytes(const std::optional<Eigen::Isometry3d>& a, const std::optional<Eigen::Isometry3d>& b) {
  return a.has_value() == b.has_value() && (!a || a->matrix() == b->matrix());
}

/// All but times.
inline bool same_bytes(const FrameResult& a, const FrameResult& b) {
  return a.status == b.status && same_bytes(a.world_from_left, b.world_from_left) &&
         same_bytes(a.predicted_world_from_left, b.predicted_world_from_left) &&
         same_bytes(a.current_from_reference, b.current_from_reference) && a.covariance == b.covariance &&
         a.relative_covariance == b.relative_covariance && a.reference_frame == b.reference_frame &&
         a.diagnostics.base_frame == b.diagnostics.base_frame && a.new_key_rig == b.new_key_rig &&
         a.diagnostics.overflow == b.diagnostics.overflow && a.message == b.message && a.segment == b.segment &&
         a.counts.quads == b.counts.quads && a.counts.inliers == b.counts.inliers;
}

}  // namespace tracked_room
