#include <catch2/catch.hpp>

#include "odometry/key_rig.hpp"

using namespace quadedge;
using odometry::KeyRig;
using odometry::KeyRigState;

namespace {

/// `count` stereo edges at left (10 i, 0), right (10 i - 5, 0), all moved by `shift` px.
StereoEdges row_of_edges(int count, float shift = 0) {
  StereoEdges edges;
  for (int i = 0; i < count; ++i) {
    const auto x = 10.0f * static_cast<float>(i) + shift;
    edges.left_index.push_back(i);
    edges.right_index.push_back(i);
    edges.left_x.push_back(x);
    edges.left_y.push_back(0);
    edges.left_direction.push_back(1.5f);
    edges.right_x.push_back(x - 5);
    edges.right_y.push_back(0);
    edges.right_direction.push_back(1.5f);
    edges.ncc.push_back(0.9f);
  }
  return edges;
}

}  // namespace

TEST_CASE("key rig: parallax is the median distance of both ends", "[odometry][key_rig]") {
  StereoEdges current = row_of_edges(3);
  current.left_x[0] += 3;
  current.left_y[0] += 4;   // 5 px
  current.left_x[1] += 1;   // 1 px
  current.left_y[2] -= 20;  // 20 px
  TemporalMatches quads;
  for (int i = 0; i < 3; ++i) quads.append(i, i, current, 0.9f, 0);
  std::vector<double> distances;
  CHECK(odometry::median_parallax(row_of_edges(3), quads, distances) == Approx(5));
  CHECK(odometry::median_parallax(row_of_edges(3), {}, distances) == 0);
}

TEST_CASE("key rig: remembers its frame and place", "[odometry][key_rig]") {
  KeyRig rig;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1, 2, 3);
  rig.start(4, pose);
  CHECK(rig.frame() == 4);
  CHECK(rig.world_from_key().translation() == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("key rig: each criterion alone wears it out", "[odometry][key_rig]") {
  OdometryConfig config;
  config.key_min_quads = 2;
  config.key_max_parallax = 40;
  const auto fit = [] {
    KeyRigState state;
    state.quads = 3;
    state.inlier_share = 0.4;
    state.median_parallax = 40;
    state.rotation = 0.1745;  // 9.998 degrees
    state.frames = 9;
    return state;
  };
  KeyRig rig;
  KeyRigState first = fit();
  first.quads = 10;  // the mark: at least 0.3 x 10 = 3 have to stay
  CHECK_FALSE(rig.is_worn(first, config));
  CHECK_FALSE(rig.is_worn(fit(), config));
  KeyRigState state = fit();
  state.quads = 2;  // under the share
  CHECK(rig.is_worn(state, config));
  config.key_min_quads = 4;  // under the number
  CHECK(rig.is_worn(fit(), config));
  config.key_min_quads = 2;
  state = fit();
  state.inlier_share = 0.39;
  CHECK(rig.is_worn(state, config));
  state = fit();
  state.median_parallax = 40.01;
  CHECK(rig.is_worn(state, config));
  state = fit();
  state.rotation = 0.1746;  // 10.004 degrees
  CHECK(rig.is_worn(state, config));
  state = fit();
  state.frames = 10;
  CHECK(rig.is_worn(state, config));
  // A new key rig sets a new mark.
  rig.start(9, Eigen::Isometry3d::Identity());
  state = fit();
  state.quads = 2;
  CHECK_FALSE(rig.is_worn(state, config));
}
