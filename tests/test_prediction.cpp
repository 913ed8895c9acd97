#include <catch2/catch.hpp>
#include <limits>

#include "edges/prediction.hpp"
#include "generated_quads.hpp"
#include "quadedge/camera.hpp"

using namespace quadedge;
using Eigen::Vector3d;

namespace {

StereoEdges edges_of(const StereoRig& rig, const std::vector<pose::OrientedPoint>& points) {
  StereoEdges edges;
  for (const auto& point : points) generated::append(edges, generated::observe(rig, point));
  return edges;
}

TemporalSearch predict(const StereoRig& rig, const StereoEdges& edges, const std::optional<Eigen::Isometry3d>& motion,
                       double radius, int step) {
  pose::MeasuredEdges measured;
  pose::measure_edges(rig, edges, 0.07, measured);
  TemporalSearch search;
  frontend::predict_positions(rig, edges, measured, motion, radius, step, search);
  return search;
}

}  // namespace

TEST_CASE("prediction: points moved by a known motion are predicted at their projections", "[odometry][prediction]") {
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Random random(5);
    std::vector<pose::OrientedPoint> points;
    for (int k = 0; k < 60; ++k) {
      // Upright and oblique tangents, so that neither rig's epipolar lines run along them.
      points.push_back(
          {Vector3d(random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4), random.uniform(1.5, 4)), random.unit()});
    }
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() = Eigen::AngleAxisd(0.05, Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
    motion.translation() = Vector3d(0.05, -0.02, -0.2);
    const auto search = predict(rig, edges_of(rig, points), motion, 12, 1);
    CHECK(search.radius == 12.0f);
    CHECK(search.step == 1);
    REQUIRE(search.left.x.size() == points.size());
    int predicted = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::isnan(search.left.x[i])) continue;
      ++predicted;
      const Vector3d after = motion * points[i].point;
      const auto left = rig.left.project(after), right = rig.right.project(rig.right_from_left * after);
      CHECK(search.left.x[i] ==
            Approx(left.x()).margin(0.01));  // single precision positions: about 1e-4 px of disparity
      CHECK(search.left.y[i] == Approx(left.y()).margin(0.01));
      CHECK(search.right.x[i] == Approx(right.x()).margin(0.01));
      CHECK(search.right.y[i] == Approx(right.y()).margin(0.01));
      // The tangent: a second point slightly farther along it.
      const auto ahead = rig.left.project(motion * (points[i].point + 1e-6 * points[i].tangent));
      const double direction = std::atan2(ahead.y() - left.y(), ahead.x() - left.x());
      CHECK(std::abs(std::remainder(static_cast<double>(search.left.direction[i]) - direction, 2 * kPi)) < 0.02);
    }
    CHECK(predicted > 45);
  }
}

TEST_CASE("prediction: edges are predicted together as one by one, in every direction", "[odometry][prediction]") {
  const auto rig = generated::crooked_rig();
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
  int seen = 0, octants[8] = {};
  for (std::size_t i = 0; i < measured.size(); i += 2) {
    const auto expected = measured[i] ? pose::project(rig.left, motion, measured[i]->oriented_point()) : std::nullopt;
    REQUIRE(std::isnan(search.left.x[i]) == !expected.has_value());
    if (!expected) continue;
    ++seen;
    const double direction = std::atan2(expected->direction.y(), expected->direction.x());
    ++octants[std::min(7, static_cast<int>((direction + kPi) / (0.25 * kPi)))];
    CHECK(static_cast<double>(search.left.x[i]) == Approx(expected->pixel.x()).epsilon(1e-6));
    CHECK(static_cast<double>(search.left.y[i]) == Approx(expected->pixel.y()).epsilon(1e-6));
    CHECK(std::abs(static_cast<double>(search.left.direction[i]) - direction) < 3e-7);
  }
  CHECK(seen > 500);
  for (const int count : octants) CHECK(count > 20);
}

TEST_CASE("prediction: without a motion everything is predicted at its previous position", "[odometry][prediction]") {
  const auto rig = generated::car_rig();
  const auto edges =
      edges_of(rig, {{Vector3d(0, 0, 5), Vector3d::UnitY()}, {Vector3d(1, 0, 9), Vector3d(0.5, 1, 0).normalized()}});
  const auto search = predict(rig, edges, std::nullopt, 30, 8);
  CHECK(search.left.x == edges.left_x);
  CHECK(search.left.direction == edges.left_direction);
  CHECK(search.right.y == edges.right_y);
  CHECK(search.step == 8);
}

TEST_CASE("prediction: edges without depth or behind the camera have no position", "[odometry][prediction]") {
  const auto rig = generated::car_rig();
  auto edges = edges_of(rig, {{Vector3d(0, 0.2, 5), Vector3d::UnitY()},
                              {Vector3d(0.5, 0.2, 3), Vector3d::UnitY()},
                              {Vector3d(0, 0.2, 5), Vector3d::UnitX()}});
  edges.right_x[0] = edges.left_x[0] + 2;  // negative disparity
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() = Vector3d(0, 0, -4);  // the camera passes the second point
  const auto search = predict(rig, edges, motion, 10, 1);
  for (std::size_t i = 0; i < 3; ++i) {  // the third one lies along its epipolar line
    CHECK(std::isnan(search.left.x[i]));
    CHECK(std::isnan(search.right.x[i]));
  }
}

TEST_CASE("prediction: edges in view are counted, and shifts are averaged where both positions are valid",
          "[odometry][prediction]") {
  const float nowhere = std::numeric_limits<float>::quiet_NaN();
  const EdgePositions a{{0, 10, nowhere, 99, 50}, {0, 10, 5, 49, 20}, {}},
      b{{3, 10, 4, nowhere, 50}, {4, 11, 5, 49, 20}, {}};
  CHECK(frontend::count_in_view({80, 80, 50, 25, 100, 50}, a) == 4);
  CHECK(frontend::count_in_view({80, 80, 50, 25, 60, 50}, a) == 3);
  CHECK(frontend::mean_distance(a, b, 1) == Approx((5 + 1 + 0) / 3.0));
  CHECK(frontend::mean_distance({}, {}, 1) == 0);
}
