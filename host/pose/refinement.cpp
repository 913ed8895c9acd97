#include "pose/refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "pose/angles.hpp"
#include "pose/row_blocks.hpp"

namespace quadedge::pose {

namespace {

constexpr double kPlaceSize = 3, kDirectionSize = 2;  ///< residuals per block
/// Medians of the chi-squared distribution with 3 and 2 degrees of freedom.
constexpr double kPlaceMedian = 2.3659738843753377, kDirectionMedian = 1.3862943611198906;
/// Variances are not believed to be smaller than this share of the assumed ones (noise-free data).
constexpr double kSmallestScale = 1e-6;
/// About so many quads settle which ones are inliers.
constexpr std::size_t kScoutingQuads = 4000;
/// A scale is the median of about so many errors.
constexpr std::size_t kScaleErrors = 4000;
/// A selection that differs from the last one in less than one row of so many calls for no further fit.
constexpr std::size_t kSameSelection = 500;
/// Cells whose errors may be alike: from one vote cell, doubled so often. From `kLeftOut` on, what the fit has taken from a cell counts.
constexpr int kCellSizes = 5, kLeftOut = 2;
/// A cell that holds more than this share of the information cannot be left out.
constexpr double kLargestShare = 0.5;
/// Smallest ratio of the normal equations' pivots, after scaling their diagonal to one, that counts as solvable.
constexpr double kSmallestPivot = 1e-12;

/// A block of residuals whose own unknown, with a standard normal prior, has been eliminated: error^T error is the block's cost.
template <int Rows, int Columns>
struct Eliminated {
  Eigen::Matrix<double, Rows, 1> error;
  Eigen::Matrix<double, Rows, Columns> by_pose;
  double unknown = 0;  ///< its best value
};

/// Minimises |r + h (z - at)|^2 + z^2 over z. With S = I + h h^T the cost is e^T S^-1 e, e = r - h at; multiplying by S^-1/2 leaves
/// a plain sum of squares.
template <int Rows, int Columns>
void eliminate(const Eigen::Matrix<double, Rows, 1>& residual, const Eigen::Matrix<double, Rows, Columns>& by_pose,
               const Eigen::Matrix<double, Rows, 1>& by_unknown, double at, Eliminated<Rows, Columns>& result) {
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

/// Columns of `place`: pose, then the offset of all disparities.
struct QuadTerms {
  Eliminated<3, 7> place;
  Eliminated<2, 3> direction;
};

bool evaluate(const FitTerm& term, const PinholeCamera& left, const Eigen::Isometry3d& pose, double offset, double depth,
              Residuals residuals, QuadTerms& result) {
  Linearisation linear;
  if (!linearise(term, left, pose, depth, linear)) return false;
  Eigen::Matrix<double, 3, 7> by_all;
  by_all << linear.place_by_pose, linear.place_by_offset;
  eliminate<3, 7>(linear.place + linear.place_by_offset * offset, by_all, linear.place_by_depth, depth, result.place);
  if (residuals == Residuals::places_and_directions)
    eliminate<2, 3>(linear.direction, linear.direction_by_rotation, linear.direction_by_slope, 0.0, result.direction);
  return true;
}

/// Weight of the Student-t distribution for a block of `size` residuals with squared error `error` at variance `scale`.
double student_weight(double error, double scale, double size, double dof) { return (dof + size) / (dof + error / scale); }

double place_weight(const FitWorkspace& workspace, double error, const PoseConfig& config) {
  return student_weight(error, workspace.place_scale, kPlaceSize, config.student_dof) / workspace.place_scale;
}
double direction_weight(const FitWorkspace& workspace, double error, const PoseConfig& config) {
  return student_weight(error, workspace.direction_scale, kDirectionSize, config.student_dof) / workspace.direction_scale;
}

double measured_scale(const std::vector<double>& errors, double median_of_one, std::vector<double>& sorted) {
  const std::size_t every = std::max<std::size_t>(1, errors.size() / kScaleErrors);
  sorted.clear();
  for (std::size_t k = 0; k < errors.size(); k += every) sorted.push_back(errors[k]);
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return std::max(*middle / median_of_one, kSmallestScale);
}

/// Gauss-Newton's normal equations.
template <int Size>
struct Normal {
  Eigen::Matrix<double, Size, Size> matrix = Eigen::Matrix<double, Size, Size>::Zero();
  Eigen::Matrix<double, Size, 1> gradient = Eigen::Matrix<double, Size, 1>::Zero();

  Normal& operator+=(const Normal& other) {
    matrix += other.matrix;
    gradient += other.gradient;
    return *this;
  }
  /// Adds weight * J^T J and weight * J^T e of `Rows` residuals that depend on the first `Columns` unknowns. Plain loops: as Eigen
  /// products this function takes minutes to compile.
  template <int Rows, int Columns>
  void add_rows(const double* by_unknowns, const double* errors, double weight) {
    for (int c = 0; c < Columns; ++c) {
      for (int k = 0; k < Rows; ++k) {
        const double weighted = weight * by_unknowns[Rows * c + k];
        gradient(c) += weighted * errors[k];
        for (int r = 0; r < Columns; ++r) matrix(r, c) += weighted * by_unknowns[Rows * r + k];
      }
    }
  }
  void add_place(const QuadTerms& quad, double weight) { add_rows<3, Size>(quad.place.by_pose.data(), quad.place.error.data(), weight); }
  void add_direction(const QuadTerms& quad, double weight) {
    add_rows<2, 3>(quad.direction.by_pose.data(), quad.direction.error.data(), weight);
  }
};

/// Evaluates all rows and adds to `zero` what `each(k, terms, sum)` makes of those in front of the camera; rows run on all processors.
template <typename Sum, typename Each>
Sum sweep(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const PinholeCamera& left,
          const Eigen::Isometry3d& pose, double offset, const std::vector<double>& depth, Residuals residuals, const Sum& zero,
          const Each& each) {
  return sum_row_blocks(rows.size(), zero, [&](std::size_t begin, std::size_t end, Sum& sum) {
    QuadTerms quad;
    for (std::size_t k = begin; k < end; ++k)
      if (evaluate(terms[static_cast<std::size_t>(rows[k])], left, pose, offset, depth[k], residuals, quad)) each(k, quad, sum);
  });
}

/// Square cells of an image.
struct CellGrid {
  CellGrid(const PinholeCamera& camera, double side_px)
      : side(side_px), columns(cells(camera.width)), lines(cells(camera.height)) {}

  int cells(double length) const { return static_cast<int>(std::ceil(length / side)) + 1; }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines); }
  /// Of a place in the image [px]; places outside belong to the nearest cell.
  std::size_t at(float x, float y) const {
    const auto clamped = [&](float place, int count) {
      return std::clamp(static_cast<int>(static_cast<double>(place) / side), 0, count - 1);
    };
    return static_cast<std::size_t>(clamped(y, lines) * columns + clamped(x, columns));
  }

