/// \file test_paper_pose.cpp  The paper's poses: two quads, RANSAC, and quads propagated to the key rig.
#include "generated_quads.hpp"
#include "motion/paper_consensus.hpp"
#include "motion/paper_search.hpp"
#include "motion/two_quads.hpp"

using namespace quadedge;

namespace {

PoseConfig paper_pose_config() {
  PoseConfig config;
  config.min_hypotheses = 1000;
  return config;
}

TemporalMatches linked_matches(const std::vector<std::pair<int, int>>& pairs) {
  TemporalMatches matches;
  for (const auto& [previous, current] : pairs) {
    matches.previous.push_back(previous);
    matches.current.push_back(current);
    for (auto column :
         {&TemporalMatches::left_x, &TemporalMatches::left_y, &TemporalMatches::right_x, &TemporalMatches::right_y,
          &TemporalMatches::left_direction, &TemporalMatches::right_direction, &TemporalMatches::ncc})
      (matches.*column).push_back(static_cast<float>(10 * previous + current));
    matches.competing_clusters.push_back(0);
  }
  return matches;
}

}  // namespace

TEST_CASE("paper pose: the motion of two quads turns the tangents of both as they turned", "[pose]") {
  const generated::Problem problem = generated::drive({});
  const auto g = generated::generate(problem, 4);
  int checked = 0;
  for (std::size_t b = 1; b < 60; ++b) {
    const auto motion = paper::motion_of_two_quads(g.quads, 0, b);
    if (!motion) continue;
    ++checked;
    CHECK(generated::rotation_error(*motion, problem.motion) < 1e-3);
    for (const std::size_t q : {std::size_t{0}, b}) {
      const pose::OrientedPoint before = g.quads.previous[q].oriented_point(),
                                after = g.quads.current[q].oriented_point();
      CHECK((motion->linear() * before.tangent - after.tangent).norm() < 2e-3);
    }
  }
  CHECK(checked > 10);
}

TEST_CASE("paper pose: the translation is that of the first point", "[pose]") {
  generated::Problem problem = generated::drive({0.2, 0.4, 0.01});
  const auto g = generated::generate(problem, 6);
  int checked = 0;
  for (std::size_t b = 1; b < 200; ++b) {
    const auto motion = paper::motion_of_two_quads(g.quads, 0, b);
    if (!motion) continue;
    const auto error = [&](std::size_t q) {
      return (*motion * g.quads.previous[q].oriented_point().point - g.quads.current[q].oriented_point().point).norm();
    };
    CHECK(std::min(error(0), error(b)) < 1e-9);  // the second where the roles are swapped
    checked += error(0) < 1e-9 && error(b) > 1e-6 ? 1 : 0;
  }
  CHECK(checked > 3);
}

TEST_CASE("paper pose: inliers are points within 1.5 px and tangents within 10 degrees, in the left image", "[pose]") {
  generated::Problem problem = generated::drive({});
  auto g = generated::generate(problem, 7);
  std::vector<std::uint8_t> inlier;
  const auto count = [&] { return paper::find_inliers(g.quads, problem.rig.left, problem.motion, 1.5, inlier); };
  REQUIRE(count() == problem.quads);
  g.quads.scoring.left_x[0] += 1.6F;
  g.quads.scoring.left_y[1] += 1.4F;
  g.quads.scoring.right_x[2] += 20;  // is not looked at
  const auto turned = [](const Eigen::Vector2f& edge, double angle) {
    return Eigen::Vector2f(Eigen::Rotation2Df(static_cast<float>(angle)) * edge);
  };
  g.quads.current[3].left_edge = turned(g.quads.current[3].left_edge, 11 * kDegree);
  g.quads.current[4].left_edge = turned(g.quads.current[4].left_edge, 9 * kDegree);
  g.quads.current[5].left_edge = turned(g.quads.current[5].left_edge, kPi);
  CHECK(count() == problem.quads - 2);
  CHECK((inlier[0] == 0 && inlier[3] == 0 && inlier[4] == 1 && inlier[5] == 1));
}

TEST_CASE("paper pose: the best of at least 1000 samples explains the quads among 50 % outliers", "[pose]") {
  generated::Problem problem = generated::drive({0.12, 0.2, 0.01});
  problem.outliers = 0.5;
  problem.quads = 800;
  const auto g = generated::generate(problem, 40);
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const paper::PaperConsensus found =
        paper::find_paper_consensus(g.quads, problem.rig.left, paper_pose_config(), seed);
    REQUIRE(found.current_from_previous);
    CHECK(found.hypotheses >= 1000);
    CHECK(found.hypotheses <= 5000);
    CHECK(found.inliers > 250);
    CHECK(generated::rotation_error(*found.current_from_previous, problem.motion) < 0.5 * kDegree);
    const paper::PaperConsensus again =
        paper::find_paper_consensus(g.quads, problem.rig.left, paper_pose_config(), seed);
    CHECK(again.current_from_previous->matrix() == found.current_from_previous->matrix());
    CHECK(again.inlier == found.inlier);
  }
  CHECK_FALSE(paper::find_paper_consensus({}, problem.rig.left, paper_pose_config(), 1).current_from_previous);
  generated::Problem few = generated::drive({});
  few.quads = 2;  // the pool of 70 % has one quad: the authors' program would draw for ever
  CHECK(paper::find_paper_consensus(generated::generate(few, 1).quads, few.rig.left, paper_pose_config(), 1).draws ==
        0);
}

TEST_CASE("paper pose: quads are handed on from edge to edge, and pairs reached twice count once", "[pose]") {
  // Key edge 0 ends at edges 5 and 6 of the earlier frame, key edge 2 at edge 6, key edge 3 at edge 9.
  const TemporalMatches from_key = linked_matches({{0, 5}, {0, 6}, {2, 6}, {3, 9}});
  const TemporalMatches onwards = linked_matches({{5, 1}, {6, 1}, {6, 2}, {8, 4}});
  const TemporalMatches found = odometry::propagate(from_key, onwards);
  CHECK(found.previous == std::vector<std::int32_t>{0, 0, 2, 2});
  CHECK(found.current == std::vector<std::int32_t>{1, 2, 1, 2});
  CHECK(found.left_x == std::vector<float>{51, 62, 61, 62});
  CHECK(found.competing_clusters == std::vector<std::int32_t>{1, 1, 1, 1});
  CHECK(odometry::propagate({}, onwards).size() == 0);
}
