#include "generated_quads.hpp"
#include "motion/reprojection_terms.hpp"
#include "reprojection_jacobian.hpp"

using namespace quadedge::pose;

namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

struct Expected {
  Matrix7d matrix = Matrix7d::Zero();
  Vector7d gradient = Vector7d::Zero();
  double cost = 0, depth = 0;
};

/// One quad's contribution from reprojection_jacobian(): Gauss-Newton over (pose, offset, depth, error of its own
/// disparities) with normal priors on the last two, which the Schur complement eliminates.
std::optional<Expected> contribution(const ReprojectionTerm& term, const Eigen::Isometry3d& pose, double offset,
                                     double depth, const StudentWeights& weights) {
  ReprojectionJacobian linear;
  if (!reprojection_jacobian(term, pose, depth, linear)) return std::nullopt;
  const double sigma = std::sqrt(term.disparity_variance);
  Eigen::Matrix<double, 5, 9> jacobian = Eigen::Matrix<double, 5, 9>::Zero();
  jacobian.topRows<3>() << linear.by_pose, linear.by_offset, linear.by_depth, linear.by_offset * sigma;
  jacobian.bottomRightCorner<2, 2>().setIdentity();
  Eigen::Matrix<double, 5, 1> residual;
  residual << linear.value + linear.by_offset * offset, depth, 0;
  const Eigen::Matrix<double, 9, 9> normal = jacobian.transpose() * jacobian;
  const Eigen::Matrix<double, 9, 1> gradient = jacobian.transpose() * residual;
  const Eigen::Matrix2d inverse = normal.bottomRightCorner<2, 2>().inverse();
  const Eigen::Vector2d step = inverse * gradient.tail<2>();
  Expected result;
  result.depth = depth - step(0);
  result.cost = residual.squaredNorm() - gradient.tail<2>().dot(step);
  const double weight = student_weight(result.cost, weights.scale, kReprojectionSize, weights.dof) / weights.scale;
  result.matrix = weight * (normal.topLeftCorner<7, 7>() -
                            normal.topRightCorner<7, 2>() * inverse * normal.bottomLeftCorner<2, 7>());
  result.gradient = weight * (gradient.head<7>() - normal.topRightCorner<7, 2>() * step);
  return result;
}

struct ManyQuads {
  explicit ManyQuads(int quads, double disparity_error = 0.4) : noise(config, disparity_error) {
    generated::Random random(50);
    problem.rig = generated::crooked_rig();
    problem.near = 2;
    problem.far = 20;
    problem.quads = quads;
    problem.motion = random.motion(0.1, 0.5);
    problem.noise = {0.3, 0.5, 0.05};
    quads_of = generated::generate(problem, 51).quads;
    pose = random.motion(0.02, 0.1) * problem.motion;
    for (std::size_t i = 0; i < quads_of.size(); i += 2) rows.push_back(static_cast<std::int32_t>(i));
    terms.assign(quads_of, rows, problem.rig.left, noise);
  }
  ReprojectionTerm term(std::size_t k) const {
    return make_reprojection_term(quads_of, static_cast<std::size_t>(rows[k]), problem.rig.left, noise);
  }

  generated::Problem problem;
  quadedge::PoseConfig config;
  NoiseModel noise;
  QuadObservations quads_of;
  Eigen::Isometry3d pose;
  std::vector<std::int32_t> rows;
  ReprojectionTerms terms;
};

template <class A, class B>
void check_close(const A& a, const B& b) {
  CHECK((a - b).norm() < 1e-9 * b.norm());
}

}  // namespace