  double side;  ///< px
  int columns, lines;
};

/// What the covariance is made of.
struct CovarianceSums {
  Matrix6d normal = Matrix6d::Zero(), scatter = Matrix6d::Zero();
  double weights = 0, curvature = 0, used = 0;
  std::vector<Matrix6d> cell_normal;  ///< the part of `normal` from each of the smallest cells that are left out

  CovarianceSums& operator+=(const CovarianceSums& other) {
    normal += other.normal;
    scatter += other.scatter;
    weights += other.weights;
    curvature += other.curvature;
    used += other.used;
    for (std::size_t i = 0; i < cell_normal.size(); ++i) cell_normal[i] += other.cell_normal[i];
    return *this;
  }
};

/// Sum over the cells of the squares of gradient contributions, over what the normal equations expect of it.
double scatter_factor(const std::vector<Vector6d>& cells, const Matrix6d& inverse) {
  double sum = 0;
  for (const Vector6d& cell : cells) sum += cell.dot(inverse * cell);
  return sum / 6.0;
}

/// The same for cells large enough to draw the fit to themselves: by how much the pose changes when each cell in turn is left out
/// (jackknife). Zero where a cell holds too much of the information to be left out.
double jackknife_factor(const std::vector<Vector6d>& gradients, const std::vector<Matrix6d>& normals, const Matrix6d& normal,
                        const Matrix6d& inverse) {
  double sum = 0;
  for (std::size_t i = 0; i < gradients.size(); ++i) {
    if (gradients[i].isZero(0)) continue;
    if (inverse.cwiseProduct(normals[i]).sum() > 6.0 * kLargestShare) return 0;
    const Vector6d change = (normal - normals[i]).ldlt().solve(gradients[i]);
    sum += change.dot(normal * change);
  }
  return sum / 6.0;
}

/// Adds up the cells of `from` into the cells of twice the side.
template <typename Sum>
std::vector<Sum> merged(const std::vector<Sum>& cells, const CellGrid& from, const CellGrid& to) {
  std::vector<Sum> result(to.size(), Sum::Zero());
  for (int line = 0; line < from.lines; ++line)
    for (int column = 0; column < from.columns; ++column)
      result[static_cast<std::size_t>(line / 2 * to.columns + column / 2)] += cells[static_cast<std::size_t>(line * from.columns + column)];
  return result;
}

struct Factors {
  double smallest_cells, largest;
};

/// Factor with the smallest cells, or with none where that is larger; and the largest one of all sizes, at which the errors' likeness has
/// been seen whole.
/// \param gradients of the quads `rows`
Factors cell_factors(const std::vector<Vector6d>& gradients, const std::vector<std::int32_t>& rows, const QuadObservations& quads,
                     const PinholeCamera& camera, double cell_side, const CovarianceSums& sums, const Matrix6d& inverse) {
  const double freedom = sums.used / std::max(sums.used - 2.0, 1.0);  // six parameters take the residuals of two quads
  CellGrid grid(camera, cell_side);
  std::vector<Vector6d> cells(grid.size(), Vector6d::Zero());
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t i = static_cast<std::size_t>(rows[k]);
    cells[grid.at(quads.scoring.left_x[i], quads.scoring.left_y[i])] += gradients[k];
  }
  std::vector<Matrix6d> normals = sums.cell_normal;
  Factors result{};
  result.largest = freedom * inverse.cwiseProduct(sums.scatter).sum() / 6.0;
  for (int size = 0; size < kCellSizes; ++size) {
    if (size > 0) {
      const CellGrid next(camera, 2 * grid.side);
      cells = merged(cells, grid, next);
      if (size > kLeftOut) normals = merged(normals, grid, next);
      grid = next;
    }
    const double factor =
        size < kLeftOut ? freedom * scatter_factor(cells, inverse) : jackknife_factor(cells, normals, sums.normal, inverse);
    result.largest = std::max(result.largest, factor);
    if (size == 0) result.smallest_cells = result.largest;
  }
  return result;
}

