#pragma once
/// \file key_rig.hpp  The key stereo rig against which frames are located, and the criteria for replacing it (paper
/// section 6, doc/method.md section 7).

#include <Eigen/Geometry>
#include <vector>

#include "frontend/rig.hpp"
#include "pose/uncertain_pose.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// Quality of the current frame's location relative to the key rig.
struct KeyRigFitness {
  int quads = 0;  ///< with the key rig
  double inlier_ratio = 1;
  double median_parallax = 0;  ///< [px], left image
  double rotation = 0;         ///< [rad], from the key rig to the current one
  int frames = 0;              ///< since the key rig
};

/// Median displacement of the quads in the left image [px]; 0 without quads.
/// \param distances a buffer that is kept between calls
double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances);

/// Whether the pose of a key rig was measured or predicted.
enum class PoseOrigin { found, predicted };

/// A rig with a known world pose, and its initial number of quads.
class KeyRig {
 public:
  /// No key rig.
  KeyRig() = default;
  KeyRig(frontend::RigHandle rig, pose::UncertainPose pose, PoseOrigin origin = PoseOrigin::found)
      : rig_(std::move(rig)), pose_(std::move(pose)), origin_(origin) {}

  const frontend::RigHandle& rig() const { return rig_; }
  /// Frame number of the rig; -1 if there is none.
  int frame() const { return rig_ ? rig_->frame : -1; }
  const Eigen::Isometry3d& world_from_left() const { return pose_.fixed_from_camera; }
  /// World pose with covariance.
  const pose::UncertainPose& pose() const { return pose_; }

  /// Whether the current frame should become the key rig, see doc/method.md section 7. The first frame sets the
  /// reference for the number of quads. A rig whose pose was predicted serves for one frame only.
  bool needs_replacement(const KeyRigFitness& fitness, const OdometryConfig& config);

 private:
  frontend::RigHandle rig_;
  pose::UncertainPose pose_;  ///< in the world
  PoseOrigin origin_ = PoseOrigin::found;
  int first_quads_ = -1;  ///< of the first frame located against it
};

}  // namespace quadedge::odometry
