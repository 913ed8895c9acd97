#pragma once
/// \file place_terms.hpp  The places of many quads for least squares: FitTerm's place as a structure of arrays, and
/// sums over it.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "pose/least_squares.hpp"
#include "pose/quads.hpp"
#include "pose/residuals.hpp"

namespace quadedge::pose {

/// Rows that are computed at once; columns are padded with rows of zeros, which add nothing to any sum.
constexpr std::size_t kPlaceLanes = 8;

/// What the places of quads say, one row per quad; see FitTerm for the meaning of the columns.
class PlaceTerms {
 public:
  enum Column {
    ray_x,
    ray_y,
    inverse_depth,
    inverse_depth_sigma,
    inverse_depth_per_pixel,
    inverse_depth_bar_per_pixel,
    place_x,
    place_y,
    across_x,
    across_y,
    along_x,
    along_y,  ///< times the focal lengths: per unit of a ray, not per pixel
    inverse_depth_bar,
    inverse_depth_bar_weight,
    kColumns
  };

  /// Takes the places of the quads `rows`; their own unknowns start at zero.
  void assign(const QuadObservations& quads, const std::vector<std::int32_t>& rows, const PinholeCamera& left,
              const NoiseModel& noise);

  std::size_t size() const { return size_; }
  /// With the rows of zeros at the end.
  std::size_t padded_size() const { return (size_ + kPlaceLanes - 1) / kPlaceLanes * kPlaceLanes; }
  const double* column(Column which) const { return columns_[which].data(); }

  std::vector<double> depth;  ///< each quad's own unknown, see linearise()
  std::vector<double> error;  ///< squared Mahalanobis errors; of a quad behind the camera the last one

 private:
  std::array<std::vector<double>, kColumns> columns_;
  std::size_t size_ = 0;
};

/// How errors are weighed.
struct StudentWeights {
  double scale = 1;  ///< variance over the assumed one
  double dof = 5;
};

/// Normal equations by (rotation, translation) of a left perturbation of current_from_previous, of all terms at a pose
/// and with `offset` [px] added to all disparities; each quad's own depth is eliminated in closed form and its `depth`
/// and `error` are renewed.
Normal<6> normal_by_pose(PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                         const StudentWeights& weights);

/// The same with the offset as seventh unknown.
Normal<7> normal_by_pose_and_offset(PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                                    const StudentWeights& weights);

/// What each of kPlaceLanes quads alone contributes to normal_by_pose(): upper triangle of the matrix, row by row, then
/// the gradient.
struct PlaceContributions {
  double values[27][kPlaceLanes];

  Matrix6d matrix(std::size_t lane) const;
  Vector6d gradient(std::size_t lane) const;
};
/// Of the quads first .. first + kPlaceLanes - 1, zeros beyond the last one. Leaves `depth` and `error` of the terms as
/// they are.
void contributions_by_pose(const PlaceTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                           const StudentWeights& weights, std::size_t first, PlaceContributions& result);

}  // namespace quadedge::pose
