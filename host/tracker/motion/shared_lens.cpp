/// \file shared_lens.cpp  Fits motion and lenses to frames that turn, eliminates the motion, and adds up the rest.
#include "motion/shared_lens.hpp"

#include <algorithm>
#include <cmath>

#include "common/printed.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/least_squares.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

using Fit = SharedLens::Fit;
/// Change of the motion (rotation [rad], translation [m]), of both lenses (see SharedLens::Error), and of all
/// disparities: a polynomial over the image [px], which stands for what the cameras do not share.
using Change = Fit::Terms;
constexpr int kPose = 0, kOffset = 6, kFocal = 7, kLens = 8, kSlope = 9;
constexpr int kMotionOnly = 7;  // the first terms are those of a motion alone

/// The terms of the polynomial but the offset. \param u, v position in the image, -1/2 to 1/2
Eigen::Matrix<double, 5, 1> over_image(double u, double v) {
  return (Eigen::Matrix<double, 5, 1>() << u, v, u * u, u * v, v * v).finished();
}

/// A point as the true lenses show it, for one that the calibration measures; in the left camera's frame [m].
Eigen::Vector3d with_lens(const Eigen::Vector3d& point, double focal, double k1, double baseline) {
  const double x = point.x() / point.z(), y = point.y() / point.z(), right = x - baseline / point.z();
  const auto straight = [k1](double along, double squared) { return along * (1 + k1 * squared); };
  const double squared = x * x + y * y;
  const double disparity = straight(x, squared) - straight(right, right * right + y * y);
  const double z = baseline / std::max(disparity, 1e-9);
  return {z * straight(x, squared), z * straight(y, squared), z * (1 + focal)};
}

/// What a quad shows of a change.
class QuadProjection {
 public:
  QuadProjection(const StereoRig& rig, const pose::ScoringArrays& quads, const Eigen::Isometry3d& current_from_base)
      : rig_(rig),
        quads_(quads),
        motion_(current_from_base),
        nearer_(direction_of_nearer(rig)),
        per_pixel_(1 / (rig.right.fx * rig.baseline())) {}

  /// Distances of the point of a quad from both current edges, across these [px]. \param scale of its inverse depth
  Eigen::Vector2d distances(std::size_t q, const Change& change, double scale = 1) const {
    const double baseline = rig_.baseline(), focal = change[kFocal], k1 = change[kLens];
    const auto added = [&](double x, double y) {
      return change[kOffset] + change.tail<5>().dot(over_image(x / rig_.left.width - 0.5, y / rig_.left.height - 0.5));
    };
    const Eigen::Vector2d before = rig_.left.project(Eigen::Vector3d(quads_.ray_x[q], quads_.ray_y[q], 1));
    const double inverse_depth =
        scale * static_cast<double>(quads_.inverse_depth[q]) + per_pixel_ * added(before.x(), before.y());
    const Eigen::Vector3d base = Eigen::Vector3d(quads_.ray_x[q], quads_.ray_y[q], 1) / std::max(inverse_depth, 1e-6);
    Eigen::Vector3d point = pose::perturb(change.segment<6>(kPose), motion_) * with_lens(base, focal, k1, baseline);
    point.z() /= 1 + focal;
    point = with_lens(point, 0, -k1, baseline);
    const Eigen::Vector2d left = rig_.left.project(point), right = rig_.right.project(rig_.right_from_left * point) -
                                                                   added(quads_.left_x[q], quads_.left_y[q]) * nearer_;
    return {
        quads_.left_cos[q] * (left.y() - quads_.left_y[q]) - quads_.left_sin[q] * (left.x() - quads_.left_x[q]),
        quads_.right_cos[q] * (right.y() - quads_.right_y[q]) - quads_.right_sin[q] * (right.x() - quads_.right_x[q])};
  }

  /// Adds both distances and their derivatives in units of their standard deviations, to which the depth contributes.
  void add(std::size_t q, std::vector<Fit::Row>& rows) const {
    const Eigen::Vector2d at = distances(q, Change::Zero());
    const double noise = kLensDisparitySigma * per_pixel_ / static_cast<double>(quads_.inverse_depth[q]);
    const Eigen::Vector2d by_depth = distances(q, Change::Zero(), 1 + noise) - at;
    Eigen::Matrix<double, 2, Change::RowsAtCompileTime> slope;
    for (int k = 0; k < slope.cols(); ++k) {
      const double step = k == kOffset || k >= kSlope ? 1 : 1e-4;
      slope.col(k) = (distances(q, step * Change::Unit(k)) - at) / step;
    }
    for (int side = 0; side < 2; ++side) {
      const double sigma = std::hypot(kLensEdgeSigma, by_depth[side]);
      rows.push_back({-at[side] / sigma, slope.row(side).transpose() / sigma});
    }
  }

