#pragma once
/// \file path.hpp  How the camera of the synthetic sequences moves.

#include <Eigen/Geometry>

namespace quadedge::synthetic {

/// Pose of the left camera after `phase` frames (any real number), in the frame of the camera at phase 0, where it is
/// the identity. Smooth, in all six degrees of freedom, and it stays within 0.7 m of the start for ever: steps of 1 to
/// 4 cm and less than 1 degree per frame.
Eigen::Isometry3d world_from_left(double phase);

}  // namespace quadedge::synthetic