TEST_CASE("Sums over reprojection terms equal those of the Jacobians with the depths eliminated", "[pose]") {
  const StudentWeights weights{1.7, 5};
  const double offset = 0.2;
  for (int quads : {1, 7, 16, 2 * 1024 + 3, 5001}) {
    ManyQuads scene(quads);
    REQUIRE(scene.terms.size() == scene.rows.size());
    std::vector<double> depth(scene.rows.size(), 0.0);
    for (int round = 0; round < 2; ++round) {  // from the second round on the depths are not zero
      Expected sum;
      std::vector<double> costs;
      for (std::size_t k = 0; k < scene.rows.size(); ++k) {
        const auto own = contribution(scene.term(k), scene.pose, offset, depth[k], weights);
        REQUIRE(own);
        sum.matrix += own->matrix;
        sum.gradient += own->gradient;
        depth[k] = own->depth;
        costs.push_back(own->cost);
      }
      LaneContributions lanes;
      Matrix6d by_lanes = Matrix6d::Zero();
      Vector6d gradient = Vector6d::Zero();
      for (std::size_t k = 0; k < scene.rows.size(); ++k) {
        if (k % kLanes == 0) contributions_by_pose(scene.terms, Evaluation(scene.pose, offset, weights), k, lanes);
        by_lanes += lanes.matrix(k % kLanes);
        gradient += lanes.gradient(k % kLanes);
      }
      check_close(by_lanes, sum.matrix.topLeftCorner<6, 6>());
      check_close(gradient, sum.gradient.head<6>());
      ReprojectionTerms same = scene.terms;
      const Normal<6> six = normal_by_pose(same, scene.pose, offset, weights);
      check_close(six.matrix, sum.matrix.topLeftCorner<6, 6>());
      check_close(six.gradient, sum.gradient.head<6>());
      const Normal<7> seven = normal_by_pose_and_offset(scene.terms, scene.pose, offset, weights);
      check_close(seven.matrix, sum.matrix);
      check_close(seven.gradient, sum.gradient);
      for (std::size_t k = 0; k < depth.size(); ++k) {
        CHECK(scene.terms.depth[k] == Approx(depth[k]).margin(1e-9));
        CHECK(scene.terms.error[k] == Approx(costs[k]).epsilon(1e-9));
        CHECK(same.error[k] == scene.terms.error[k]);
      }
    }
  }
}

TEST_CASE("The size of disparity errors is read from the scatter of quads", "[pose]") {
  for (const double size : {0.0, 0.2, 0.6}) {
    for (const double assumed : {0.0, 0.3}) {
      ManyQuads scene(20000, assumed);
      scene.problem.noise = {scene.config.sigma_across, kSigmaAlong, 0.03};
      generated::Random random(53);
      constexpr int kScenes = 8;  // medians of the quads of one scatter by a tenth
      double variance = 0;
      for (int number = 0; number < kScenes; ++number) {
        QuadObservations quads = generated::generate(scene.problem, 60 + static_cast<unsigned>(number)).quads;
        quads.scoring.half_length = 0;
        for (std::size_t i = 0; i < quads.size(); ++i) {
          const double error = size * random.normal();
          for (StereoMeasurement* at : {&quads.previous[i], &quads.current[i]})
            at->inverse_depth += error * at->inverse_depth_per_pixel;
        }
        scene.terms.assign(quads, scene.rows, scene.problem.rig.left, scene.noise);
        for (int round = 0; round < 3; ++round) normal_by_pose(scene.terms, scene.problem.motion, 0, {});
        const DisparityErrors found = disparity_errors(scene.terms, scene.problem.motion, 0);
        CHECK(found.information > 5);
        variance += found.variance / kScenes;
      }
      CAPTURE(size, assumed);
      CHECK(variance == Approx(size * size).epsilon(0.15).margin(0.01));
    }
  }
  ManyQuads none(1);
  CHECK(disparity_errors(none.terms, none.pose, 0).information == 0);
}

TEST_CASE("A quad behind the camera does not count and keeps its depth and error", "[pose]") {
  ManyQuads scene(9);
  normal_by_pose(scene.terms, scene.pose, 0, {});
  const auto depth = scene.terms.depth, error = scene.terms.error;
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translation() << 0, 0, -1000;
  const Normal<6> normal = normal_by_pose(scene.terms, away, 0, {});
  CHECK(normal.matrix.isZero(0));
  CHECK(normal.gradient.isZero(0));
  CHECK(scene.terms.depth == depth);
  CHECK(scene.terms.error == error);
}

