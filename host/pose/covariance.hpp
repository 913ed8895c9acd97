#pragma once
/// \file covariance.hpp  The covariance of a pose that least squares has found, inflated by what the errors of quads
/// have in common (doc/method.md section 6).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/reprojection_terms.hpp"

namespace quadedge::pose {

/// What the covariance is made of, in sums over quads.
struct CovarianceSums {
  Matrix6d normal = Matrix6d::Zero();            ///< matrix of the normal equations
  Matrix6d gradient_squares = Matrix6d::Zero();  ///< outer products of the quads' gradients
  double weights = 0, curvature = 0, used = 0;
  std::vector<Matrix6d> cell_normal;  ///< the part of `normal` from each of the smallest cells that are left out

  CovarianceSums& operator+=(const CovarianceSums& other) {
    normal += other.normal;
    gradient_squares += other.gradient_squares;
    weights += other.weights;
    curvature += other.curvature;
    used += other.used;
    for (std::size_t i = 0; i < cell_normal.size(); ++i) cell_normal[i] += other.cell_normal[i];
    return *this;
  }
};

/// Buffers of measure_covariance(), kept between calls.
struct CovarianceWorkspace {
  std::vector<Vector6d> gradients;                ///< one per quad
  std::vector<Vector6d> cells, larger_cells;      ///< sums of gradients
  std::vector<Matrix6d> normals, larger_normals;  ///< what the cells add to the normal equations
  CovarianceSums zero, total;
  std::vector<CovarianceSums> blocks;
};

/// A pose's covariance as if all quads erred independently and as much as assumed, and by how much they err more.
struct MeasuredCovariance {
  Matrix6d uninflated = Matrix6d::Zero();  ///< inverse of the normal equations
  double inflation = 1;                    ///< factor for errors alike at any size of cells
  double small_cell_inflation = 1;         ///< the same for errors alike within the smallest cells only

  /// (rotation [rad^2], translation [m^2]) of a left perturbation in the current left frame.
  Matrix6d inflated() const { return 0.5 * inflation * (uninflated + uninflated.transpose()); }
};

/// Covariance of a pose that refine() or fit_offset() has found with the same terms.
///
/// Covariance inflation is the factor by which the gradient's contributions scatter more than the normal equations
/// expect; it is measured. Dense edges come in rows of about two per pixel whose errors are alike, and some errors are
/// alike along a whole cable or over a surface. So contributions of quads within one square cell are added up before
/// they are squared: errors that agree within a cell then count once, however many edges tell of them, and independent
/// errors count fully. Cells have sides of config.inflation_cell px and two, four, eight and sixteen times that; the
/// largest factor is taken, the one without cells included. The three larger sizes take part as a jackknife, the
/// squared changes of the pose when each cell in turn is left out: plain sums over few cells come out too small, since
/// the fit has adapted to each of them. A size with a cell that holds half of all information tells nothing and is
/// skipped. What is alike over the whole image shows at no size.
/// \param rows the quads of `terms`, their current left positions tell the cells
/// \param offset of all disparities that was found with the pose [px]
/// \param reprojection_scale variance of the reprojection residuals over the assumed one
MeasuredCovariance measure_covariance(const ReprojectionTerms& terms, const std::vector<std::int32_t>& rows,
                                      const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                                      const Eigen::Isometry3d& current_from_previous, double offset,
                                      double reprojection_scale, CovarianceWorkspace& workspace);

}  // namespace quadedge::pose
