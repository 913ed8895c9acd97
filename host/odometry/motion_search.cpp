#include "odometry/motion_search.hpp"

#include <algorithm>
#include <vector>

#include "common/angles.hpp"
#include "odometry/prediction.hpp"
#include "pose/scoring.hpp"

namespace quadedge::odometry {

namespace {

constexpr double kSettled = 0.3;  ///< mean distance of predicted places that calls for no further search [px]
constexpr int kSettledStep = 16;  ///< every so many edges tell it
/// Of the inlier distance; in fine texture many an edge meets a wrong place by chance, the fewer the nearer it has to
/// come.
constexpr double kExplained = 1.0 / 3.0;

}  // namespace

const pose::MeasuredEdges& MotionSearch::measured(Base base, const MotionPrior& prior) {
  return prior.rig(base).measured_edges(offset_.rig(), offset_.value(), radians(config_.stereo.min_epipolar_angle));
}

StepHandle MotionSearch::new_step(Base base) {
  StepHandle step = steps_.take();
  step->base = base;
  step->matches.clear();
  step->motion.status = pose::MotionStatus::too_few_quads;
  step->support = step->area = 0;
  return step;
}

/// The motion that the step's matches agree on.
void MotionSearch::estimate(const std::optional<Eigen::Isometry3d>& prediction, const PoseConfig& limits,
                            const MotionPrior& prior, MotionStep& step) {
  const StereoRig& rig = offset_.rig();
  builder_.build(rig, measured(step.base, prior), prior.current->edges, step.matches, pose::QuadLimits(config_),
                 step.quads);
  estimator_.estimate(rig, step.quads, limits, prior.seed, prediction, offset_.variance(), step.motion);
}

/// Looks for the motion since the base with a part of the edges. What it suggests need not convince.
StepHandle MotionSearch::scout(const MotionPrior& prior, double radius) {
  PoseConfig lenient = config_.pose;
  lenient.min_inlier_ratio = config_.temporal.coarse_min_inlier_ratio;
  lenient.min_spread = 0;
  const StereoEdges& base = prior.rig(prior.base).edges;
  const int every = std::max(1, static_cast<int>(base.size()) / config_.temporal.coarse_edges);
  predict_places(offset_.rig(), base, measured(prior.base, prior), prior.prediction, radius, every, search_);
  search_.scout = true;
  StepHandle step = new_step(prior.base);
  frontend_.match(prior.rig(prior.base), search_, step->matches);
  estimate(prior.prediction, lenient, prior, *step);
  return step;
}

void MotionSearch::suggest_anywhere(const MotionPrior& prior, MotionStep& step) {
  PoseConfig lenient = config_.pose;
  lenient.inlier_distance = config_.temporal.wide_inlier_distance;
  lenient.min_inlier_ratio = config_.temporal.coarse_min_inlier_ratio;
  lenient.min_spread = 0;
  estimate(std::nullopt, lenient, prior, step);
}

/// Looks for the motion since the base, however large, with edges that what surrounds them tells from all others.
StepHandle MotionSearch::look_anywhere(const MotionPrior& prior) {
  StepHandle step = new_step(prior.base);
  frontend_.match_anywhere(prior.rig(prior.base), step->matches);
  suggest_anywhere(prior, *step);
  return step;
}

/// The motion of what look_anywhere() found and its motion does not explain: of the scene, where that one is a moving
/// thing's.
StepHandle MotionSearch::look_beside(const MotionStep& seen, const MotionPrior& prior) {
  StepHandle step = new_step(prior.base);
  agrees_.assign(seen.matches.size(), 0);
  for (std::size_t q = 0; q < seen.quads.size(); ++q)
    agrees_[static_cast<std::size_t>(seen.quads.match[q])] = seen.motion.inlier[q];
  for (std::size_t m = 0; m < seen.matches.size(); ++m)
    if (agrees_[m] == 0)
      step->matches.append(seen.matches.previous[m], seen.matches.current[m], prior.current->edges, seen.matches.ncc[m],
                           seen.matches.rivals[m]);
  suggest_anywhere(prior, *step);
  return step;
}

/// Mean share of a cell's predicted places whose quads agree closely with the motion. A thing counts by the area that
/// it covers, not by the edges that it is covered with.
double MotionSearch::explained_area(const MotionStep& step, const PlacedEdges& predicted) {
  const double side =
      config_.pose.scoring_cell > 0 ? config_.pose.scoring_cell : std::max(rig_.left.width, rig_.left.height);
  const int columns = static_cast<int>(rig_.left.width / side) + 1,
            rows = static_cast<int>(rig_.left.height / side) + 1;
  cells_.assign(static_cast<std::size_t>(columns * rows), {});
  const auto cell_of = [&](std::size_t i) -> Cell* {
    const double x = static_cast<double>(predicted.x[i]) / side, y = static_cast<double>(predicted.y[i]) / side;
    if (!(x >= 0 && x < columns && y >= 0 && y < rows)) return nullptr;
    return &cells_[static_cast<std::size_t>(static_cast<int>(y) * columns + static_cast<int>(x))];
  };
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (Cell* cell = cell_of(i)) cell->edges += 1;
  pose::select_inliers(step.quads.scoring, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous),
                       kExplained * config_.pose.inlier_distance, radians(config_.pose.inlier_orientation), agrees_);
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    if (!agrees_[q]) continue;
    const auto edge = step.matches.previous[static_cast<std::size_t>(step.quads.match[q])];
    if (Cell* cell = cell_of(static_cast<std::size_t>(edge))) cell->explained += 1;
  }
  double sum = 0, held = 0;
  for (const Cell& cell : cells_) {
    if (!(cell.edges > 0)) continue;
    sum += cell.explained / cell.edges;
    held += 1;
  }
  return held > 0 ? sum / held : 0;
}

