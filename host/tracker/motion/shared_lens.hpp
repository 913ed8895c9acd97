#pragma once
/// \file shared_lens.hpp  Focal lengths and distortion that are wrong in both cameras alike. A single pair does not
/// show them: disparities and epipolar lines fit. A scene measured with them is stretched along the optical axis or
/// curved, and what is stretched does not turn as a rigid scene does.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/robust_fit.hpp"
#include "motion/quads.hpp"
#include "quadedge/camera.hpp"
#include "rig/rig_finding.hpp"

namespace quadedge::rig {

/// Gathers from the motions of a recording how far the lenses are off.
class SharedLens {
 public:
  using Fit = RobustFit<14>;
  /// What both calibrations lack: the part by which the true focal lengths are longer, and a radial term by which true
  /// rays lie farther out, 1 + k1 r^2; both with standard deviations.
  struct Error {
    Eigen::Vector2d value = Eigen::Vector2d::Zero(), sigma = Eigen::Vector2d::Zero();
  };

  /// Adds a motion; one that does not turn tells nothing.
  /// \param rig with which the quads were measured \param inlier one byte per quad \param current_from_base left
  /// cameras [m], as its inliers fit best
  void add(const StereoRig& rig, const pose::ScoringArrays& quads, const std::vector<std::uint8_t>& inlier,
           const Eigen::Isometry3d& current_from_base);
  Error error() const;
  /// A finding, once more is off than calibrations leave.
  std::optional<RigFinding> judge() const;

 private:
  static constexpr int kShared = 7;  ///< terms that all motions share
  using SharedTerms = Eigen::Matrix<double, kShared, 1>;
  using Shared = Eigen::Matrix<double, kShared, kShared>;

  static Shared information_before();

  Fit fit_;                         ///< of a motion; kept for its memory
  std::vector<Fit::Row> rows_;      ///< likewise
  Shared normal_ = Shared::Zero();  ///< of all motions
  SharedTerms right_side_ = SharedTerms::Zero();
  int turns_ = 0;
};

}  // namespace quadedge::rig
