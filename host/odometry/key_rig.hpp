#pragma once
/// \file key_rig.hpp  The key stereo rig and the quads chained to it through the frames between (paper section 6, SPEC section 7).

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// What is known of the current frame when the key rig's fitness is judged.
struct KeyRigState {
  int chained_quads = 0;
  double inlier_share = 1;
  double median_parallax = 0;  ///< px, left image, chained quads
  double rotation = 0;         ///< rad, from the key rig to the current one
  int frames = 0;              ///< since the key rig
};

/// Remembers the stereo edges of one rig and, per edge, the stereo edge of the latest frame that it was followed to.
class KeyRig {
 public:
  /// Starts anew at a frame: every stereo edge is its own chain.
  void start(int frame, const Eigen::Isometry3d& world_from_key, const StereoEdges& edges);

  /// Extends every chain by the quads of one more frame; chains without a quad end.
  void extend(const TemporalMatches& matches);

  /// The living chains as quads between the key rig and `current`, whose stereo edges the last matches led to.
  TemporalMatches chained(const StereoEdges& current) const;

  /// Median distance in the left image between both ends of the chains [px].
  double median_parallax(const TemporalMatches& chained) const;

  /// Whether the current frame should become the key rig, SPEC section 7.
  bool is_worn(const KeyRigState& state, const OdometryConfig& config) const;

  int frame() const { return frame_; }
  const StereoEdges& edges() const { return edges_; }
  const Eigen::Isometry3d& world_from_key() const { return world_from_key_; }

 private:
  int frame_ = -1;
  Eigen::Isometry3d world_from_key_ = Eigen::Isometry3d::Identity();
  StereoEdges edges_;
  /// One living chain.
  struct Chain {
    std::int32_t key;     ///< stereo edge of the key rig
    std::int32_t latest;  ///< stereo edge of the latest frame
    float ncc;            ///< smallest along the chain
    std::int32_t rivals;  ///< most along the chain
  };
  std::vector<Chain> chains_;
  int first_count_ = 0;  ///< chains after the first extension
  bool extended_ = false;
};

}  // namespace quadedge::odometry
