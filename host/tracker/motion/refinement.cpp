/// \file refinement.cpp  Alternates selection and Gauss-Newton; a Schmidt-Kalman update then learns the offset.
#include "motion/refinement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "motion/pose_constants.hpp"

namespace quadedge::pose {

namespace {

using Matrix7d = Eigen::Matrix<double, 7, 7>;
using Vector7d = Eigen::Matrix<double, 7, 1>;

/// What the quads alone say about the pose and the offset. The pose is eliminated: it follows the offset along the line
/// that the quads leave open.
struct Elimination {
  explicit Elimination(const Matrix7d& information)
      : pose_given_offset(information.topLeftCorner<6, 6>().ldlt().solve(Matrix6d::Identity())),
        pose_by_offset(-pose_given_offset * information.col(6).head<6>()),
        offset(std::max(0.0, information(6, 6) + information.row(6).head<6>().dot(pose_by_offset))) {}

  Matrix6d pose_given_offset;  ///< covariance [rad, m]
  Vector6d pose_by_offset;     ///< derivative [rad/px, m/px]
  double offset;               ///< information about the offset with the pose unknown [1/px^2]
};

/// Variance of the offset due to systematic errors, in units of that due to independent errors. Systematic errors may
/// look like an offset, so that their weights add up as if the pose were known: those of disparities with the
/// information about the offset, those of positions with that about a common shift of the image.
double systematic_ratio(const Matrix7d& information, double focal_length) {
  const double shift = 0.5 * (information(0, 0) + information(1, 1)) / (focal_length * focal_length);
  return kSystematicDisparity * kSystematicDisparity * information(6, 6) +
         kSystematicPosition * kSystematicPosition * shift;
}

/// The update of a Kalman filter whose measurement is the offset by the quads alone, free of the prior, with their
/// error and a multiple of the shared systematic error, which is considered and not estimated (Schmidt's filter).
/// \param free solution of the equations with the prior \param spread see fit_offset()
PoseAndOffset learned_from(const PoseAndOffset& free, const Matrix7d& information, const OffsetPrior& prior,
                           double spread, double focal_length) {
  const Elimination quads(information);
  // All times the information of the quads, which may be 0.
  const double systematic = systematic_ratio(information, focal_length), known = prior.variance * quads.offset;
  const double both = prior.shared * std::sqrt(systematic * quads.offset);
  const double measured = known > 0 ? free.offset * (1 + known) / known : 0, expected = known + 2 * both + systematic;
  // Of a measurement that contradicts the prior, the two frames' images may be displaced against one another.
  const double own = std::max(1 + kOwnSystematic * systematic,
                              measured * measured * quads.offset / (kMostDeviation * kMostDeviation) - expected);
  const double gain = std::clamp((known + both) / (expected + own), 0.0, 1.0);
  const double by_prior = (1 - gain) * (1 - gain) * prior.variance;
  const double by_quads = quads.offset > 0 ? gain * gain / quads.offset : 0;
  const double multiple = quads.offset > 0 ? std::sqrt(systematic / quads.offset) : 0;
  const double by_both = 2 * (1 - gain) * gain * multiple * -prior.shared;
  PoseAndOffset learned;
  learned.offset = gain * measured;
  learned.current_from_previous =
      perturb(quads.pose_by_offset * (learned.offset - free.offset), free.current_from_previous);
  learned.offset_variance = by_prior + by_both + by_quads * (own + systematic);
  learned.offset_shared = (1 - gain) * prior.shared - gain * multiple;
  learned.covariance = spread * quads.pose_given_offset + by_quads * (spread + own - 1 + systematic) *
                                                              quads.pose_by_offset * quads.pose_by_offset.transpose();
  learned.by_offset = std::sqrt(by_prior + by_both) * quads.pose_by_offset;
  return learned;
}

void measure_scale(RefinementWorkspace& workspace) {
  workspace.reprojection_scale =
      measured_scale(workspace.terms.error, workspace.terms.size(), kReprojectionMedian, workspace.scale_values);
}

/// Gauss-Newton from `current_from_previous`, which is replaced. \returns false if the normal equations have no
/// solution. \param knows_scale whether reprojection_scale comes from a fit over a subset of the same quads, so that it
/// need not be measured before the first step
bool fit_pose(const PoseConfig& config, bool knows_scale, RefinementWorkspace& workspace,
              Eigen::Isometry3d& current_from_previous) {
  ReprojectionTerms& terms = workspace.terms;
  if (terms.size() == 0) return false;
  if (!knows_scale) {
    normal_by_pose(terms, current_from_previous, 0, {1, config.student_dof});
    measure_scale(workspace);
  }
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    const Normal<6> normal =
        normal_by_pose(terms, current_from_previous, 0, {workspace.reprojection_scale, config.student_dof});
    Vector6d step;
    if (!solve(normal, step)) return false;
    current_from_previous = perturb(step, current_from_previous);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
    measure_scale(workspace);
  }
  return true;
}

/// State of one run of refine().
class Refinement {
 public:
  Refinement(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, const OffsetPrior& offset,
             RefinementWorkspace& work, MotionEstimate& motion)
      : quads_(quads),
        rig_(rig),
        config_(config),
        noise_(config, offset.error),
        offset_(offset),
        work_(work),
        motion_(motion) {}

