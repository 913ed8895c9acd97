#pragma once
/// \file key_rig.hpp  The key stereo rig that frames are located against, and when it is worn (paper section 6,
/// doc/method.md section 7).

#include <Eigen/Geometry>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// What is known of the current frame when the key rig's fitness is judged.
struct KeyRigState {
  int quads = 0;  ///< with the key rig
  double inlier_share = 1;
  double median_parallax = 0;  ///< px, left image
  double rotation = 0;         ///< rad, from the key rig to the current one
  int frames = 0;              ///< since the key rig
};

/// Median distance in the left image between both ends of the quads [px]; 0 without quads.
/// \param distances a buffer that is kept between calls
double median_parallax(const StereoEdges& key, const TemporalMatches& quads, std::vector<double>& distances);

/// Remembers which frame is the key rig and how well it began.
class KeyRig {
 public:
  void start(int frame, const Eigen::Isometry3d& world_from_key);

  /// Whether the current frame should become the key rig, doc/method.md section 7. The first frame judged sets the mark
  /// for the quads' number.
  bool is_worn(const KeyRigState& state, const OdometryConfig& config);

  int frame() const { return frame_; }
  const Eigen::Isometry3d& world_from_key() const { return world_from_key_; }

 private:
  int frame_ = -1;
  Eigen::Isometry3d world_from_key_ = Eigen::Isometry3d::Identity();
  int first_count_ = -1;  ///< quads of the first frame judged
};

}  // namespace quadedge::odometry