 private:
  const StereoRig& rig_;
  const pose::ScoringArrays& quads_;
  const Eigen::Isometry3d& motion_;
  Eigen::Vector2d nearer_;
  double per_pixel_;  ///< inverse depth per pixel of disparity [1/(m px)]
};

}  // namespace

void SharedLens::add(const StereoRig& rig, const pose::ScoringArrays& quads, const std::vector<std::uint8_t>& inlier,
                     const Eigen::Isometry3d& current_from_base) {
  if (Eigen::AngleAxisd(current_from_base.linear()).angle() < kLensTurn || turns_++ % kLensEvery != 0) return;
  if (error().sigma[0] < kSettledFocal) return;
  const auto inliers = static_cast<std::size_t>(std::count(inlier.begin(), inlier.end(), 1));
  const std::size_t every = inliers / kLensQuads + 1;
  const QuadProjection projection(rig, quads, current_from_base);
  rows_.clear();
  std::size_t seen = 0;
  for (std::size_t q = 0; q < quads.size(); ++q)
    if (inlier[q] != 0 && seen++ % every == 0) projection.add(q, rows_);
  if (rows_.size() < kLensRows) return;
  fit_.terms.setZero();
  Fit::Matrix prior = Fit::Matrix::Zero();
  prior.bottomRightCorner<kShared, kShared>() = information_before();
  fit_.fit(rows_, 1, prior, Fit::Terms::Zero());
  // What is left of the shared terms once the motion and the offset are eliminated.
  const Eigen::Matrix<double, kShared, kMotionOnly> eliminating =
      fit_.normal.topLeftCorner<kMotionOnly, kMotionOnly>()
          .ldlt()
          .solve(fit_.normal.topRightCorner<kMotionOnly, kShared>())
          .transpose();
  const Shared normal = fit_.normal.bottomRightCorner<kShared, kShared>() -
                        eliminating * fit_.normal.topRightCorner<kMotionOnly, kShared>();
  const SharedTerms right_side = fit_.right_side.tail<kShared>() - eliminating * fit_.right_side.head<kMotionOnly>();
  if (!normal.allFinite() || !right_side.allFinite()) return;
  normal_ += normal / (kLensInflation * kLensInflation);
  right_side_ += right_side / (kLensInflation * kLensInflation);
}

SharedLens::Shared SharedLens::information_before() {
  SharedTerms range = SharedTerms::Constant(kSlopeRange);
  range.head<2>() << kFocalRange, kLensRange;
  return range.cwiseAbs2().cwiseInverse().asDiagonal();
}

SharedLens::Error SharedLens::error() const {
  const Shared covariance = (normal_ + information_before()).inverse();
  return {(covariance * right_side_).head<2>(), covariance.diagonal().head<2>().cwiseSqrt()};
}

std::optional<RigFinding> SharedLens::judge() const {
  const Error found = error();
  const Eigen::Array2d size = found.value.array().abs();
  const auto is_wrong =
      (size > kLensSigmas * found.sigma.array() && size > Eigen::Array2d(kWrongFocal, kWrongLens)).eval();
  if (!is_wrong.any()) return std::nullopt;
  const double excess = -found.value[0] / (1 + found.value[0]);
  const std::string lengths = "both cameras' focal lengths seem to be " + percent(std::abs(excess)) + " too " +
                              (excess > 0 ? "long" : "short"),
                    distortion = printed("both cameras' distortion seems to be wrong, k1 by about %.2f",
                                         std::abs(found.value[1]));
  return RigFinding{{WarningKind::doubtful_lenses,
                     "turns do not fit depths: " + (is_wrong[0] ? lengths : distortion) +
                         "; were the images cropped, scaled, or taken in another sensor mode or under water? Calibrate "
                         "the rig with images like these"}};
}

}  // namespace quadedge::rig
