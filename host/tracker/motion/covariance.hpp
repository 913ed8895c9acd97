#pragma once
/// \file covariance.hpp  Covariance of a pose found by least squares, inflated for correlated errors of quads
/// (doc/method.md section 6).

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "motion/reprojection_terms.hpp"

namespace quadedge::pose {

/// Sums over quads from which the covariance is computed.
struct CovarianceSums {
  Matrix6d normal = Matrix6d::Zero();            ///< matrix of the normal equations
  Matrix6d gradient_squares = Matrix6d::Zero();  ///< outer products of the quads' gradients
  double weights = 0, curvature = 0, used = 0;
  std::vector<Matrix6d> cell_normal;  ///< contributions to `normal` of each of the smallest cells that are left out

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
  std::vector<Matrix6d> normals, larger_normals;  ///< contributions of the cells to the normal equations
  CovarianceSums zero, total;
  std::vector<CovarianceSums> blocks;
};

/// Covariance of a pose under the assumption of independent errors of the assumed size, and the measured inflation.
struct MeasuredCovariance {
  Matrix6d uninflated = Matrix6d::Zero();  ///< inverse of the normal equations
  double inflation = 1;                    ///< factor for errors that are correlated within cells of any size
  double small_cell_inflation = 1;         ///< the same for errors that are correlated within the smallest cells only

  /// Covariance (rotation [rad^2], translation [m^2]) of a left perturbation in the current left frame.
  Matrix6d inflated() const { return 0.5 * inflation * (uninflated + uninflated.transpose()); }
};

/// Covariance of a pose that refine() or fit_offset() has found with the same terms.
///
/// The inflation is the measured ratio between the scatter of the gradient contributions and the scatter that the
/// normal equations predict. Dense edges come in rows of about two per pixel with similar errors, and some errors are
/// common to a whole cable or surface. Contributions of quads within one square cell are therefore summed before they
/// are squared: errors that agree within a cell count once, independent errors count in full. Cells have sides of
/// kInflationCell px and two, four, eight and sixteen times that; the largest factor is used, including that
/// without cells. In the three larger sizes, the change of the pose without the cell allows for the fit's adaptation to
/// it (CR2; Bell and McCaffrey, Survey Methodology 28(2), 2002): sums over few cells underestimate the scatter. A size
/// is skipped if one cell holds half of all information. Errors common to the whole image are not visible at any size.
/// \param rows the quads of `terms`; their current left positions define the cells
/// \param offset disparity offset found together with the pose [px]
/// \param reprojection_scale ratio of measured to assumed variance of the reprojection residuals
MeasuredCovariance measure_covariance(const ReprojectionTerms& terms, const std::vector<std::int32_t>& rows,
                                      const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                                      const Eigen::Isometry3d& current_from_previous, double offset,
                                      double reprojection_scale, CovarianceWorkspace& workspace);

}  // namespace quadedge::pose
