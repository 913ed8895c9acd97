/// \file covariance.cpp  Cluster-robust factors over image cells of doubling size; the largest inflates the covariance.
#include "motion/covariance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/parallel.hpp"
#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

/// Square cells of an image.
struct CellGrid {
  CellGrid(const PinholeCamera& camera, double side_px)
      : side(side_px), columns(cells(camera.width)), lines(cells(camera.height)) {}

  int cells(double length) const { return static_cast<int>(std::ceil(length / side)) + 1; }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines); }
  /// Index of the cell that contains a position in the image [px]; positions outside belong to the nearest cell.
  std::size_t at(float x, float y) const {
    const auto clamped = [&](float position, int count) {
      return std::clamp(static_cast<int>(static_cast<double>(position) / side), 0, count - 1);
    };
    return static_cast<std::size_t>(clamped(y, lines) * columns + clamped(x, columns));
  }

  double side;  ///< [px]
  int columns, lines;
};

/// Sum of squared gradient contributions over the cells, relative to the value that the normal equations predict.
double squares_factor(const std::vector<Vector6d>& cells, const Matrix6d& inverse) {
  double sum = 0;
  for (const Vector6d& cell : cells) sum += cell.dot(inverse * cell);
  return sum / 6.0;
}

/// The same for cells large enough to pull the fit: each cell's gradient times the change of the pose without the cell
/// (the unbiased CR2 of Bell and McCaffrey). Zero if a cell holds too much of the information to be left out.
double left_out_factor(const std::vector<Vector6d>& gradients, const std::vector<Matrix6d>& normals,
                       const Matrix6d& normal, const Matrix6d& inverse) {
  double sum = 0;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    if (gradients[i].isZero(0)) continue;
    if (inverse.cwiseProduct(normals[i]).sum() > 6.0 * kLargestRatio) return 0;
    sum += gradients[i].dot((normal - normals[i]).ldlt().solve(gradients[i]));
  }
  return sum / 6.0;
}

/// Merges cells into cells of twice the side, which replace them.
template <typename Sum>
void merge(const CellGrid& from, const CellGrid& to, std::vector<Sum>& cells, std::vector<Sum>& larger) {
  larger.assign(to.size(), Sum::Zero());
  for (int line = 0; line < from.lines; ++line)
    for (int column = 0; column < from.columns; ++column)
      larger[static_cast<std::size_t>(line / 2 * to.columns + column / 2)] +=
          cells[static_cast<std::size_t>(line * from.columns + column)];
  std::swap(cells, larger);
}

struct Factors {
  double smallest_cells, largest;
};

/// The factor of the smallest cells, or that without cells if larger; and the largest factor over all sizes, which
/// covers the full extent of the correlation.
Factors cell_factors(const std::vector<std::int32_t>& rows, const QuadObservations& quads, const PinholeCamera& camera,
                     double cell_side, const CovarianceSums& sums, const Matrix6d& inverse,
                     CovarianceWorkspace& workspace) {
  const double freedom =
      sums.used / std::max(sums.used - 2.0, 1.0);  // six parameters absorb the residuals of two quads
  CellGrid grid(camera, cell_side);
  auto& cells = workspace.cells;
  auto& normals = workspace.normals;
  cells.assign(grid.size(), Vector6d::Zero());
  normals = sums.cell_normal;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = static_cast<std::size_t>(rows[k]);
    cells[grid.at(quads.scoring.left_x[i], quads.scoring.left_y[i])] += workspace.gradients[k];
  }
  Factors result{};
  result.largest = freedom * inverse.cwiseProduct(sums.gradient_squares).sum() / 6.0;
  for (int size = 0; size < kCellSizes; ++size) {
    if (size > 0) {
      const CellGrid next(camera, 2 * grid.side);
      merge(grid, next, cells, workspace.larger_cells);
      if (size > kLeftOut) merge(grid, next, normals, workspace.larger_normals);
      grid = next;
    }
    const double factor = size < kLeftOut ? freedom * squares_factor(cells, inverse)
                                          : left_out_factor(cells, normals, sums.normal, inverse);
    result.largest = std::max(result.largest, factor);
    if (size == 0) result.smallest_cells = result.largest;
  }
  return result;
}

/// Sums over all quads; their gradients are stored in the workspace.
void add_up(const ReprojectionTerms& terms, const std::vector<std::int32_t>& rows, const ScoringArrays& quads,
            const CellGrid& left_out, const Evaluation& at, CovarianceWorkspace& workspace) {
  workspace.zero.cell_normal.assign(left_out.size(), Matrix6d::Zero());
  workspace.gradients.resize(rows.size());
  const double scale = at.weights.scale, dof = at.weights.dof;
  CovarianceSums& sums = workspace.total;
  sum_row_blocks(rows.size(), workspace.zero, workspace.blocks, sums,
                 [&](std::size_t begin, std::size_t end, CovarianceSums& sum) {
                   LaneContributions lanes;
                   for (std::size_t k = begin; k < end; ++k) {
                     const std::size_t lane = k % kLanes;
                     if (lane == 0) contributions_by_pose(terms, at, k, lanes);
                     const Vector6d gradient = lanes.gradient(lane);
                     workspace.gradients[k] = gradient;
                     const std::size_t i = static_cast<std::size_t>(rows[k]);
                     sum.cell_normal[left_out.at(quads.left_x[i], quads.left_y[i])] += lanes.matrix(lane);
                     sum.gradient_squares += gradient * gradient.transpose();
                     const double weight = student_weight(terms.error[k], scale, kReprojectionSize, dof);
                     sum.weights += weight;
                     sum.curvature += weight * (1.0 - 2.0 * weight * terms.error[k] /
                                                          (scale * kReprojectionSize * (dof + kReprojectionSize)));
                     sum.used += 1;
                   }
                 });
  for (const Matrix6d& cell : sums.cell_normal) sums.normal += cell;
}

}  // namespace

MeasuredCovariance measure_covariance(const ReprojectionTerms& terms, const std::vector<std::int32_t>& rows,
                                      const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                                      const Eigen::Isometry3d& current_from_previous, double offset,
                                      double reprojection_scale, CovarianceWorkspace& workspace) {
  const CellGrid left_out(rig.left, kInflationCell * (1 << kLeftOut));
  const StudentWeights weights{reprojection_scale, config.student_dof};
  add_up(terms, rows, quads.scoring, left_out, Evaluation(current_from_previous, offset, weights), workspace);
  const CovarianceSums& sums = workspace.total;

  // The normal equations use the weights w; the curvature of the Student-t cost is smaller, by the ratio of the mean of
  // d(w e)/de to that of w.
  const Matrix6d inverse = sums.normal.ldlt().solve(Matrix6d::Identity());
  const double flattening = std::max(sums.curvature / sums.weights, 1.0 / kReprojectionSize);
  const Factors factors = cell_factors(rows, quads, rig.left, kInflationCell, sums, inverse, workspace);
  return {inverse, factors.largest / (flattening * flattening), factors.smallest_cells / (flattening * flattening)};
}

}  // namespace quadedge::pose