struct Nothing {
  Nothing& operator+=(const Nothing&) { return *this; }
};

/// How many rows only one of two ascending lists has.
std::size_t changed_rows(const std::vector<std::int32_t>& a, const std::vector<std::int32_t>& b) {
  std::vector<std::int32_t> changed;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(changed));
  return changed.size();
}

/// Solves A x = -g; false where A is singular.
template <int Size>
bool solve(const Eigen::Matrix<double, Size, Size>& a, const Eigen::Matrix<double, Size, 1>& gradient,
           Eigen::Matrix<double, Size, 1>& step) {
  const Eigen::Matrix<double, Size, 1> diagonal = a.diagonal();
  if (!(diagonal.minCoeff() > 0)) return false;
  const Eigen::Matrix<double, Size, 1> scale = diagonal.cwiseSqrt().cwiseInverse();
  const Eigen::Matrix<double, Size, Size> scaled = scale.asDiagonal() * a * scale.asDiagonal();
  const Eigen::LDLT<Eigen::Matrix<double, Size, Size>> factors(scaled);
  if (factors.info() != Eigen::Success || !(factors.vectorD().minCoeff() > kSmallestPivot)) return false;
  step = scale.asDiagonal() * factors.solve(-(scale.asDiagonal() * gradient));
  return step.allFinite();
}

}  // namespace

Eigen::Isometry3d perturb(const Vector6d& step, const Eigen::Isometry3d& current_from_previous) {
  const Eigen::Vector3d w = step.head<3>();
  const double angle = w.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (angle > 0) turn = Eigen::Quaterniond(Eigen::AngleAxisd(angle, w / angle));
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  // Through a unit quaternion, so that many steps cannot wear the rotation's orthonormality away.
  result.linear() = (turn * Eigen::Quaterniond(current_from_previous.linear())).normalized().toRotationMatrix();
  result.translation() = turn * current_from_previous.translation() + step.tail<3>();
  return result;
}

void mask_to_rows(const std::vector<std::uint8_t>& mask, std::vector<std::int32_t>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) rows.push_back(static_cast<std::int32_t>(i));
}

