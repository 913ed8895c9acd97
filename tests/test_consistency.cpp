#include "geometry/uncertain_pose.hpp"
#include "motion/refinement.hpp"
#include "output/motion_errors.hpp"
#include "testing.hpp"

using namespace quadedge;

namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// Keyframes along a curve, whose errors relative to the one before have the covariance `real`; they report `claimed`.
struct MadeUpRun {
  std::vector<FrameResult> results;
  Trajectory truth;
  MadeUpRun(int frames, const Matrix6d& real, const Matrix6d& claimed) {
    std::mt19937_64 random(5);
    std::normal_distribution<double> normal;
    const Matrix6d root = real.llt().matrixL();
    const Eigen::Isometry3d world =
        Eigen::Translation3d(4, 5, 6) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
    Eigen::Isometry3d before = Eigen::Isometry3d::Identity();
    for (int i = 0; i < frames; ++i) {
      const Eigen::Isometry3d pose =
          Eigen::Translation3d(0.1 * i, 0, 1) * Eigen::AngleAxisd(0.02 * i, Eigen::Vector3d::UnitY());
      truth.push_back({50'000'000LL * i, world * pose});
      FrameResult result;
      result.stamp_ns = truth.back().stamp_ns;
      const bool is_first = i % 10 == 0;  // of a part that nothing connects with the one before
      result.status = is_first ? FrameStatus::first : FrameStatus::tracked;
      if (!is_first) {
        Eigen::Matrix<double, 6, 1> white;
        for (int k = 0; k < 6; ++k) white(k) = normal(random);
        result.reference_frame = i - 1;
        result.current_from_reference = pose::perturb(root * white, pose.inverse() * before);
        result.relative_covariance = pose::in_other_order(claimed);
        result.diagnostics.covariance_in_reference = PoseCovariance::Zero();
      }
      results.push_back(result);
      before = pose;
    }
  }
};

/// Rotations of about 1e-3 rad, translations of 1e-2 m, both correlated.
Matrix6d covariance() {
  Matrix6d root = Matrix6d::Zero();
  root.diagonal() << 1e-3, 2e-3, 1e-3, 1e-2, 2e-2, 1e-2;
  root(3, 1) = 8e-3;
  root(5, 0) = -5e-3;
  return root * root.transpose();
}

/// Of motions over one frame.
evaluation::Consistency judged(const MadeUpRun& run) {
  return evaluation::judge_steps(run.results, run.truth, PoseConfig()).at(0).edges;
}

}  // namespace

TEST_CASE("consistency: consistent covariances give 1, half the standard deviations give 4") {
  const MadeUpRun consistent(2000, covariance(), covariance());
  const auto one = judged(consistent);
  CHECK(one.poses == 1800);
  CHECK(one.pose == Approx(1).margin(0.05));  // standard deviation of the mean: 0.013
  CHECK(one.rotation == Approx(1).margin(0.08));
  CHECK(one.translation == Approx(1).margin(0.08));
  const MadeUpRun boasting(2000, covariance(), 0.25 * covariance());
  CHECK(judged(boasting).pose == Approx(4).epsilon(0.05));
}

TEST_CASE("consistency: an error in rotation alone shows in the rotation alone") {
  Matrix6d larger = covariance();
  larger.topLeftCorner<3, 3>() *= 9;
  larger.topRightCorner<3, 3>().setZero();
  larger.bottomLeftCorner<3, 3>().setZero();
  const MadeUpRun run(2000, larger, covariance());
  const auto result = judged(run);
  CHECK(result.rotation == Approx(9).epsilon(0.08));
  CHECK(result.translation == Approx(1).epsilon(0.08));
}

TEST_CASE("consistency: lost frames and frames without covariance or ground truth are left out") {
  MadeUpRun run(13, covariance(), covariance());
  run.results[3].status = FrameStatus::lost_no_consensus;
  run.results[8].relative_covariance->setZero();
  run.truth.erase(run.truth.begin() + 6);
  CHECK(judged(run).poses == 6);
}

TEST_CASE("consistency: a wrong baseline shows over longer motions, and the rig's uncertainty covers it") {
  // Every frame is a keyframe, 0.1 m per frame; the baseline is too long by its standard deviation.
  const PoseConfig config;
  std::vector<FrameResult> results;
  Trajectory truth;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 1e-4);
  for (int i = 0; i < 101; ++i) {
    const Eigen::Isometry3d place(Eigen::Translation3d(0, 0, 0.1 * i));
    truth.push_back({50'000'000LL * i, place});
    FrameResult result;
    result.stamp_ns = truth.back().stamp_ns;
    result.status = i == 0 ? FrameStatus::first : FrameStatus::tracked;
    result.reference_frame = std::max(0, i - 1);
    result.diagnostics.covariance_in_reference = PoseCovariance::Zero();
    if (i > 0) {
      Eigen::Vector3d way(noise(random), noise(random), noise(random));
      way.z() -= 0.1 * (1 + config.rig_sigma_length);
      result.current_from_reference = Eigen::Isometry3d(Eigen::Translation3d(way));
      result.relative_covariance = 1e-8 * Matrix6d::Identity();
      result.diagnostics.rig_sensitivity = pose::rig_sensitivity(result.current_from_reference->inverse(), 0.1);
      result.diagnostics.covariance_in_reference = pose::rig_covariance(result.diagnostics.rig_sensitivity, config);
    }
    results.push_back(result);
  }
  const auto steps = evaluation::judge_steps(results, truth, config);
  REQUIRE(steps.size() == 7);  // 1, 2, 5, 10, 20, 50 frames; 1 s is 20, 2 s are 40; 5 s have too few motions
  CHECK(steps[5].frames == 40);
  for (const auto& step : steps) {
    const double length = 0.1 * step.frames;
    CHECK(step.error_m == Approx(config.rig_sigma_length * length).epsilon(0.2));
    CHECK(step.with_rig.translation < 1.5);
    CHECK(step.with_rig.translation > 0.2);  // one direction of three is off by its standard deviation
    if (step.frames >= 10) CHECK(step.edges.translation > 50);
  }
  CHECK(evaluation::judge_steps(results, {}, config).empty());
  results[50].diagnostics.covariance_in_reference = std::nullopt;  // lost: nothing connects the frames before and after
  results[50].status = FrameStatus::lost_no_consensus;
  const auto broken = evaluation::judge_steps(results, truth, config);
  CHECK(broken[0].edges.poses == 98);
}
