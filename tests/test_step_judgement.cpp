#include "output/motion_errors.hpp"
#include "testing.hpp"

using namespace quadedge;
using evaluation::judge_steps;

namespace {

/// Frames 50 ms apart, each 1 m farther along x.
struct Walk {
  Trajectory truth;
  std::vector<std::int64_t> frames;
  explicit Walk(int count) {
    for (int i = 0; i < count; ++i) {
      frames.push_back(50'000'000LL * i);
      truth.push_back({frames.back(), Eigen::Isometry3d(Eigen::Translation3d(i, 0, 0))});
    }
  }
};

}  // namespace

TEST_CASE("steps: right up to 5 cm + 10 % of the motion and 2 degrees, independent of earlier errors") {
  const Walk walk(4);
  // Another world frame; the second step is too long by `excess` and rotated by `degrees`, the third is right again.
  const auto judge = [&](double excess, double degrees) {
    Trajectory estimate = walk.truth;
    const Eigen::Isometry3d error =
        Eigen::Translation3d(excess, 0, 0) * Eigen::AngleAxisd(degrees * kDegree, Eigen::Vector3d::UnitY());
    const Eigen::Isometry3d world =
        Eigen::Translation3d(3, 4, 5) * Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized());
    estimate[2].world_from_left = walk.truth[2].world_from_left * error;
    estimate[3].world_from_left =
        estimate[2].world_from_left * walk.truth[2].world_from_left.inverse() * walk.truth[3].world_from_left;
    for (auto& pose : estimate) pose.world_from_left = world * pose.world_from_left;
    return judge_steps(estimate, walk.truth, walk.frames);
  };
  CHECK(judge(0.149, 0).right == 3);
  CHECK(judge(-0.149, 1.99).right == 3);
  for (const auto& [excess, degrees] :
       {std::make_pair(0.151, 0.0), {-0.151, 0.0}, {0.0, 2.01}, {0.0, -2.01}, {0.0, 180.0}}) {
    const auto result = judge(excess, degrees);
    INFO(excess << " m, " << degrees << " deg");
    CHECK(result.right == 2);
    CHECK(result.wrong == 1);
    CHECK(result.wrong_stamps_ns == std::vector<std::int64_t>{100'000'000});
  }
}

TEST_CASE("steps: both steps at a frame without a pose are lost, and those without ground truth do not count") {
  const Walk walk(6);
  Trajectory estimate = walk.truth;
  for (auto& pose : estimate) pose.stamp_ns += 9'000'000;
  estimate.erase(estimate.begin() + 2);
  auto result = judge_steps(estimate, walk.truth, walk.frames);
  CHECK(result.right == 3);
  CHECK(result.wrong == 0);
  CHECK(result.lost == 2);
  CHECK(result.steps() == 5);
  const Trajectory late(walk.truth.begin() + 3, walk.truth.end());
  result = judge_steps(estimate, late, walk.frames);
  CHECK(result.right == 2);
  CHECK(result.steps() == 2);
  for (auto& pose : estimate) pose.stamp_ns += 2'000'000;  // beyond the tolerance
  CHECK(judge_steps(estimate, walk.truth, walk.frames).lost == 5);
}

TEST_CASE("steps: one from a segment to another is lost") {
  const Walk walk(4);
  Trajectory estimate = walk.truth;
  estimate[2].segment = estimate[3].segment = 1;
  const auto steps = judge_steps(estimate, walk.truth, walk.frames);
  CHECK(steps.right == 2);
  CHECK(steps.lost == 1);
}
