#include "testing.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

Eigen::Isometry3d turn(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::Isometry3d(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
}

/// A non-planar curve, 50 ms per pose.
Trajectory curve(int count) {
  Trajectory trajectory;
  for (int i = 0; i < count; ++i) {
    const double t = 0.3 * i;
    trajectory.push_back(
        {50'000'000LL * i, Eigen::Translation3d(std::cos(t), std::sin(t), 0.1 * t * t) * turn(10 * t, {1, t, 2})});
  }
  return trajectory;
}

Trajectory moved(Trajectory trajectory, const Eigen::Isometry3d& left,
                 const Eigen::Isometry3d& right = Eigen::Isometry3d::Identity()) {
  for (auto& pose : trajectory) pose.world_from_left = left * pose.world_from_left * right;
  return trajectory;
}

}  // namespace

TEST_CASE("evaluation: another world frame adds no error") {
  const Trajectory truth = curve(20);
  const Eigen::Isometry3d world = Eigen::Translation3d(5, -3, 2) * turn(70, {1, 1, 0});
  const TrajectoryEvaluation result = evaluate_trajectory(moved(truth, world), truth);
  for (const auto& errors : {result.origin_aligned, result.se3_aligned}) {
    for (const auto& error :
         {errors.ape_rotation_deg, errors.ape_translation_m, errors.rpe_rotation_deg, errors.rpe_translation_m}) {
      CHECK(error.max < 1e-10);
    }
  }
  CHECK(result.matched == 20);
  CHECK(result.end_drift_percent < 1e-8);
}

TEST_CASE("evaluation: of an estimate denser than the truth, the nearest poses are compared") {
  // 1 m/s along x; a truth every 20 ms, an estimate every 5 ms, 1 ms later than the truth.
  Trajectory truth, estimate;
  for (int i = 0; i < 40; ++i)
    estimate.push_back({5'000'000LL * i + 1'000'000, Eigen::Isometry3d(Eigen::Translation3d(0.005 * i + 0.001, 0, 0))});
  for (int i = 0; i < 10; ++i)
    truth.push_back({20'000'000LL * i, Eigen::Isometry3d(Eigen::Translation3d(0.02 * i, 0, 0))});
  const TrajectoryEvaluation result = evaluate_trajectory(estimate, truth);
  CHECK(result.matched == 10);
  CHECK(result.origin_aligned.ape_translation_m.max < 1e-12);
  for (const auto& pose : result.per_pose) CHECK(pose.stamp_ns % 20'000'000 == 1'000'000);
}

TEST_CASE("evaluation: an almost straight or stationary path leaves the rotation of its alignment undetermined") {
  // Ground truth along z with a given bend; the estimate is off by 10 mm to alternating sides.
  const auto evaluate = [](double length, double bend) {
    Trajectory truth, estimate;
    for (int i = 0; i < 20; ++i) {
      const double s = i / 19.0;
      truth.push_back({i, Eigen::Isometry3d(Eigen::Translation3d(bend * s * s, 0, length * s))});
      estimate.push_back(truth.back());
      estimate.back().world_from_left.translation() += 0.01 * Eigen::Vector3d(i % 2, (i / 2) % 2, (i / 4) % 2);
    }
    return evaluate_trajectory(estimate, truth, 0, 0);
  };
  const auto straight = evaluate(20, 0.02), bent = evaluate(20, 5), still = evaluate(0.001, 0.001);
  CHECK(std::isnan(straight.se3_aligned.ape_rotation_deg.mean));
  CHECK_THAT(straight.se3_open_rotation, Catch::Matchers::Contains("around a straight line"));
  CHECK(straight.se3_aligned.ape_translation_m.rmse < 0.01);
  CHECK(straight.se3_aligned.rpe_rotation_deg.max == Approx(0).margin(1e-9));
  CHECK(bent.se3_open_rotation.empty());
  CHECK(bent.se3_aligned.ape_rotation_deg.mean < 1);
  CHECK_THAT(still.se3_open_rotation, Catch::Matchers::Contains("around one point"));
  CHECK(std::isfinite(still.origin_aligned.ape_rotation_deg.mean));
}

