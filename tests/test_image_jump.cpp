#include "generated_quads.hpp"
#include "matching.hpp"
#include "rig/image_jump.hpp"

using namespace quadedge;
using Eigen::Vector3d;

namespace {

/// Edges at random places between `nearest` and 60 m before and after a motion, with right images that are displaced
/// at the second time.
struct Scene {
  pose::MeasuredEdges before, now;
  TemporalMatches matches;

  Scene(const Eigen::Isometry3d& motion, double displaced, double nearest, int count = 400) {
    matching::Random random(7);
    const StereoRig rig = generated::car_rig();
    while (static_cast<int>(matches.size()) < count) {
      const double depth = 1 / random(1.0 / 60, 1 / nearest);
      const pose::OrientedPoint point{depth * rig.left.ray({random(0, rig.left.width), random(0, rig.left.height)}),
                                      Vector3d(random(-0.3, 0.3), 1, random(-0.3, 0.3)).normalized()};
      const auto measured = [&](const Eigen::Isometry3d& moved, double by) {
        pose::StereoObservation seen = generated::observe(rig, {moved * point.point, moved.linear() * point.tangent});
        seen.right.x() -= by + random(-0.2, 0.2);
        return pose::measure(rig, seen, 0.05);
      };
      const auto one = measured(Eigen::Isometry3d::Identity(), 0), other = measured(motion, displaced);
      if (!one || !other) continue;
      const auto number = static_cast<std::int32_t>(before.size());
      before.push_back(one);
      now.push_back(other);
      matches.previous.push_back(number);
      matches.current.push_back(number);
    }
  }
};

Eigen::Isometry3d forward(double metres, double degrees) {
  return Eigen::Translation3d(0.02, 0.01, -metres) *
         Eigen::AngleAxisd(degrees * matching::kDegree, Vector3d(0.3, 1, 0.2).normalized());
}

}  // namespace

TEST_CASE("image jump: a displaced right image is measured beside the motion") {
  for (const double displaced : {0.0, 2.8, -3.5}) {
    const Scene scene(forward(0.8, 1), displaced, 5);
    // The prediction is off by 0.1 m and by 0.2 degrees.
    for (const auto& predicted : {forward(0.8, 1), forward(0.7, 1), forward(0.8, 1.2)}) {
      const auto jump = rig::JumpMeter().measure(scene.before, scene.now, scene.matches, predicted);
      REQUIRE(jump);
      CHECK(jump->shift == Approx(displaced).margin(0.1));
      CHECK(std::abs(jump->shift - displaced) < 5 * jump->sigma);
      CHECK(jump->scatter < 0.2);
    }
  }
}

TEST_CASE("image jump: a third of wrong matches does not matter") {
  Scene scene(forward(0.8, 1), 2.8, 5);
  for (std::size_t m = 0; m + 1 < scene.matches.size(); m += 6)
    std::swap(scene.matches.current[m], scene.matches.current[m + 1]);
  const auto jump = rig::JumpMeter().measure(scene.before, scene.now, scene.matches, forward(0.8, 1));
  REQUIRE(jump);
  CHECK(jump->shift == Approx(2.8).margin(0.2));
}

TEST_CASE("image jump: few matches show none") {
  const Scene scene(forward(0.8, 1), 2.8, 5, 20);
  CHECK_FALSE(rig::JumpMeter().measure(scene.before, scene.now, scene.matches, forward(0.8, 1)));
}
