#include "pose/sample_fit.hpp"

#include <cmath>

#include "pose/fit_limits.hpp"

namespace quadedge::pose {

namespace {

/// A block of residuals from which its unknown, with a standard normal prior, has been eliminated: error^T error is the
/// cost of the block.
template <int Rows, int Columns>
struct WithoutUnknown {
  Eigen::Matrix<double, Rows, 1> error;
  Eigen::Matrix<double, Rows, Columns> by_pose;
  double unknown = 0;  ///< optimal value of the unknown
};

/// Minimises |r + h (z - at)|^2 + z^2 over z. With S = I + h h^T, the cost is e^T S^-1 e, where e = r - h at;
/// multiplication by S^-1/2 turns it into a plain sum of squares.
template <int Rows, int Columns>
void eliminate(const Eigen::Matrix<double, Rows, 1>& residual, const Eigen::Matrix<double, Rows, Columns>& by_pose,
               const Eigen::Matrix<double, Rows, 1>& by_unknown, double at, WithoutUnknown<Rows, Columns>& result) {
  const double square = by_unknown.squaredNorm();
  const double shrink = 1.0 / (1.0 + square);
  const double root = square > 0 ? (1.0 - std::sqrt(shrink)) / square : 0.0;
  const Eigen::Matrix<double, Rows, 1> error = residual - by_unknown * at;
  const double along = by_unknown.dot(error);
  result.unknown = -shrink * along;
  result.error = error - by_unknown * (root * along);
  const Eigen::Matrix<double, 1, Columns> projected = root * (by_unknown.transpose() * by_pose);
  result.by_pose = by_pose - by_unknown * projected;
}

struct EliminatedQuad {
  WithoutUnknown<3, 6> reprojection;
  WithoutUnknown<2, 3> direction;
};

/// \param depth depth unknown of the quad \returns false for a point that is not in front of the current left camera
bool evaluate(const SampleTerm& term, const PinholeCamera& left, const Eigen::Isometry3d& pose, double depth,
              EliminatedQuad& result) {
  ReprojectionJacobian position;
  if (!reprojection_jacobian(term.reprojection, left, pose, depth, position)) return false;
  DirectionResidual direction;
  direction_residual(term.direction, pose.linear(), direction);
  // Placed here on purpose: reading values as vectors right after they were written as scalars stalls the processor,
  // which costs 15 % of the whole search.
  eliminate<3, 6>(position.value, position.by_pose, position.by_depth, depth, result.reprojection);
  eliminate<2, 3>(direction.value, direction.by_rotation, direction.by_slope, 0.0, result.direction);
  return true;
}

/// Adds weight * J^T J and weight * J^T e for `Rows` residuals that depend on the first `Columns` unknowns. Written as
/// loops, because the compilation of the equivalent Eigen products takes minutes.
template <int Rows, int Columns>
void add_rows(const WithoutUnknown<Rows, Columns>& block, double weight, Normal<6>& normal) {
  const double *by_unknowns = block.by_pose.data(), *errors = block.error.data();
  for (int c = 0; c < Columns; ++c) {
    for (int k = 0; k < Rows; ++k) {
      const double weighted = weight * by_unknowns[Rows * c + k];
      normal.gradient(c) += weighted * errors[k];
      for (int r = 0; r < Columns; ++r) normal.matrix(r, c) += weighted * by_unknowns[Rows * r + k];
    }
  }
}

}  // namespace

SampleTerm make_sample_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise) {
  return {make_reprojection_term(quads, quad, noise), make_direction_term(quads, quad, noise)};
}

bool fit_sample(const std::vector<SampleTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig,
                const PoseConfig& config, Eigen::Isometry3d& current_from_previous, SampleWorkspace& workspace) {
  if (rows.empty()) return false;
  workspace.depth.assign(rows.size(), 0.0);
  workspace.reprojection_error.assign(rows.size(), 0.0);
  workspace.direction_error.assign(rows.size(), 0.0);
  double reprojection_scale = 1, direction_scale = 1;
  EliminatedQuad quad;
  const auto evaluate_row = [&](std::size_t k) {
    if (!evaluate(terms[static_cast<std::size_t>(rows[k])], rig.left, current_from_previous, workspace.depth[k], quad))
      return false;
    workspace.reprojection_error[k] = quad.reprojection.error.squaredNorm();
    workspace.direction_error[k] = quad.direction.error.squaredNorm();
    workspace.depth[k] = quad.reprojection.unknown;
    return true;
  };
  const auto measure_scales = [&] {
    reprojection_scale =
        measured_scale(workspace.reprojection_error, rows.size(), kReprojectionMedian, workspace.sorted);
    direction_scale = measured_scale(workspace.direction_error, rows.size(), kDirectionMedian, workspace.sorted);
  };
  for (std::size_t k = 0; k < rows.size(); ++k) evaluate_row(k);
  measure_scales();
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    Normal<6> normal;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      if (!evaluate_row(k)) continue;
      const double dof = config.student_dof;
      add_rows(quad.reprojection,
               student_weight(workspace.reprojection_error[k], reprojection_scale, kReprojectionSize, dof) /
                   reprojection_scale,
               normal);
      add_rows(quad.direction,
               student_weight(workspace.direction_error[k], direction_scale, kDirectionSize, dof) / direction_scale,
               normal);
    }
    Vector6d step;
    if (!solve(normal, step)) return false;
    current_from_previous = perturb(step, current_from_previous);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
    measure_scales();
  }
  return true;
}

}  // namespace quadedge::pose