TEST_CASE("evaluation: an estimate that turns around has an APE rotation under both alignments") {
  // In its second half the estimate points and moves in the opposite direction: a half turn about y.
  const Trajectory truth = curve(30);
  Trajectory estimate = truth;
  const Eigen::Isometry3d at = truth[15].world_from_left;
  for (std::size_t i = 15; i < estimate.size(); ++i) {
    estimate[i].world_from_left =
        at * Eigen::Isometry3d(turn(180, {0, 1, 0})) * at.inverse() * truth[i].world_from_left;
  }
  const TrajectoryEvaluation result = evaluate_trajectory(estimate, truth);
  CHECK(result.origin_aligned.ape_rotation_deg.max == Approx(180));
  CHECK(result.se3_open_rotation.empty());
  // Under any alignment the rotation errors of both halves add up to at least a half turn.
  CHECK(result.se3_aligned.ape_rotation_deg.mean >= 89.999);
  CHECK(result.se3_aligned.ape_rotation_deg.max <= 180.001);
}

TEST_CASE("evaluation: poses are matched to the nearest timestamp, each once") {
  const Trajectory truth = curve(20);
  Trajectory estimate;
  for (int i = 0; i < 20; i += 3) estimate.push_back(truth[static_cast<std::size_t>(i)]);
  for (auto& pose : estimate) pose.stamp_ns += 4'000'000;
  const TrajectoryEvaluation sparse = evaluate_trajectory(estimate, truth);
  CHECK(sparse.matched == 7);
  CHECK(sparse.estimate_poses == 7);
  CHECK(sparse.truth_poses == 20);
  CHECK(sparse.origin_aligned.ape_translation_m.max < 1e-12);
  CHECK_THROWS_AS(evaluate_trajectory(estimate, truth, 0, 3'999'999), DataError);
  // Half of the ground truth: the rest of the estimate is not compared.
  CHECK(evaluate_trajectory(estimate, Trajectory(truth.begin(), truth.begin() + 10)).matched == 4);
  // Three poses within the tolerance of one ground-truth pose.
  const Trajectory close = {{0, truth[0].world_from_left},
                            {1'000'000, truth[1].world_from_left},
                            {2'000'000, truth[1].world_from_left},
                            {50'000'000, truth[1].world_from_left}};
  CHECK(evaluate_trajectory(close, truth).matched == 2);
}

TEST_CASE("evaluation: an error about too few matches states timestamps and counts") {
  const Trajectory truth = curve(20);
  Trajectory other = curve(5);
  for (auto& pose : other) pose.stamp_ns += 3'600'000'000'000;
  CHECK_THROWS_WITH(evaluate_trajectory(other, truth), Contains("5 poses from 3600.000000000 to 3600.200000000") &&
                                                           Contains("20 poses from 0.000000000 to 0.950000000"));
  CHECK_THROWS_WITH(evaluate_trajectory({}, truth), Contains("estimate: none"));
  CHECK_THROWS_AS(evaluate_trajectory(truth, truth, 19), DataError);
  CHECK_THROWS_AS(evaluate_trajectory(truth, truth, 500), DataError);
}

TEST_CASE("evaluation: no step leads across segments, and one of a single pose has no errors") {
  const Trajectory truth = curve(12);
  const Eigen::Isometry3d jump = Eigen::Translation3d(1, 2, 3) * turn(40, {1, 2, 3});
  Trajectory estimate = truth;
  for (std::size_t i = 5; i < 12; ++i) estimate[i] = {truth[i].stamp_ns, jump * truth[i].world_from_left, 1};
  estimate[11].segment = 2;
  const TrajectoryEvaluation whole = evaluate_trajectory(estimate, truth);
  CHECK(whole.matched == 12);
  CHECK(whole.rpe_steps == 9);
  CHECK(whole.origin_aligned.ape_translation_m.max > 1);  // the unknown motion
  CHECK(whole.origin_aligned.rpe_translation_m.max < 1e-9);
  for (std::size_t i = 0; i < 12; ++i)
    CHECK(std::isnan(whole.per_pose[i].rpe_rotation_deg) == (i == 0 || i == 5 || i == 11));
  REQUIRE(whole.segments.size() == 3);
  CHECK(whole.segments[1].se3_aligned.ape_translation_m.max < 1e-9);
  const TrajectoryEvaluation& single = whole.segments[2];
  CHECK((single.segment == 2 && single.matched == 1 && single.rpe_steps == 0));
  CHECK(std::isnan(single.origin_aligned.ape_translation_m.mean));
  CHECK(std::isnan(single.se3_aligned.rpe_rotation_deg.max));
  CHECK(evaluate_trajectory(truth, truth).segments.empty());
}

