#include "edges/prediction.hpp"
#include "generated_quads.hpp"

using namespace quadedge;
using Eigen::Vector3d;

namespace {

StereoEdges edges_of(const StereoRig& rig, const std::vector<pose::OrientedPoint>& points) {
  StereoEdges edges;
  for (const auto& point : points) generated::append(edges, generated::observe(rig, point));
  return edges;
}

}  // namespace

TEST_CASE("prediction: edges are predicted together as one by one, in every direction") {
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Random random(6);
    StereoEdges edges;
    for (int i = 0; i < 3001; ++i)
      generated::append(edges, generated::observe(rig, generated::random_point(rig, 1, 20, random)));
    pose::MeasuredEdges measured;
    pose::measure_edges(rig, edges, 0.07, measured);
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = Eigen::AngleAxisd(0.3, Vector3d(0.2, 0.1, 1).normalized()).toRotationMatrix();
    motion.translation() = Vector3d(0.1, -0.2, -1.5);
    TemporalSearch search;
    frontend::predict_positions(rig, edges, measured, motion, 3, 2, search);
    CHECK(search.radius == 3.0f);
    CHECK(search.step == 2);
    int seen = 0, octants[8] = {};
    for (std::size_t i = 0; i < measured.size(); i += 2) {
      const auto edge = measured[i] ? std::optional(measured[i]->oriented_point()) : std::nullopt;
      const auto left = edge ? pose::project(rig.left, motion, *edge) : std::nullopt,
                 right = edge ? pose::project(rig.right, rig.right_from_left * motion, *edge) : std::nullopt;
      REQUIRE(std::isnan(search.left.x[i]) == !left);
      REQUIRE(std::isnan(search.right.x[i]) == !right);
      if (!left || !right) continue;
      ++seen;
      const double direction = std::atan2(left->direction.y(), left->direction.x());
      ++octants[std::min(7, static_cast<int>((direction + kPi) / (0.25 * kPi)))];
      for (const auto& [found, expected] : {std::pair(&search.left, &*left), std::pair(&search.right, &*right)}) {
        CHECK(static_cast<double>(found->x[i]) == Approx(expected->pixel.x()).epsilon(1e-6));
        CHECK(static_cast<double>(found->y[i]) == Approx(expected->pixel.y()).epsilon(1e-6));
        const double turn = std::atan2(expected->direction.y(), expected->direction.x());
        CHECK(std::abs(std::remainder(static_cast<double>(found->direction[i]) - turn, 2 * kPi)) < 3e-7);
      }
    }
    CHECK(seen > 500);
    for (const int count : octants) CHECK(count > 20);
  }
}

TEST_CASE("prediction: without a motion everything is predicted at its previous position") {
  const auto rig = generated::car_rig();
  const auto edges =
      edges_of(rig, {{Vector3d(0, 0, 5), Vector3d::UnitY()}, {Vector3d(1, 0, 9), Vector3d(0.5, 1, 0).normalized()}});
  pose::MeasuredEdges measured;
  pose::measure_edges(rig, edges, 0.07, measured);
  TemporalSearch search;
  frontend::predict_positions(rig, edges, measured, std::nullopt, 30, 8, search);
  CHECK(search.left.x == edges.left_x);
  CHECK(search.left.direction == edges.left_direction);
  CHECK(search.right.y == edges.right_y);
  CHECK(search.step == 8);
}

TEST_CASE("prediction: edges in view are counted, and shifts are averaged where both positions are valid") {
  const float nowhere = std::numeric_limits<float>::quiet_NaN();
  const EdgePositions a{{0, 10, nowhere, 99, 50}, {0, 10, 5, 49, 20}, {}},
      b{{3, 10, 4, nowhere, 50}, {4, 11, 5, 49, 20}, {}};
  CHECK(frontend::count_in_view({80, 80, 50, 25, 100, 50}, a) == 4);
  CHECK(frontend::count_in_view({80, 80, 50, 25, 60, 50}, a) == 3);
  CHECK(frontend::mean_distance(a, b, 1) == Approx((5 + 1 + 0) / 3.0));
  CHECK(frontend::mean_distance({}, {}, 1) == 0);
}
