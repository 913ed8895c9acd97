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

struct Row {
  int previous, current;
  float ncc;
  int rivals;
};

TemporalMatches matches_of(const std::vector<Row>& rows) {
  TemporalMatches matches;
  for (const Row& row : rows) {
    matches.previous.push_back(row.previous);
    matches.current.push_back(row.current);
    for (auto* values : {&matches.left_x, &matches.left_y, &matches.right_x, &matches.right_y}) values->push_back(0);
    matches.ncc.push_back(row.ncc);
    matches.rivals.push_back(row.rivals);
  }
  return matches;
}

}  // namespace

TEST_CASE("key rig: chains follow the stereo edge in the middle", "[odometry][key_rig]") {
  KeyRig rig;
  rig.start(7, Eigen::Isometry3d::Identity(), row_of_edges(5));
  CHECK(rig.frame() == 7);
  // Frame 1: edges 0, 1, 3, 4 go on; frame 2: those that reached 8 and 2 and 6 go on, 5 ends, and 9 -> 0 was never in a chain.
  rig.extend(matches_of({{0, 8, 0.95f, 0}, {1, 5, 0.9f, 1}, {3, 2, 0.85f, 2}, {4, 6, 0.8f, 0}}));
  rig.extend(matches_of({{2, 3, 0.9f, 0}, {6, 1, 0.9f, 3}, {8, 4, 0.97f, 1}, {9, 0, 0.99f, 0}}));
  const auto chained = rig.chained(row_of_edges(5, 2.0f));
  CHECK(chained.previous == std::vector<std::int32_t>{0, 3, 4});
  CHECK(chained.current == std::vector<std::int32_t>{4, 3, 1});
  CHECK(chained.ncc == std::vector<float>{0.95f, 0.85f, 0.8f});     // the weakest link
  CHECK(chained.rivals == std::vector<std::int32_t>{1, 2, 3});      // the most ambiguous one
  CHECK(chained.left_x == std::vector<float>{42, 32, 12});
  CHECK(chained.right_x == std::vector<float>{37, 27, 7});
  CHECK(rig.median_parallax(chained) == Approx(28));  // |42 - 0|, |32 - 30|, |12 - 40|
}

TEST_CASE("key rig: parallax is the median distance of both ends", "[odometry][key_rig]") {
  KeyRig rig;
  rig.start(0, Eigen::Isometry3d::Identity(), row_of_edges(3));
  rig.extend(matches_of({{0, 0, 1, 0}, {1, 1, 1, 0}, {2, 2, 1, 0}}));
  StereoEdges current = row_of_edges(3);
  current.left_x[0] += 3;
  current.left_y[0] += 4;   // 5 px
  current.left_x[1] += 1;   // 1 px
  current.left_y[2] -= 20;  // 20 px
  CHECK(rig.median_parallax(rig.chained(current)) == Approx(5));
  CHECK(rig.median_parallax({}) == 0);
}

TEST_CASE("key rig: starting anew forgets the old chains", "[odometry][key_rig]") {
  KeyRig rig;
  rig.start(0, Eigen::Isometry3d::Identity(), row_of_edges(3));
  rig.extend(matches_of({{0, 2, 1, 4}}));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(1, 2, 3);
  rig.start(4, pose, row_of_edges(2));
  CHECK(rig.frame() == 4);
  CHECK(rig.world_from_key().translation() == Eigen::Vector3d(1, 2, 3));
  CHECK(rig.edges().size() == 2);
  const auto chained = rig.chained(row_of_edges(2));
  CHECK(chained.previous == std::vector<std::int32_t>{0, 1});
  CHECK(chained.rivals == std::vector<std::int32_t>{0, 0});
}

TEST_CASE("key rig: each criterion alone wears it out", "[odometry][key_rig]") {
  OdometryConfig config;
  config.key_min_quads = 2;
  KeyRig rig;
  rig.start(0, Eigen::Isometry3d::Identity(), row_of_edges(20));
  std::vector<Row> rows;
  for (int i = 0; i < 10; ++i) rows.push_back({i, i, 1, 0});
  rig.extend(matches_of(rows));  // 10 chains at the first frame: at least 0.3 x 10 = 3 have to stay
  const auto fit = [] {
    KeyRigState state;
    state.chained_quads = 3;
    state.inlier_share = 0.4;
    state.median_parallax = 40;
    state.rotation = 0.1745;  // 9.998 degrees
    state.frames = 9;
    return state;
  };
  CHECK_FALSE(rig.is_worn(fit(), config));
  KeyRigState state = fit();
  state.chained_quads = 2;  // under the share
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
  // The share refers to the first frame, later losses do not lower the mark.
  rig.extend(matches_of({{0, 0, 1, 0}, {1, 1, 1, 0}}));
  state = fit();
  state.chained_quads = 2;
  CHECK(rig.is_worn(state, config));
}
