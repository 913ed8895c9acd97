#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "odometry/disparity_offset.hpp"
#include "pose/oriented_point.hpp"

using namespace quadedge;
using odometry::DisparityOffset;

TEST_CASE("disparity offset: the corrected rig reconstructs points nearer by the offset", "[odometry]") {
  PoseConfig config;
  config.disparity_offset_sigma = 0.3;
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    DisparityOffset offset(rig, config);
    CHECK(offset.variance() == Approx(0.09));
    offset.update(0.25, 0.0004, 1);
    offset.update(-0.05, 0.0003, 5);
    CHECK(offset.value() == Approx(0.2));
    CHECK(offset.variance() == Approx(0.0003 + 5 * 0.000009));
    // The same pixels, triangulated with both rigs: the inverse depth grows by the equivalent of 0.2 px.
    const pose::OrientedPoint point{{0.1, -0.05, 6}, Eigen::Vector3d(0.5, 0.8, 0.2).normalized()};
    const auto seen = generated::observe(rig, point);
    const auto before = pose::measure(rig, seen, 0.05), after = pose::measure(offset.rig(), seen, 0.05);
    REQUIRE((before && after));
    CHECK(after->inverse_depth - before->inverse_depth == Approx(0.2 * before->inverse_depth_per_pixel).epsilon(0.02));
  }
}

TEST_CASE("disparity offset: switched off, it changes nothing", "[odometry]") {
  PoseConfig config;
  config.disparity_offset_sigma = 0;
  DisparityOffset offset(generated::car_rig(), config);
  CHECK(offset.variance() == 0);
  offset.update(0.25, 0.0004, 1);
  CHECK(offset.value() == 0);
  CHECK(offset.rig().right.cx == generated::car_rig().right.cx);
}

TEST_CASE("disparity offset: it starts from the configured value", "[odometry]") {
  PoseConfig config;
  config.disparity_offset = -0.4;
  const StereoRig rig = generated::car_rig();
  DisparityOffset offset(rig, config);
  CHECK(offset.value() == -0.4);
  CHECK(offset.rig().right.cx == odometry::with_disparity_offset(rig, -0.4).right.cx);
  offset.update(0.1, 0.0004, 1);
  CHECK(offset.value() == Approx(-0.3));
}
