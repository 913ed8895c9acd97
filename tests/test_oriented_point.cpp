#include "generated_quads.hpp"
#include "geometry/oriented_point.hpp"

using namespace quadedge::pose;

namespace {

std::optional<OrientedPoint> reconstruct(const quadedge::StereoRig& rig, const StereoObservation& observation,
                                         double min_epipolar_angle) {
  const auto measurement = measure(rig, observation, min_epipolar_angle);
  return measurement ? std::optional(measurement->oriented_point()) : std::nullopt;
}

}  // namespace

TEST_CASE("A point and its tangent are recovered from their projections, on any rig", "[pose]") {
  for (const quadedge::StereoRig& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Random random(1);
    int used = 0;
    for (int trial = 0; trial < 300; ++trial) {
      const OrientedPoint truth = generated::random_point(rig, 1.0, 30.0, random);
      const auto found = reconstruct(rig, generated::observe(rig, truth), 0.07);
      if (!found) continue;
      ++used;
      CHECK((found->point - truth.point).norm() < 1e-9 * truth.point.norm());
      // The direction in `observe` is a finite difference, accurate to about 1e-9; the depth slope magnifies its error
      // by depth / baseline.
      CHECK((found->tangent - truth.tangent).norm() < 1e-5);
      CHECK(found->tangent.norm() == Approx(1.0).margin(1e-12));
    }
    CHECK(used > 200);
  }
}

TEST_CASE("A stereo edge without a point in front of the rig is not reconstructed", "[pose]") {
  const quadedge::StereoRig rig = generated::car_rig();
  const double upright = 1.5707963267948966;
  CHECK(reconstruct(rig, {{600, 100}, {590, 100}, upright, upright}, 0.07));
  CHECK_FALSE(reconstruct(rig, {{600, 100}, {610, 100}, upright, upright}, 0.07));  // behind
  CHECK_FALSE(reconstruct(rig, {{600, 100}, {600, 100}, upright, upright}, 0.07));  // infinitely far
  CHECK_FALSE(reconstruct(rig, {{600, 100}, {590, 100}, 0.05, upright}, 0.07));     // along the left epipolar line
  CHECK_FALSE(reconstruct(rig, {{600, 100}, {590, 100}, upright, 3.1}, 0.07));      // along the right one
  CHECK_FALSE(reconstruct(rig, {{600, 100}, {590, 100}, 0.0, 0.0}, 0.0));           // exactly along both
}

TEST_CASE("A distant upright edge is not mistaken for one along its epipolar line", "[pose]") {
  const quadedge::StereoRig rig = generated::car_rig();
  const OrientedPoint truth{{2.0, 1.0, 90.0}, Eigen::Vector3d(0.1, 1.0, 0.0).normalized()};
  const auto found = reconstruct(rig, generated::observe(rig, truth), 0.07);
  REQUIRE(found);
  CHECK((found->point - truth.point).norm() < 1e-9 * 90);
}

TEST_CASE("Projection agrees with the camera and with finite differences", "[pose]") {
  const quadedge::StereoRig rig = generated::crooked_rig();
  generated::Random random(2);
  for (int trial = 0; trial < 50; ++trial) {
    const OrientedPoint p = generated::random_point(rig, 1.0, 10.0, random);
    const auto expected = generated::observe(rig, p);
    const auto left = project(rig.left, Eigen::Isometry3d::Identity(), p);
    const auto right = project(rig.right, rig.right_from_left, p);
    REQUIRE(left);
    REQUIRE(right);
    CHECK((left->pixel - expected.left).norm() < 1e-9);
    CHECK((right->pixel - expected.right).norm() < 1e-9);
    CHECK(left->direction.x() == Approx(std::cos(expected.left_direction)).margin(1e-6));
    CHECK(left->direction.y() == Approx(std::sin(expected.left_direction)).margin(1e-6));
    CHECK(right->direction.x() == Approx(std::cos(expected.right_direction)).margin(1e-6));
    CHECK(right->direction.y() == Approx(std::sin(expected.right_direction)).margin(1e-6));
  }
  CHECK_FALSE(project(rig.left, Eigen::Isometry3d::Identity(), {{0, 0, -1}, Eigen::Vector3d::UnitX()}));
  CHECK_FALSE(project(rig.left, Eigen::Isometry3d::Identity(), {{0, 0, 2}, Eigen::Vector3d::UnitZ()}));
}

TEST_CASE("The depth's sigma is z^2 sigma / (f b) on a rectified rig and matches perturbed measurements on any",
          "[pose]") {
  const OrientedPoint p{{0.5, 0.2, 12.0}, Eigen::Vector3d(0.5, 0.6, 0.1).normalized()};
  const quadedge::StereoRig car = generated::car_rig();
  const auto measured = measure(car, generated::observe(car, p), 0.07);
  REQUIRE(measured);
  CHECK(depth_sigma(*measured, 0.15) == Approx(12.0 * 12.0 * 0.15 / (700 * 0.54)).epsilon(1e-9));

  const quadedge::StereoRig rig = generated::crooked_rig();
  const auto edge = generated::observe(rig, p);
  const auto centre = measure(rig, edge, 0.07);
  REQUIRE(centre);
  const Eigen::Vector2d line = (rig.right.project(rig.right_from_left * (1.01 * p.point)) - edge.right).normalized();
  auto moved = edge;
  moved.right += 1e-4 * line;
  const auto other = measure(rig, moved, 0.07);
  REQUIRE(other);
  CHECK(std::abs(other->inverse_depth - centre->inverse_depth) ==
        Approx(1e-4 * centre->inverse_depth_per_pixel).epsilon(1e-3));
  auto turned = edge;
  turned.right_direction += 1e-6;
  const double by_right = (measure(rig, turned, 0.07)->slope - centre->slope) / 1e-6;
  turned = edge;
  turned.left_direction += 1e-6;
  const double by_left = (measure(rig, turned, 0.07)->slope - centre->slope) / 1e-6;
  CHECK(centre->slope_per_radian == Approx(std::hypot(by_left, by_right)).epsilon(1e-3));
  CHECK(centre->epipolar_sine ==
        Approx(std::abs(line.x() * std::sin(edge.right_direction) - line.y() * std::cos(edge.right_direction))));
}
