#pragma once
/// \file reprojection_terms.hpp  Normal equations of the reprojection residuals of many quads, computed for several
/// quads at once.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "motion/least_squares.hpp"
#include "motion/quads.hpp"

namespace quadedge::pose {

/// Many ReprojectionTerms as a structure of arrays, one row per quad, with the depth unknown of each quad. Columns are
/// padded with zero rows to a multiple of kLanes, which contribute nothing.
class ReprojectionTerms {
 public:
  static constexpr std::size_t kColumns = sizeof(ReprojectionTerm) / sizeof(double);

  /// Sets the terms of the quads `rows` and resets their depth unknowns to zero.
  /// \param scale see NoiseModel::along_in_time()
  void assign(const QuadObservations& quads, const std::vector<std::int32_t>& rows, const PinholeCamera& left,
              const NoiseModel& noise, double scale = 1.0);

  std::size_t size() const { return size_; }
  /// Including the padding.
  std::size_t padded_size() const { return (size_ + kLanes - 1) / kLanes * kLanes; }
  const double* column(std::size_t which) const { return columns_[which].data(); }

  std::vector<double> depth;  ///< depth unknown of each quad, see reprojection_residual()
  std::vector<double> error;  ///< squared Mahalanobis errors; for a quad behind the camera the last value

 private:
  std::array<std::vector<double>, kColumns> columns_;
  std::size_t size_ = 0;
};

/// Normal equations of all terms at a pose, with respect to (rotation [rad], translation [m]) of a left perturbation of
/// current_from_previous, with `offset` [px] added to all disparities. The depth of each quad is eliminated in closed
/// form; `depth` and `error` are updated.
Normal<6> normal_by_pose(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                         const StudentWeights& weights);

/// The same with the offset as seventh unknown.
Normal<7> normal_by_pose_and_offset(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous,
                                    double offset, const StudentWeights& weights);

/// Errors that the calibration leaves in disparities, as quads show them.
struct DisparityErrors {
  double variance = 0;     ///< of the error that a quad's disparities at both times share [px^2]; may be negative
  double information = 0;  ///< of a single quad about that error, beyond its pose and depth [1/px^2]
};

/// The errors that explain by how much the residuals scatter more where a disparity error would show than elsewhere:
/// medians over the half of about a thousand quads that tell most. \param offset [px] as found with the pose
DisparityErrors disparity_errors(const ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous,
                                 double offset);

/// Contributions of each of kLanes quads to normal_by_pose().
using LaneContributions = Contributions<kPoseValues, kLanes>;

/// Contributions of the quads first .. first + kLanes - 1, zero beyond the last one. Does not change `depth` and
/// `error` of the terms.
void contributions_by_pose(const ReprojectionTerms& terms, const Evaluation& at, std::size_t first,
                           LaneContributions& result);

}  // namespace quadedge::pose