bool fit(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig, const PoseConfig& config,
         Residuals residuals, Eigen::Isometry3d& current_from_previous, FitWorkspace& workspace) {
  const bool directions = residuals == Residuals::places_and_directions;
  if (rows.empty()) return false;
  workspace.depth.assign(rows.size(), 0.0);
  workspace.place_error.assign(rows.size(), 0.0);
  workspace.direction_error.assign(rows.size(), 0.0);
  const auto store = [&](std::size_t k, const QuadTerms& quad) {
    workspace.place_error[k] = quad.place.error.squaredNorm();
    if (directions) workspace.direction_error[k] = quad.direction.error.squaredNorm();
    workspace.depth[k] = quad.place.unknown;
  };
  const auto measure_scales = [&] {
    workspace.place_scale = measured_scale(workspace.place_error, kPlaceMedian, workspace.sorted);
    if (directions) workspace.direction_scale = measured_scale(workspace.direction_error, kDirectionMedian, workspace.sorted);
  };
  if (!workspace.knows_scales) {
    sweep(terms, rows, rig.left, current_from_previous, 0, workspace.depth, residuals, Nothing(),
          [&](std::size_t k, const QuadTerms& quad, Nothing&) { store(k, quad); });
    measure_scales();
  }

  for (int iteration = 0; iteration < config.fit_steps; ++iteration) {
    const auto normal = sweep(terms, rows, rig.left, current_from_previous, 0, workspace.depth, residuals, Normal<6>(),
                              [&](std::size_t k, const QuadTerms& quad, Normal<6>& sum) {
                                store(k, quad);
                                sum.add_place(quad, place_weight(workspace, workspace.place_error[k], config));
                                if (directions) sum.add_direction(quad, direction_weight(workspace, workspace.direction_error[k], config));
                              });
    Vector6d step;
    if (!solve<6>(normal.matrix, normal.gradient, step)) return false;
    current_from_previous = perturb(step, current_from_previous);
    if (-normal.gradient.dot(step) < config.fit_tolerance * config.fit_tolerance) break;
    measure_scales();
  }
  return true;
}

Scatter measure_scatter(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const QuadObservations& quads,
                        const StereoRig& rig, const PoseConfig& config, const Eigen::Isometry3d& current_from_previous, double offset,
                        const FitWorkspace& workspace) {
  const CellGrid left_out(rig.left, config.vote_cell * (1 << kLeftOut));
  CovarianceSums zero;
  zero.cell_normal.assign(left_out.size(), Matrix6d::Zero());
  std::vector<Vector6d> gradients(rows.size(), Vector6d::Zero());
  CovarianceSums sums = sweep(
      terms, rows, rig.left, current_from_previous, offset, workspace.depth, Residuals::places, zero,
      [&](std::size_t k, const QuadTerms& quad, CovarianceSums& sum) {
        const double error = quad.place.error.squaredNorm();
        const double weight = student_weight(error, workspace.place_scale, kPlaceSize, config.student_dof);
        Normal<6> own;
        own.add_place(quad, weight / workspace.place_scale);
        gradients[k] = own.gradient;
        const std::size_t i = static_cast<std::size_t>(rows[k]);
        sum.cell_normal[left_out.at(quads.scoring.left_x[i], quads.scoring.left_y[i])] += own.matrix;
        sum.scatter += own.gradient * own.gradient.transpose();
        sum.weights += weight;
        sum.curvature += weight * (1.0 - 2.0 * weight * error / (workspace.place_scale * kPlaceSize * (config.student_dof + kPlaceSize)));
        sum.used += 1;
      });
  for (const Matrix6d& cell : sums.cell_normal) sums.normal += cell;

  // The normal equations hold the weights; the curvature of the Student-t cost is smaller by the mean of d(w e)/de over w.
  const Matrix6d inverse = sums.normal.ldlt().solve(Matrix6d::Identity());
  const double flattening = std::max(sums.curvature / sums.weights, 1.0 / kPlaceSize);
  const Factors factors = cell_factors(gradients, rows, quads, rig.left, config.vote_cell, sums, inverse);
  return {inverse, factors.largest / (flattening * flattening), factors.smallest_cells / (flattening * flattening)};
}

