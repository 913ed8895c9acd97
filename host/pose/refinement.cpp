#include "pose/refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

#include "common/angles.hpp"

namespace quadedge::pose {

namespace {

/// About so many quads settle which ones are inliers.
constexpr std::size_t kScoutingQuads = 4000;
/// A selection that differs from the last one in less than one row of so many calls for no further fit.
constexpr std::size_t kSameSelection = 500;

/// How many rows only one of two ascending lists has.
std::size_t changed_rows(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
  std::size_t changed = 0;
  auto p = a.begin(), q = b.begin();
  while (p != a.end() && q != b.end()) {
    if (*p == *q) {
      ++p;
      ++q;
      continue;
    }
    ++changed;
    if (*p < *q)
      ++p;
    else
      ++q;
  }
  return changed + static_cast<std::size_t>((a.end() - p) + (b.end() - q));
}

void measure_scale(RefinementWorkspace& workspace) {
  workspace.place_scale = measured_scale(workspace.terms.error, workspace.terms.size(), kPlaceMedian, workspace.sorted);
}

/// Gauss-Newton from `current_from_previous`, which it replaces. \returns false when the normal equations have no
/// solution. \param knows_scale place_scale comes from a fit over a part of the same quads and need not be measured
/// before the first step
bool fit_pose(const PoseConfig& config, bool knows_scale, RefinementWorkspace& workspace,
              Eigen::Isometry3d& current_from_previous) {
  PlaceTerms& terms = workspace.terms;
  if (terms.size() == 0) return false;
  if (!knows_scale) {
    normal_by_pose(terms, current_from_previous, 0, {1, config.student_dof});
    measure_scale(workspace);
  }
  for (int iteration = 0; iteration < config.fit_steps; ++iteration) {
    const Normal<6> normal =
        normal_by_pose(terms, current_from_previous, 0, {workspace.place_scale, config.student_dof});
    Vector6d step;
    if (!solve(normal, step)) return false;
    current_from_previous = perturb(step, current_from_previous);
    if (-normal.gradient.dot(step) < config.fit_tolerance * config.fit_tolerance) break;
    measure_scale(workspace);
  }
  return true;
}

}  // namespace

bool fit_offset(const PoseConfig& config, const Scatter& scatter, double variance, RefinementWorkspace& workspace,
                OffsetFit& result) {
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  Eigen::Isometry3d pose = result.current_from_previous;
  double offset = result.offset;
  for (int iteration = 0; iteration < config.fit_steps; ++iteration) {
    Normal<7> normal =
        normal_by_pose_and_offset(workspace.terms, pose, offset, {workspace.place_scale, config.student_dof});
    const double weight = std::max(scatter.weight_factor, 1.0);
    normal.matrix /= weight;
    normal.gradient /= weight;
    Matrix7d spread = normal.matrix * (std::max(scatter.factor, 1.0) / weight);  // of the gradient
    normal.matrix(6, 6) += 1.0 / variance;
    spread(6, 6) += 1.0 / variance;
    normal.gradient(6) += offset / variance;
    Vector7d step;
    if (!solve(normal, step)) return false;
    pose = perturb(step.head<6>(), pose);
    offset += step(6);
    const Matrix7d inverse = normal.matrix.ldlt().solve(Matrix7d::Identity());
    result.covariance = inverse * spread * inverse;
    result.offset_variance = inverse(6, 6);
    if (-normal.gradient.dot(step) < config.fit_tolerance * config.fit_tolerance) break;
  }
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.current_from_previous = pose;
  result.offset = offset;
  return true;
}

Refined refine(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
               const Eigen::Isometry3d& initial, double offset_variance, RefinementWorkspace& workspace,
               std::vector<std::uint8_t>& inlier) {
  Refined result;
  result.current_from_previous = initial;
  auto &rows = workspace.rows, &last_rows = workspace.last_rows;
  const NoiseModel noise(config);
  const double angle = radians(config.inlier_orientation);
  // Every n-th quad finds the pose, all of them make it exact.
  const std::size_t every = std::max<std::size_t>(1, quads.size() / kScoutingQuads);
  const auto select = [&](std::size_t step) {
    select_inliers(quads.scoring, LaterCameras(rig, result.current_from_previous), config.inlier_distance, angle,
                   inlier);
    rows.clear();
    for (std::size_t i = 0; i < inlier.size(); i += step)
      if (inlier[i] != 0) rows.push_back(static_cast<std::int32_t>(i));
  };
  const auto take_selected = [&] {
    std::swap(rows, last_rows);
    workspace.terms.assign(quads, last_rows, rig.left, noise);
  };
  const auto fit_taken = [&](bool knows_scale) {
    Eigen::Isometry3d candidate = result.current_from_previous;
    result.solved = fit_pose(config, knows_scale, workspace, candidate);
    if (result.solved) result.current_from_previous = candidate;
    return result.solved;
  };
  for (int round = 0; round < config.refine_rounds; ++round) {
    select(every);
    if (round > 0 && changed_rows(rows, last_rows) <= rows.size() / kSameSelection) break;
    take_selected();
    if (!fit_taken(round > 0)) break;
  }
  if (result.solved && every > 1) {
    select(1);
    take_selected();
    if (!(offset_variance > 0)) fit_taken(true);  // with the offset the last fit comes at once
  }
  if (result.solved) {
    const auto measure = [&](double offset) {
      return measure_scatter(workspace.terms, last_rows, quads, rig, config, result.current_from_previous, offset,
                             workspace.place_scale, workspace.scatter);
    };
    OffsetFit both;
    both.current_from_previous = result.current_from_previous;
    // An offset that is not yet in the disparities would pass for errors that are alike: it is found first, weighed
    // afterwards.
    if (offset_variance > 0 && fit_offset(config, Scatter(), offset_variance, workspace, both)) {
      result.current_from_previous = both.current_from_previous;
      fit_offset(config, measure(both.offset), offset_variance, workspace, both);
      result.current_from_previous = both.current_from_previous;
      result.covariance = both.covariance.topLeftCorner<6, 6>();
      result.offset = both.offset;
      result.offset_variance = both.offset_variance;
    } else {
      if (offset_variance > 0 && every > 1) fit_taken(true);
      if (result.solved) result.covariance = measure(0).covariance();
    }
  }
  result.inliers = select_inliers(quads.scoring, LaterCameras(rig, result.current_from_previous),
                                  config.inlier_distance, angle, inlier);
  return result;
}

}  // namespace quadedge::pose
