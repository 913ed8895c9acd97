#pragma once
/// \file reprojection_terms.hpp  Normal equations of many quads' reprojection residuals, several quads at once.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "pose/least_squares.hpp"
#include "pose/normal_contribution.hpp"
#include "pose/quads.hpp"

namespace quadedge::pose {

/// Quads that are computed at once; columns are padded with rows of zeros, which add nothing to any sum.
constexpr std::size_t kLanes = 8;

/// Many ReprojectionTerms as a structure of arrays, one row per quad, and each quad's own unknown.
class ReprojectionTerms {
 public:
  static constexpr std::size_t kColumns = 16;  ///< the members of ReprojectionTerm in their order

  /// Takes the terms of the quads `rows`; per_ray_unit(); their own unknowns start at zero.
  /// \param scale see NoiseModel::along_in_time()
  void assign(const QuadObservations& quads, const std::vector<std::int32_t>& rows, const PinholeCamera& left,
              const NoiseModel& noise, double scale = 1.0);

  std::size_t size() const { return size_; }
  /// With the rows of zeros at the end.
  std::size_t padded_size() const { return (size_ + kLanes - 1) / kLanes * kLanes; }
  const double* column(std::size_t which) const { return columns_[which].data(); }

  std::vector<double> depth;  ///< each quad's own unknown, see reprojection_residual()
  std::vector<double> error;  ///< squared Mahalanobis errors; of a quad behind the camera the last one

 private:
  std::array<std::vector<double>, kColumns> columns_;
  std::size_t size_ = 0;
};

/// Normal equations by (rotation [rad], translation [m]) of a left perturbation of current_from_previous, of all terms
/// at a pose and with `offset` [px] added to all disparities; each quad's own depth is eliminated in closed form and
/// its `depth` and `error` are renewed.
Normal<6> normal_by_pose(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                         const StudentWeights& weights);

/// The same with the offset as seventh unknown.
Normal<7> normal_by_pose_and_offset(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous,
                                    double offset, const StudentWeights& weights);

/// What each of kLanes quads alone contributes to normal_by_pose().
using LaneContributions = Contributions<kPoseValues, kLanes>;

/// Of the quads first .. first + kLanes - 1, zeros beyond the last one. Leaves `depth` and `error` of the terms as they
/// are.
void contributions_by_pose(const ReprojectionTerms& terms, const Evaluation& at, std::size_t first,
                           LaneContributions& result);

}  // namespace quadedge::pose