TEST_CASE("evaluation: t_rel and r_rel of a steady drift are those of KITTI's formula") {
  // Steps of 1 m, estimated as 1.02 m, with a turn of 0.01 degrees about the direction of travel. The first pose beyond
  // 100 m is 101 m away, and the errors there, 2.02 m and 1.01 degrees, are divided by 100 m.
  Trajectory truth, estimate;
  for (int i = 0; i < 250; ++i) {
    truth.push_back({100'000'000LL * i, Eigen::Isometry3d(Eigen::Translation3d(0, 0, i))});
    estimate.push_back({100'000'000LL * i, Eigen::Translation3d(0, 0, 1.02 * i) * turn(0.01 * i, {0, 0, 1})});
  }
  const TrajectoryEvaluation result = evaluate_trajectory(estimate, truth);
  REQUIRE(result.sub_paths.size() == 8);
  const SubPathErrors &hundred = result.sub_paths[0], &two_hundred = result.sub_paths[1];
  CHECK(hundred.count == 15);  // starts 0, 10 ... 140: pose 241 exists, pose 251 does not
  CHECK(hundred.translation_percent == Approx(2.02));
  CHECK(hundred.rotation_deg_per_m == Approx(0.0101));
  CHECK(two_hundred.count == 5);  // starts 0 ... 40
  CHECK(two_hundred.translation_percent == Approx(100 * 201 * 0.02 / 200));
  CHECK(two_hundred.rotation_deg_per_m == Approx(2.01 / 200));
  CHECK(result.sub_paths[2].count == 0);
  CHECK(std::isnan(result.sub_paths[2].translation_percent));
  CHECK(result.sub_path_mean.count == 20);  // every sub-path counts once, whatever its length
  CHECK(result.sub_path_mean.translation_percent == Approx((15 * 2.02 + 5 * 2.01) / 20));
  CHECK(result.sub_path_mean.rotation_deg_per_m == Approx((15 * 0.0101 + 5 * 0.01005) / 20));
  CHECK(result.rpe_interval_s == Approx(0.1));

  const auto near = evaluate_trajectory(estimate, truth, 0, kStampToleranceNs, {7.5});
  REQUIRE(near.sub_paths.size() == 1);
  CHECK(near.sub_paths[0].count == 25);  // the first pose beyond 7.5 m is the eighth: from 0 ... 240
  CHECK(near.sub_paths[0].translation_percent == Approx(100 * 0.16 / 7.5));
  for (int i = 0; i < 125; ++i) estimate[static_cast<std::size_t>(i)].world_from_left.translation().z() = 2.5 + i;
  const auto half = evaluate_trajectory(estimate, truth, 0, kStampToleranceNs, {2.5}).sub_paths[0];
  CHECK(half.translation_sd_percent == Approx(2.4 * std::sqrt(12 * 13) / 25));  // 12 of 25 sub-paths are 2.4 % too long

  for (std::size_t i = 125; i < estimate.size(); ++i) estimate[i].segment = 1;  // no sub-path spans the break
  const auto broken = evaluate_trajectory(estimate, truth);
  CHECK(broken.sub_paths[0].count == 3 + 2);  // starts 0, 10, 20 and 130, 140
  CHECK(broken.sub_paths[1].count == 0);
  REQUIRE(broken.segments.size() == 2);
  CHECK(broken.segments[1].sub_paths[0].count == 3);  // poses 125, 135 and 145 of the whole
  CHECK_THROWS_AS(evaluate_trajectory(estimate, truth, 0, kStampToleranceNs, {100, 0}), UsageError);
}