namespace {

using LaneValues = Contributions<kOffsetValues, kLanes>;
using EvaluateLanes = void (*)(const ReprojectionTerms&, const Evaluation&, LaneValues&);

/// The first eight quads, in vectors of the width that the caller is compiled for.
[[gnu::always_inline]] inline void evaluate_lanes(const ReprojectionTerms& terms, const Evaluation& at,
                                                  LaneValues& result) {
  const double* columns[ReprojectionTerms::kColumns];
  for (std::size_t k = 0; k < ReprojectionTerms::kColumns; ++k) columns[k] = terms.column(k);
  const double* depth = terms.depth.data();
  LaneValues lanes;
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    contribute(row_of<ReprojectionTerm>(columns, lane), depth[lane], at, lane, lanes);
  result = lanes;
}

void at_x86_64(const ReprojectionTerms& terms, const Evaluation& at, LaneValues& result) {
  evaluate_lanes(terms, at, result);
}

/// This file is compiled with -O3, so that each of these is vectorised.
std::vector<EvaluateLanes> widths_of_this_machine();

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
[[gnu::target("arch=x86-64-v3")]] void at_x86_64_v3(const ReprojectionTerms& terms, const Evaluation& at,
                                                    LaneValues& result) {
  evaluate_lanes(terms, at, result);
}
[[gnu::target("arch=x86-64-v4")]] void at_x86_64_v4(const ReprojectionTerms& terms, const Evaluation& at,
                                                    LaneValues& result) {
  evaluate_lanes(terms, at, result);
}
std::vector<EvaluateLanes> widths_of_this_machine() {
  std::vector<EvaluateLanes> result = {at_x86_64};
  if (__builtin_cpu_supports("x86-64-v3")) result.push_back(at_x86_64_v3);
  if (__builtin_cpu_supports("x86-64-v4")) result.push_back(at_x86_64_v4);
  return result;
}
#else
std::vector<EvaluateLanes> widths_of_this_machine() { return {at_x86_64}; }
#endif

[[gnu::noinline]] void alone(const ReprojectionTerm& term, double depth, const Evaluation& at,
                             Contributions<kOffsetValues, 1>& result) {
  contribute(term, depth, at, 0, result);
}

}  // namespace

TEST_CASE("One quad alone and eight at once, at every vector width, give the same bits", "[pose]") {
  ManyQuads scene(2 * kLanes);
  Eigen::Isometry3d half_behind = scene.pose;  // half of the points end up behind the camera
  half_behind.translation().z() -= 5;
  for (const auto& pose : {scene.pose, half_behind}) {
    const Evaluation at(pose, 0.2, {1.7, 5});
    for (std::size_t k = 0; k < kLanes; ++k) scene.terms.depth[k] = 0.1 * static_cast<double>(k) - 0.3;
    LaneContributions production;
    contributions_by_pose(scene.terms, at, 0, production);
    for (const EvaluateLanes evaluate : widths_of_this_machine()) {
      LaneValues lanes;
      evaluate(scene.terms, at, lanes);
      int behind = 0;
      for (std::size_t k = 0; k < kLanes; ++k) {
        Contributions<kOffsetValues, 1> one;
        alone(scene.term(k), scene.terms.depth[k], at, one);
        behind += one.error[0] < 0;
        for (std::size_t j = 0; j < kOffsetValues; ++j) CHECK(lanes.values[j][k] == one.values[j][0]);
        for (std::size_t j = 0; j < kPoseValues; ++j) CHECK(production.values[j][k] == one.values[j][0]);
        CHECK(lanes.depth[k] == one.depth[0]);
        CHECK(lanes.error[k] == one.error[0]);
      }
      const bool some_behind = behind > 0 && behind < static_cast<int>(kLanes);
      CHECK(some_behind == (pose.translation() != scene.pose.translation()));
    }
  }
}
