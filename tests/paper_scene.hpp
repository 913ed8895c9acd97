#pragma once
/// \file paper_scene.hpp  A rectified rig in front of a plane, for calculation by hand: a left point (x, y) is at
/// (x - 10, y) in the right view.

#include <cmath>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace paper_scene {

constexpr float kSteep = 1.5F;  // rad, nearly vertical

inline quadedge::StereoRig small_rig() {
  quadedge::StereoRig rig;
  rig.left = rig.right = {100, 100, 49.5, 29.5, 100, 60};
  rig.right_from_left.translation().x() = -0.1;
  return rig;
}

inline void add_edge(quadedge::EdgeSet& edges, float x, float y, float direction = kSteep) {
  edges.x.push_back(x);
  edges.y.push_back(y);
  edges.direction.push_back(direction);
  edges.strength.push_back(10);
  edges.scale_shift.push_back(0);
}

/// Every pixel of the left view has disparity 10, except from column 80 on, where it is unknown.
inline quadedge::evaluation::FrameTruth plane_truth() {
  quadedge::evaluation::FrameTruth truth;
  truth.left = {100, 60, std::vector<float>(6000, 10.0F)};
  for (std::size_t i = 0; i < 6000; ++i) {
    if (i % 100 >= 80) truth.left.nearness[i] = std::nanf("");
  }
  truth.right = right_from_left(truth.left, 100);
  return truth;
}

}  // namespace paper_scene
