/// \file sample_fit.cpp  Gauss-Newton with depth and slope of every quad eliminated, in vector lanes.
#include "motion/sample_fit.hpp"

#include "common/parallel.hpp"
#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

/// Where the values of a contribution (see kPoseValues) hold the rotation: the upper triangle of its part of the
/// matrix, row by row, then its gradient.
constexpr std::size_t kRotationValues[] = {0, 1, 2, 6, 7, 11, kMatrixValues, kMatrixValues + 1, kMatrixValues + 2};

/// A motion at which all terms are evaluated, with the weights of the two kinds of residuals.
struct SampleEvaluation {
  Evaluation reprojection;
  double direction_scale;
};

/// What the evaluation reads and updates of each term.
struct Estimates {
  double *depth, *reprojection_error, *direction_error;
};

[[gnu::always_inline]] inline Vector3 rotate(const double (&r)[3][3], double x, double y, double z) {
  return {r[0][0] * x + r[0][1] * y + r[0][2] * z, r[1][0] * x + r[1][1] * y + r[1][2] * z,
          r[2][0] * x + r[2][1] * y + r[2][2] * z};
}

/// Adds the direction of a quad to its contribution, with its slope eliminated like the depth in `Eliminated`. With the
/// derivatives G of both residuals with respect to the rotation and h with respect to the slope, P = I - shrink h h^T.
/// \returns the squared error; -1 if the quad is behind the camera, as its reprojection tells
[[gnu::always_inline]] inline double add_direction(const SampleBlock& block, const SampleEvaluation& at,
                                                   std::size_t lane, LaneContributions& lanes) {
  const auto& rotation = at.reprojection.rotation;
  const auto term = row_of<DirectionTerm>(block.direction, lane);
  const Vector3 ray = rotate(rotation, block.reprojection[0][lane], block.reprojection[1][lane], 1.0);
  const Vector3 tangent = rotate(rotation, term.tangent.x, term.tangent.y, term.tangent.z);
  const DirectionResidual e = direction_residual(term, ray, tangent);
  const double h0 = e.left_by_slope, h1 = e.right_by_slope;
  const double shrink = 1.0 / (1.0 + h0 * h0 + h1 * h1), he = h0 * e.left + h1 * e.right, taken = shrink * he;
  const double error = e.left * e.left + e.right * e.right - taken * he;
  const double in_front_weight =
      student_weight(error, at.direction_scale, kDirectionSize, at.reprojection.weights.dof) / at.direction_scale;
  const bool in_front = lanes.error[lane] >= 0.0;
  const double weight = in_front ? in_front_weight : 0.0;
  const Vector3 &g0 = e.left_by_rotation, &g1 = e.right_by_rotation;
  const Vector3 q = {h0 * g0.x + h1 * g1.x, h0 * g0.y + h1 * g1.y, h0 * g0.z + h1 * g1.z};
  const auto product = [&](double a0, double a1, double a, double b0, double b1, double b) {
    return weight * (a0 * b0 + a1 * b1 - shrink * a * b);
  };
  const auto project = [&](double a0, double a1, double a) {
    return weight * (a0 * e.left + a1 * e.right - taken * a);
  };
  const double values[] = {product(g0.x, g1.x, q.x, g0.x, g1.x, q.x),
                           product(g0.x, g1.x, q.x, g0.y, g1.y, q.y),
                           product(g0.x, g1.x, q.x, g0.z, g1.z, q.z),
                           product(g0.y, g1.y, q.y, g0.y, g1.y, q.y),
                           product(g0.y, g1.y, q.y, g0.z, g1.z, q.z),
                           product(g0.z, g1.z, q.z, g0.z, g1.z, q.z),
                           project(g0.x, g1.x, q.x),
                           project(g0.y, g1.y, q.y),
                           project(g0.z, g1.z, q.z)};
  for (std::size_t k = 0; k < std::size(kRotationValues); ++k) lanes.values[kRotationValues[k]][lane] += values[k];
  return in_front ? error : -1.0;
}

/// Sums the contributions of all blocks and updates the estimates. Those of quads behind the camera keep their values.
QUADEDGE_VECTOR_CLONES
void sum_blocks(const SampleBlock* blocks, std::size_t count, const SampleEvaluation& at, const Estimates& estimates,
                double* sums) {
  double total[kPoseValues][kLanes] = {};
  for (std::size_t b = 0; b < count; ++b) {
    const SampleBlock& block = blocks[b];
    double* const depth = estimates.depth + b * kLanes;
    double* const reprojection_error = estimates.reprojection_error + b * kLanes;
    double* const direction_error = estimates.direction_error + b * kLanes;
    LaneContributions lanes;
    double errors[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      contribute(row_of<ReprojectionTerm>(block.reprojection, lane), depth[lane], at.reprojection, lane, lanes);
      errors[lane] = add_direction(block, at, lane, lanes);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      depth[lane] = lanes.depth[lane];
      reprojection_error[lane] = lanes.error[lane] < 0 ? reprojection_error[lane] : lanes.error[lane];
      direction_error[lane] = errors[lane] < 0 ? direction_error[lane] : errors[lane];
    }
    for (std::size_t j = 0; j < kPoseValues; ++j)
      for (std::size_t lane = 0; lane < kLanes; ++lane) total[j][lane] += lanes.values[j][lane];
  }
  for (std::size_t j = 0; j < kPoseValues; ++j) {
    sums[j] = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) sums[j] += total[j][lane];
  }
}

}  // namespace

SampleTerm make_sample_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise,
                            const PinholeCamera& left) {
  return {make_reprojection_term(quads, quad, left, noise), make_direction_term(quads, quad, noise)};
}

bool fit_sample(const std::vector<SampleTerm>& terms, const std::vector<std::int32_t>& rows, const PoseConfig& config,
                Eigen::Isometry3d& current_from_previous, SampleWorkspace& workspace) {
  if (rows.empty()) return false;
  const std::size_t blocks = (rows.size() + kLanes - 1) / kLanes;
  workspace.blocks.resize(blocks);
  workspace.blocks.back() = {};
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const SampleTerm& term = terms[static_cast<std::size_t>(rows[k])];
    set_row(workspace.blocks[k / kLanes].reprojection, k % kLanes, term.reprojection);
    set_row(workspace.blocks[k / kLanes].direction, k % kLanes, term.direction);
  }
  for (auto* values : {&workspace.depth, &workspace.reprojection_error, &workspace.direction_error})
    values->assign(blocks * kLanes, 0.0);

  StudentWeights weights = {1, config.student_dof};
  double direction_scale = 1;
  double sums[kPoseValues];
  const auto evaluate = [&] {
    sum_blocks(workspace.blocks.data(), blocks, {Evaluation(current_from_previous, 0, weights), direction_scale},
               {workspace.depth.data(), workspace.reprojection_error.data(), workspace.direction_error.data()}, sums);
  };
  const auto measure_scales = [&] {
    weights.scale =
        measured_scale(workspace.reprojection_error, rows.size(), kReprojectionMedian, workspace.scale_values);
    direction_scale = measured_scale(workspace.direction_error, rows.size(), kDirectionMedian, workspace.scale_values);
  };
  evaluate();
  measure_scales();
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    evaluate();
    Normal<6> normal;
    unpack_pose(sums, 1, normal.matrix);
    normal.gradient = Eigen::Map<const Vector6d>(sums + kMatrixValues);
    Vector6d step;
    if (!solve(normal, step)) return false;
    current_from_previous = perturb(step, current_from_previous);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
    measure_scales();
  }
  return true;
}

}  // namespace quadedge::pose
