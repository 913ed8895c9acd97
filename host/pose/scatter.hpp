#pragma once
/// \file scatter.hpp  How far the errors of quads scatter, and the covariance of a pose that least squares has found
/// from them.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "pose/place_terms.hpp"

namespace quadedge::pose {

/// What the covariance is made of, in sums over quads.
struct ScatterSums {
  Matrix6d normal = Matrix6d::Zero(), scatter = Matrix6d::Zero();
  double weights = 0, curvature = 0, used = 0;
  std::vector<Matrix6d> cell_normal;  ///< the part of `normal` from each of the smallest cells that are left out

  ScatterSums& operator+=(const ScatterSums& other) {
    normal += other.normal;
    scatter += other.scatter;
    weights += other.weights;
    curvature += other.curvature;
    used += other.used;
    for (std::size_t i = 0; i < cell_normal.size(); ++i) cell_normal[i] += other.cell_normal[i];
    return *this;
  }
};

/// Buffers of measure_scatter(), kept between calls.
struct ScatterWorkspace {
  std::vector<Vector6d> gradients;                ///< one per quad
  std::vector<Vector6d> cells, larger_cells;      ///< sums of gradients
  std::vector<Matrix6d> normals, larger_normals;  ///< what the cells add to the normal equations
  ScatterSums zero, total;
  std::vector<ScatterSums> blocks;
};

/// How well quads tell a pose.
struct Scatter {
  Matrix6d inverse =
      Matrix6d::Zero();  ///< of the normal equations: the covariance if errors were independent and as large as assumed
  double factor = 1;     ///< by how much the errors' scatter is larger
  double weight_factor = 1;  ///< the same for errors alike within the smallest cells only

  Matrix6d covariance() const { return 0.5 * factor * (inverse + inverse.transpose()); }
};

/// Scatter of a pose that refine() or fit_offset() has found with the same terms. Its covariance:
/// (rotation [rad^2], translation [m^2]) of a left perturbation in the current left frame.
///
/// The factor is measured: it says how much more the gradient's contributions scatter than the normal equations expect.
/// Dense edges come in rows of about two per pixel whose errors are alike, and some errors are alike along a whole
/// cable or over a surface. So contributions of quads within one square cell are added up before they are squared:
/// errors that agree within a cell then count once, however many edges tell of them, and independent errors count
/// fully. Cells have sides of config.inflation_cell px and two, four, eight and sixteen times that; the largest factor
/// is taken, the one without cells included. The three larger sizes take part as a jackknife, the squared changes of
/// the pose when each cell in turn is left out: plain sums over few cells come out too small, since the fit has adapted
/// to each of them. A size with a cell that holds half of all information tells nothing and is skipped. What is alike
/// over the whole image shows at no size. \param rows the quads of `terms`, their places tell the cells \param offset
/// of all disparities that was found with the pose [px] \param place_scale variance of the places' errors over the
/// assumed one
Scatter measure_scatter(const PlaceTerms& terms, const std::vector<std::int32_t>& rows, const QuadObservations& quads,
                        const StereoRig& rig, const PoseConfig& config, const Eigen::Isometry3d& current_from_previous,
                        double offset, double place_scale, ScatterWorkspace& workspace);

}  // namespace quadedge::pose
