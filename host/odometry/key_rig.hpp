#pragma once
/// \file key_rig.hpp  The key stereo rig that frames are located against, and when it needs replacement (paper section
/// 6, doc/method.md section 7).

#include <Eigen/Geometry>
#include <vector>

#include "frontend/rig.hpp"
#include "pose/pose_covariance.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// How well the current frame was located against the key rig.
struct KeyRigFitness {
  int quads = 0;  ///< with the key rig
  double inlier_ratio = 1;
  double median_parallax = 0;  ///< px, left image
  double rotation = 0;         ///< rad, from the key rig to the current one
  int frames = 0;              ///< since the key rig
};

/// Median distance in the left image between both ends of the quads [px]; 0 without quads.
/// \param distances a buffer that is kept between calls
double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances);

/// Whether a key rig's pose was found or only predicted.
enum class PoseOrigin { found, predicted };

/// A rig whose pose in the world is known, and how well it began as the key rig.
class KeyRig {
 public:
  /// There is none yet.
  KeyRig() = default;
  KeyRig(frontend::RigHandle rig, pose::UncertainPose pose, PoseOrigin origin = PoseOrigin::found)
      : rig_(std::move(rig)), pose_(std::move(pose)), origin_(origin) {}

  const frontend::RigHandle& rig() const { return rig_; }
  /// Number of its frame; -1 while there is none.
  int frame() const { return rig_ ? rig_->frame : -1; }
  const Eigen::Isometry3d& world_from_left() const { return pose_.fixed_from_camera; }
  /// The same with its covariance.
  const pose::UncertainPose& pose() const { return pose_; }

  /// Whether the current frame should become the key rig, doc/method.md section 7. The first frame judged sets the mark
  /// for the quads' number. A pose that was only predicted serves for one frame.
  bool needs_replacement(const KeyRigFitness& fitness, const OdometryConfig& config);

 private:
  frontend::RigHandle rig_;
  pose::UncertainPose pose_;  ///< in the world
  PoseOrigin origin_ = PoseOrigin::found;
  int first_quads_ = -1;  ///< of the first frame judged
};

}  // namespace quadedge::odometry
