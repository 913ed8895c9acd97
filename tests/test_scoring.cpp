#include "generated_quads.hpp"
#include "motion/scoring.hpp"

using namespace quadedge::pose;

namespace {

/// Squared distance from the segment that extends `half_length` px to both sides of an edge at `at`.
double from_piece(const Eigen::Vector2d& point, const Eigen::Vector2d& at, const Eigen::Vector2d& direction,
                  double half_length) {
  const double along = std::clamp((point - at).dot(direction), -half_length, half_length);
  return (point - at - along * direction).squaredNorm();
}

/// Double-precision version of truncated_cost, by definition.
double plain_cost(const generated::Generated& g, const quadedge::StereoRig& rig, const Eigen::Isometry3d& motion,
                  double threshold) {
  double sum = 0;
  for (std::size_t i = 0; i < g.quads.size(); ++i) {
    const Eigen::Vector3d left = motion * g.quads.previous[i].oriented_point().point,
                          right = rig.right_from_left * left;
    double cost = threshold * threshold;
    if (left.z() > 0 && right.z() > 0) {
      const auto& s = g.quads.scoring;
      const auto half_length = static_cast<double>(s.half_length);
      const double a =
          from_piece(rig.left.project(left), {s.left_x[i], s.left_y[i]}, {s.left_cos[i], s.left_sin[i]}, half_length);
      const double b = from_piece(rig.right.project(right), {s.right_x[i], s.right_y[i]},
                                  {s.right_cos[i], s.right_sin[i]}, half_length);
      cost = std::min(cost, std::max(a, b));
    }
    sum += cost;
  }
  return sum / (threshold * threshold * static_cast<double>(g.quads.size()));
}

}  // namespace

TEST_CASE("The score is the truncated quadratic of the worse image, at any number of quads", "[pose]") {
  generated::Problem problem;
  problem.noise = {0.3, 0.6, 0.02};
  problem.outliers = 0.3;
  generated::Random random(11);
  for (const auto& rig : {generated::car_rig(), generated::crooked_rig()}) {
    problem.rig = rig;
    problem.near = 2;
    problem.far = 20;
    for (int count : {1, 7, 8, 63, 64, 65, 300}) {
      problem.quads = count;
      problem.motion = random.motion(0.02, 0.3);
      auto g = generated::generate(problem, 12);
      const Eigen::Isometry3d guess = random.motion(0.001, 0.01) * problem.motion;
      for (const float half_length : {0.0F, 1.4F}) {
        g.quads.scoring.half_length = half_length;
        CHECK(truncated_cost(g.quads.scoring, LaterCameras(rig, guess), 1.5) ==
              Approx(plain_cost(g, rig, guess, 1.5)).margin(1e-3));
      }
    }
  }
  CHECK(truncated_cost({}, LaterCameras(problem.rig, problem.motion), 1.5) == 1.0);
}

TEST_CASE("Points behind the later rig have the highest cost and are no inliers", "[pose]") {
  generated::Problem problem;
  problem.quads = 100;
  const auto g = generated::generate(problem, 13);
  Eigen::Isometry3d beyond = Eigen::Isometry3d::Identity();
  // Points mirrored through the camera's centre project to the same pixels; only the sign of z differs.
  beyond.linear() = -Eigen::Matrix3d::Identity();
  std::vector<std::uint8_t> mask;
  CHECK(truncated_cost(g.quads.scoring, LaterCameras(problem.rig, beyond), 1.5) == Approx(1.0));
  CHECK(select_inliers(g.quads.scoring, LaterCameras(problem.rig, beyond), 1e6, 3.2, mask) == 0);
}

TEST_CASE("Inliers are quads close in both images and similar in direction, modulo 180 degrees", "[pose]") {
  generated::Problem problem;
  problem.quads = 400;
  problem.outliers = 0.5;
  problem.motion.translation() << 0.1, 0, -0.5;
  auto g = generated::generate(problem, 14);
  const LaterCameras cameras(problem.rig, problem.motion);
  std::vector<std::uint8_t> mask;
  int correct = 0;
  for (bool c : g.correct) correct += c;
  const int found = select_inliers(g.quads.scoring, cameras, 1.5, 0.17, mask);
  CHECK(found >= correct);
  CHECK(found <= correct + 4);  // a random position may be right by chance
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (g.correct[i]) CHECK(mask[i] == 1);

  auto& s = g.quads.scoring;
  const auto turn = [](float& cosine, float& sine, double angle) {
    const double c = static_cast<double>(cosine), n = static_cast<double>(sine);
    cosine = static_cast<float>(c * std::cos(angle) - n * std::sin(angle));
    sine = static_cast<float>(c * std::sin(angle) + n * std::cos(angle));
  };
  std::size_t i = 0;
  while (!g.correct[i]) ++i;
  const auto accepted = [&] {
    select_inliers(s, cameras, 1.5, 10 * quadedge::kDegree, mask);
    return mask[i] == 1;
  };
  turn(s.left_cos[i], s.left_sin[i], 9.9 * quadedge::kDegree);
  CHECK(accepted());
  turn(s.left_cos[i], s.left_sin[i], 0.2 * quadedge::kDegree);
  CHECK_FALSE(accepted());
  turn(s.left_cos[i], s.left_sin[i], (180 - 10.1) * quadedge::kDegree);
  CHECK(accepted());
  turn(s.right_cos[i], s.right_sin[i], -10.1 * quadedge::kDegree);
  CHECK_FALSE(accepted());
  turn(s.right_cos[i], s.right_sin[i], 10.1 * quadedge::kDegree);
  s.right_y[i] += 1.49f;
  CHECK(accepted());
  s.right_y[i] += 0.02f;
  CHECK_FALSE(accepted());
  s.right_y[i] -= 1.51f;
  s.left_x[i] += 1.51f;
  CHECK_FALSE(accepted());
}

TEST_CASE("Cells that hold a marked quad count once", "[pose]") {
  ScoringArrays quads;
  quads.left_x = {0, 15.9f, 16, 3, 40, 100};
  quads.left_y = {0, 15.9f, 3, 16, 40, 100};
  CHECK(count_cells(quads, {1, 1, 1, 1, 0, 0}, 16) == 3);
  CHECK(count_cells(quads, {1, 1, 1, 1, 1, 1}, 16) == 5);
  CHECK(count_cells(quads, {0, 0, 0, 0, 0, 0}, 16) == 0);
  CHECK(count_cells(quads, {1, 1, 1, 1, 1, 1}, 200) == 1);
}
