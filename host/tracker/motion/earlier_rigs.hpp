#pragma once
/// \file earlier_rigs.hpp  Keyframes that are kept for a loss. doc/method.md section 7.

#include <Eigen/Geometry>
#include <vector>

#include "motion/tracking_state.hpp"

namespace quadedge::odometry {

/// Keyframes of the segment with different views, against which a lost frame may be located. Their number is limited.
class EarlierRigs {
 public:
  /// Keeps a keyframe that is replaced, if its view differs from that of the last one kept. Beyond kEarlierRigs the one
  /// that is most similar to its successor leaves. \param inverse_depth mean of what is seen from nearly there [1/m]
  void remember(const KeyRig& rig, double inverse_depth);
  void clear() { kept_.clear(); }

  /// Up to kEarlierTrials of them, in the order of how likely their views are similar to that of a frame at this pose.
  std::vector<const KeyRig*> nearest(const Eigen::Isometry3d& world_from_left) const;
  /// The keyframe with these edges; null if it is not among them.
  const KeyRig* find(const frontend::FrameEdgesHandle& frame_edges) const;
  bool holds(int frame) const;

 private:
  struct Kept {
    KeyRig rig;
    double inverse_depth;
  };
  static double difference(const Kept& one, const Eigen::Isometry3d& world_from_other);

  std::vector<Kept> kept_;  ///< oldest first
};

}  // namespace quadedge::odometry