/// Whether edges found anywhere agree with a motion: in as many places of the image as an estimate needs inliers. A
/// found edge could lie anywhere, so a wrong motion meets next to none of them; neighbours, which may err together,
/// count once.
bool MotionSearch::is_seen(const MotionStep& anywhere, const MotionStep& found, const MotionPrior& prior) {
  Eigen::Isometry3d motion = found.motion.current_from_previous;
  if (found.base != prior.base) motion = motion * prior.base_from_key->inverse();
  pose::select_inliers(anywhere.quads.scoring, pose::LaterCameras(offset_.rig(), motion),
                       config_.temporal.wide_inlier_distance, radians(config_.pose.inlier_orientation), agrees_);
  return pose::count_cells(anywhere.quads.scoring, agrees_, config_.pose.inflation_cell) >= config_.pose.min_inliers;
}

/// Matches all edges of a base within a few pixels of where a motion predicts them, again around what that finds until
/// the places stay. Within so few pixels a wrong motion finds some support too: a true one has to find more.
StepHandle MotionSearch::match(Base base, Eigen::Isometry3d motion, const MotionPrior& prior) {
  const auto predict = [&](int every, TemporalSearch& search) {
    predict_places(offset_.rig(), prior.rig(base).edges, measured(base, prior), motion, config_.temporal.radius, every,
                   search);
  };
  predict(1, search_);
  StepHandle step = new_step(base);
  for (int round = 0; round < config_.temporal.rounds; ++round) {
    frontend_.match(prior.rig(base), search_, step->matches);
    estimate(motion, config_.pose, prior, *step);
    const int in_view = count_in_view(rig_.left, search_.left);
    step->support = step->motion.inliers / std::max(1.0, static_cast<double>(in_view));
    step->area = explained_area(*step, search_.left);
    if (!step->ok()) break;
    if (step->support < config_.temporal.min_support) {
      step->motion.status = pose::MotionStatus::no_consensus;
      break;
    }
    motion = step->motion.current_from_previous;
    if (round + 1 == config_.temporal.rounds) break;
    predict(kSettledStep, settled_);
    if (mean_distance(search_.left, settled_.left, kSettledStep) < kSettled) break;
    predict(1, search_);
  }
  return step;
}

/// What the matching of all edges says of a motion since the prior's base.
StepHandle MotionSearch::confirm(const Eigen::Isometry3d& motion, const MotionPrior& prior) {
  if (prior.base_from_key) {
    StepHandle step = match(Base::key, motion * *prior.base_from_key, prior);
    if (step->ok()) return step;
  }
  return match(prior.base, motion, prior);
}

StepHandle MotionSearch::scout_and_confirm(const MotionPrior& prior, double radius) {
  StepHandle scouted = scout(prior, radius);
  if (!scouted->ok()) return scouted;
  return confirm(scouted->motion.current_from_previous, prior);
}

StepHandle MotionSearch::find(const MotionPrior& prior) {
  const bool anywhere = config_.temporal.wide_edges > 0;
  StepHandle near;
  if (prior.prediction) {
    near = scout_and_confirm(prior, config_.temporal.coarse_radius);
    if (near->ok() && (!anywhere || near->support >= config_.temporal.confident_support)) return near;
  }
  if (!anywhere) return scout_and_confirm(prior, config_.temporal.coarse_wide_radius_ratio * rig_.left.width);
  StepHandle seen = look_anywhere(prior), step;
  if (seen->ok()) {
    step = confirm(seen->motion.current_from_previous, prior);
    const StepHandle beside = look_beside(*seen, prior);
    if (beside->ok()) {
      StepHandle other = confirm(beside->motion.current_from_previous, prior);
      if (other->ok() && (!step->ok() || other->area > step->area)) step = std::move(other);
    }
  }
  if (near && near->ok() && (!step || !step->ok() || near->area > step->area)) step = std::move(near);
  if (!step) return seen;
  if (step->ok() && !is_seen(*seen, *step, prior)) step->motion.status = pose::MotionStatus::no_consensus;
  return step;
}

}  // namespace quadedge::odometry