bool fit_offset(const std::vector<FitTerm>& terms, const std::vector<std::int32_t>& rows, const StereoRig& rig, const PoseConfig& config,
                const Scatter& scatter, double variance, FitWorkspace& workspace, OffsetFit& result) {
  using Matrix7d = Eigen::Matrix<double, 7, 7>;
  using Vector7d = Eigen::Matrix<double, 7, 1>;
  Eigen::Isometry3d pose = result.current_from_previous;
  double offset = result.offset;
  for (int iteration = 0; iteration < config.fit_steps; ++iteration) {
    auto sums = sweep(terms, rows, rig.left, pose, offset, workspace.depth, Residuals::places, Normal<7>(),
                      [&](std::size_t k, const QuadTerms& quad, Normal<7>& sum) {
                        sum.add_place(quad, place_weight(workspace, quad.place.error.squaredNorm(), config));
                        workspace.depth[k] = quad.place.unknown;
                      });
    Matrix7d& normal = sums.matrix;
    Vector7d& gradient = sums.gradient;
    const double weight = std::max(scatter.weight_factor, 1.0);
    normal /= weight;
    gradient /= weight;
    Matrix7d spread = normal * (std::max(scatter.factor, 1.0) / weight);  // of the gradient
    normal(6, 6) += 1.0 / variance;
    spread(6, 6) += 1.0 / variance;
    gradient(6) += offset / variance;
    Vector7d step;
    if (!solve<7>(normal, gradient, step)) return false;
    pose = perturb(step.head<6>(), pose);
    offset += step(6);
    const Matrix7d inverse = normal.ldlt().solve(Matrix7d::Identity());
    result.covariance = inverse * spread * inverse;
    result.offset_variance = inverse(6, 6);
    if (-gradient.dot(step) < config.fit_tolerance * config.fit_tolerance) break;
  }
  result.covariance = (0.5 * (result.covariance + result.covariance.transpose())).eval();
  result.current_from_previous = pose;
  result.offset = offset;
  return true;
}

Refined refine(const std::vector<FitTerm>& terms, const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
               const Eigen::Isometry3d& initial, double offset_variance) {
  Refined result;
  result.current_from_previous = initial;
  FitWorkspace workspace;
  std::vector<std::int32_t> rows, last_rows;
  const double angle = radians(config.inlier_orientation);
  // Every n-th quad finds the pose, all of them make it exact.
  const std::size_t every = std::max<std::size_t>(1, quads.size() / kScoutingQuads);
  const auto select = [&](std::size_t step) {
    select_inliers(quads.scoring, LaterCameras(rig, result.current_from_previous), config.inlier_distance, angle, result.inlier);
    rows.clear();
    for (std::size_t i = 0; i < result.inlier.size(); i += step)
      if (result.inlier[i] != 0) rows.push_back(static_cast<std::int32_t>(i));
  };
  const auto fit_selected = [&] {
    Eigen::Isometry3d candidate = result.current_from_previous;
    result.solved = fit(terms, rows, rig, config, Residuals::places, candidate, workspace);
    if (result.solved) result.current_from_previous = candidate;
    std::swap(rows, last_rows);
    return result.solved;
  };
  for (int round = 0; round < config.refine_rounds; ++round) {
    select(every);
    if (round > 0 && changed_rows(rows, last_rows) <= rows.size() / kSameSelection) break;
    if (!fit_selected()) break;
  }
  // With the offset the last fit comes at once.
  const bool by_part = every > 1;
  if (result.solved && by_part) {
    select(1);
    workspace.knows_scales = true;
    if (offset_variance > 0) {
      std::swap(rows, last_rows);
      workspace.depth.assign(last_rows.size(), 0.0);
    } else {
      fit_selected();
    }
  }
  if (result.solved) {
    const auto measure = [&](double offset) {
      return measure_scatter(terms, last_rows, quads, rig, config, result.current_from_previous, offset, workspace);
    };
    OffsetFit both;
    both.current_from_previous = result.current_from_previous;
    // An offset that is not yet in the disparities would pass for errors that are alike: it is found first, weighed afterwards.
    if (offset_variance > 0 && fit_offset(terms, last_rows, rig, config, Scatter(), offset_variance, workspace, both)) {
      result.current_from_previous = both.current_from_previous;
      fit_offset(terms, last_rows, rig, config, measure(both.offset), offset_variance, workspace, both);
      result.current_from_previous = both.current_from_previous;
      result.covariance = both.covariance.topLeftCorner<6, 6>();
      result.offset = both.offset;
      result.offset_variance = both.offset_variance;
    } else {
      if (offset_variance > 0 && by_part) {
        std::swap(rows, last_rows);
        fit_selected();
      }
      result.covariance = measure(0).covariance();
    }
  }
  result.inliers =
      select_inliers(quads.scoring, LaterCameras(rig, result.current_from_previous), config.inlier_distance, angle, result.inlier);
  return result;
}

}  // namespace quadedge::pose
