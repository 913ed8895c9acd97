#include "motion/tracking_state.hpp"
#include "testing.hpp"

using namespace quadedge;
using odometry::ConstantVelocity;
using odometry::KeyRig;
using odometry::KeyRigFitness;

namespace {

KeyRig key_rig(int frame, const Eigen::Isometry3d& world_from_left = Eigen::Isometry3d::Identity()) {
  auto frame_edges = std::make_shared<frontend::FrameEdges>();
  frame_edges->start(frame);
  return KeyRig(frame_edges, {world_from_left});
}

}  // namespace

TEST_CASE("keyframe: each criterion alone triggers a replacement") {
  OdometryConfig config;
  config.key_min_quads = 2;
  KeyRigFitness fit;
  fit.quads = 3;
  fit.inlier_ratio = 0.4;
  fit.median_parallax = 16;
  fit.rotation = 0.1745;  // 9.998 degrees
  fit.frames = 9;
  KeyRig rig = key_rig(0);
  KeyRigFitness first = fit;
  first.quads = 10;  // the reference count: at least 0.3 x 10 = 3 must remain
  CHECK_FALSE(rig.needs_replacement(first, config));
  CHECK_FALSE(rig.needs_replacement(fit, config));
  using Fitness = KeyRigFitness&;
  for (void (*change)(Fitness) : {+[](Fitness f) { f.quads = 2; }, +[](Fitness f) { f.inlier_ratio = 0.39; },
                                  +[](Fitness f) { f.median_parallax = 16.01; },
                                  +[](Fitness f) { f.rotation = 0.1746; }, +[](Fitness f) { f.frames = 10; }}) {
    KeyRigFitness changed = fit;
    change(changed);
    CHECK(rig.needs_replacement(changed, config));
  }
  config.key_min_quads = 4;  // the minimum number
  CHECK(rig.needs_replacement(fit, config));
  config.key_min_quads = 2;
  // A new keyframe sets a new reference count.
  rig = key_rig(9);
  fit.quads = 2;
  CHECK_FALSE(rig.needs_replacement(fit, config));
}

TEST_CASE("constant velocity: a motion over several intervals is divided evenly and repeated along its curve") {
  ConstantVelocity velocity;
  CHECK_FALSE(velocity.predict({1}));
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity(), shift = turn;
  turn.linear() = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  velocity.observe(turn, {3});
  CHECK(Eigen::AngleAxisd(velocity.predict({1})->linear()).angle() == Approx(0.1));
  CHECK(velocity.predict({3})->isApprox(turn, 1e-12));
  CHECK(velocity.predict({0})->matrix() == Eigen::Matrix4d::Identity());
  shift.translation() = Eigen::Vector3d(0, 0.4, -1);
  velocity.observe(shift, {2});
  CHECK(velocity.predict({1})->translation().isApprox(Eigen::Vector3d(0, 0.2, -0.5)));
  CHECK(velocity.predict({5})->translation().isApprox(Eigen::Vector3d(0, 1, -2.5)));
  turn.translation() = Eigen::Vector3d(0.1, 0, 0.7);
  velocity.observe(turn, {1});
  CHECK(velocity.predict({2})->isApprox(turn * turn, 1e-12));
  velocity.forget();
  CHECK_FALSE(velocity.predict({1}));

  // Stamps tell how many intervals a step has; which a dropped frame has, test_odometry_losses shows.
  constexpr std::int64_t kInterval = 50'000'000;
  velocity.observe(turn, {1, kInterval});
  for (const auto& [number, stamp, intervals] : {std::tuple(1, kInterval, 1),
                                                 {1, 6 * kInterval / 5, 1},
                                                 {1, 4 * kInterval / 5, 1},
                                                 {1, std::int64_t{0}, 1},
                                                 {1, 2 * kInterval, 2},
                                                 {2, 2 * kInterval, 2}})
    CHECK(velocity.predict({number, stamp})->isApprox(intervals == 2 ? turn * turn : turn, 1e-12));
  CHECK_FALSE(velocity.predict({1, 11 * kInterval}));
}