  /// Returns whether the last fit had a solution.
  bool run(RefinementGoal goal) {
    motion_.offset = 0;
    motion_.learned = {};
    // Every n-th quad is used to find the pose, all quads to refine it.
    const std::size_t every = std::max<std::size_t>(1, quads_.size() / kSelectionQuads);
    alternate(every);
    const bool is_measured = goal == RefinementGoal::pose_and_covariance && solved_;
    if (is_measured && every > 1) {
      select(1);
      take_selected();
      if (!(offset_.variance > 0)) fit(true);  // with the offset, the final fit follows
    }
    if (!is_measured || !(offset_.variance > 0 && find_offset())) {
      if (is_measured && offset_.variance > 0 && every > 1) fit(true);
      if (is_measured && solved_) motion_.learned.covariance = covariance_at(0).inflated();
      motion_.learned.current_from_previous = motion_.current_from_previous;
    }
    if (is_measured && solved_)
      motion_.learned.errors = disparity_errors(work_.terms, motion_.current_from_previous, motion_.offset);
    find_inliers();
    return solved_;
  }

 private:
  /// Alternates between selection from every `every`-th quad and fits.
  void alternate(std::size_t every) {
    for (int round = 0; round < kRefineRounds; ++round) {
      select(every);
      work_.changed_rows.clear();
      std::set_symmetric_difference(work_.rows.begin(), work_.rows.end(), work_.last_rows.begin(),
                                    work_.last_rows.end(), std::back_inserter(work_.changed_rows));
      if (round > 0 && work_.changed_rows.size() <= work_.rows.size() / kSameSelection) break;
      take_selected();
      if (!fit(round > 0)) break;
    }
  }

  void find_inliers() {
    motion_.inliers = select_inliers(quads_.scoring, LaterCameras(rig_, motion_.current_from_previous),
                                     config_.inlier_distance, kInlierOrientation, motion_.inlier);
  }

  void select(std::size_t every) {
    find_inliers();
    work_.rows.clear();
    for (std::size_t i = 0; i < motion_.inlier.size(); i += every)
      if (motion_.inlier[i] != 0) work_.rows.push_back(static_cast<std::int32_t>(i));
  }

  void take_selected() {
    std::swap(work_.rows, work_.last_rows);
    work_.terms.assign(quads_, work_.last_rows, rig_.left, noise_, scale_);
  }

  bool fit(bool knows_scale) {
    Eigen::Isometry3d candidate = motion_.current_from_previous;
    solved_ = fit_pose(config_, knows_scale, work_, candidate);
    if (solved_ && work_.reprojection_scale > 0) scale_ = std::sqrt(work_.reprojection_scale);
    if (solved_) motion_.current_from_previous = candidate;
    return solved_;
  }

  /// Returns false, with the pose unchanged, if the fit with the offset has no solution.
  bool find_offset() {
    const auto fit_both = [&](const MeasuredCovariance& covariance) {
      PoseAndOffset free;
      free.current_from_previous = motion_.current_from_previous;
      free.offset = motion_.offset;
      const auto learned =
          fit_offset(config_, covariance, offset_, work_.reprojection_scale, rig_.left.fx, work_.terms, free);
      if (!learned) return false;
      motion_.current_from_previous = free.current_from_previous;
      motion_.offset = free.offset;
      motion_.learned = *learned;
      return true;
    };
    // An offset that is not yet included in the disparities would look like correlated errors. It is therefore
    // estimated first and weighted afterwards.
    if (!fit_both(MeasuredCovariance())) return false;
    fit_both(covariance_at(motion_.offset));
    return true;
  }

  MeasuredCovariance covariance_at(double offset) {
    return measure_covariance(work_.terms, work_.last_rows, quads_, rig_, config_, motion_.current_from_previous,
                              offset, work_.reprojection_scale, work_.covariance);
  }

  const QuadObservations& quads_;
  const StereoRig& rig_;
  const PoseConfig& config_;
  const NoiseModel noise_;
  const OffsetPrior& offset_;
  RefinementWorkspace& work_;
  MotionEstimate& motion_;
  bool solved_ = false;  ///< whether the last fit had a solution
  double scale_ = 1;     ///< of the last one that had
};

}  // namespace

std::optional<PoseAndOffset> fit_offset(const PoseConfig& config, const MeasuredCovariance& covariance,
                                        const OffsetPrior& prior, double reprojection_scale, double focal_length,
                                        ReprojectionTerms& terms, PoseAndOffset& free) {
  const double weight = std::max(covariance.small_cell_inflation, 1.0);
  const double spread = std::max(covariance.inflation, 1.0) / weight;
  Normal<7> normal;
  for (int iteration = 0; iteration < kFitSteps; ++iteration) {
    normal = normal_by_pose_and_offset(terms, free.current_from_previous, free.offset,
                                       {reprojection_scale, config.student_dof});
    normal.matrix /= weight;
    normal.gradient /= weight;
    normal.matrix(6, 6) += 1.0 / prior.variance;
    normal.gradient(6) += free.offset / prior.variance;
    Vector7d step;
    if (!solve(normal, step)) return std::nullopt;
    free.current_from_previous = perturb(step.head<6>(), free.current_from_previous);
    free.offset += step(6);
    if (-normal.gradient.dot(step) < kFitTolerance * kFitTolerance) break;
  }
  normal.matrix(6, 6) -= 1.0 / prior.variance;
  return learned_from(free, normal.matrix, prior, spread, focal_length);
}

bool refine(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, const OffsetPrior& offset,
            RefinementWorkspace& workspace, MotionEstimate& motion, RefinementGoal goal) {
  return Refinement(quads, rig, config, offset, workspace, motion).run(goal);
}

}  // namespace quadedge::pose
