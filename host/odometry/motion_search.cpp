#include "odometry/motion_search.hpp"

#include <algorithm>
#include <vector>

#include "odometry/prediction.hpp"
#include "pose/angles.hpp"
#include "pose/scoring.hpp"

namespace quadedge::odometry {

using pose::radians;

namespace {

constexpr double kSettled = 0.3;  ///< mean distance of predicted places that calls for no further search [px]
constexpr int kSettledStep = 16;  ///< every so many edges tell it
/// Of the inlier distance; in fine texture many an edge meets a wrong place by chance, the fewer the nearer it has to come.
constexpr double kExplained = 1.0 / 3.0;

}  // namespace

const pose::MeasuredEdges& MotionSearch::measured(stages::Base base, const MotionPrior& prior) {
  const bool key = base == stages::Base::key;
  MeasuredBase& known = key ? measured_key_ : measured_previous_;
  const int frame = key ? prior.key_frame : prior.previous_frame;
  if (known.frame != frame || known.offset != offset_.value()) {
    known = {frame, offset_.value(), pose::measure_edges(offset_.rig(), frontend_.base(base), radians(config_.stereo.min_epipolar_angle))};
  }
  return known.edges;
}

MotionStep MotionSearch::estimate(stages::Base base, TemporalMatches matches, const std::optional<Eigen::Isometry3d>& prediction,
                                  const PoseConfig& limits, const MotionPrior& prior) {
  const StereoRig& rig = offset_.rig();
  MotionStep step;
  step.base = base;
  step.matches = std::move(matches);
  step.quads = pose::build_quads(rig, measured(base, prior), frontend_.current(), step.matches, pose::QuadLimits(config_));
  step.motion = pose::estimate_motion(rig, step.quads, limits, prior.seed, prediction, offset_.variance());
  return step;
}

/// Looks for the motion since the base with a part of the edges. What it suggests need not convince.
MotionStep MotionSearch::scout(const MotionPrior& prior, double radius) {
  PoseConfig lenient = config_.pose;
  lenient.min_inlier_share = config_.temporal.scout_min_inlier_share;
  lenient.min_spread = 0;
  const StereoEdges& base = frontend_.base(prior.base);
  const int every = std::max(1, static_cast<int>(base.size()) / config_.temporal.scout_edges);
  auto search = predict_places(offset_.rig(), base, measured(prior.base, prior), prior.prediction, radius, every);
  search.scout = true;
  return estimate(prior.base, frontend_.match(prior.base, search), prior.prediction, lenient, prior);
}

MotionStep MotionSearch::suggest_anywhere(TemporalMatches matches, const MotionPrior& prior) {
  PoseConfig lenient = config_.pose;
  lenient.inlier_distance = config_.temporal.wide_inlier_distance;
  lenient.min_inlier_share = config_.temporal.scout_min_inlier_share;
  lenient.min_spread = 0;
  return estimate(prior.base, std::move(matches), std::nullopt, lenient, prior);
}

/// Looks for the motion since the base, however large, with edges that what surrounds them tells from all others.
MotionStep MotionSearch::look_anywhere(const MotionPrior& prior) {
  return suggest_anywhere(frontend_.match_anywhere(prior.base), prior);
}

/// The motion of what look_anywhere() found and its motion does not explain: of the scene, where that one is a moving thing's.
MotionStep MotionSearch::look_beside(const MotionStep& seen, const MotionPrior& prior) {
  if (!seen.ok()) return {};
  std::vector<std::uint8_t> explained(seen.matches.size(), 0);
  for (std::size_t q = 0; q < seen.quads.size(); ++q) explained[static_cast<std::size_t>(seen.quads.match[q])] = seen.motion.inlier[q];
  TemporalMatches others;
  for (std::size_t m = 0; m < seen.matches.size(); ++m)
    if (explained[m] == 0) others.append(seen.matches.previous[m], seen.matches.current[m], frontend_.current(), seen.matches.ncc[m], seen.matches.rivals[m]);
  return suggest_anywhere(std::move(others), prior);
}

/// Mean share of a cell's predicted places whose quads agree closely with the motion. A thing counts by the area that it covers, not by the
/// edges that it is covered with.
double MotionSearch::explained_area(const MotionStep& step, const stages::PlacedEdges& predicted) const {
  const double side = config_.pose.scoring_cell > 0 ? config_.pose.scoring_cell : std::max(rig_.left.width, rig_.left.height);
  const int columns = static_cast<int>(rig_.left.width / side) + 1, rows = static_cast<int>(rig_.left.height / side) + 1;
  struct Cell {
    double edges = 0, explained = 0;
  };
  std::vector<Cell> cells(static_cast<std::size_t>(columns * rows));
  const auto cell_of = [&](std::size_t i) -> Cell* {
    const double x = static_cast<double>(predicted.x[i]) / side, y = static_cast<double>(predicted.y[i]) / side;
    if (!(x >= 0 && x < columns && y >= 0 && y < rows)) return nullptr;
    return &cells[static_cast<std::size_t>(static_cast<int>(y) * columns + static_cast<int>(x))];
  };
  for (std::size_t i = 0; i < predicted.x.size(); ++i)
    if (Cell* cell = cell_of(i)) cell->edges += 1;
  std::vector<std::uint8_t> agrees;
  pose::select_inliers(step.quads.scoring, pose::LaterCameras(offset_.rig(), step.motion.current_from_previous),
                       kExplained * config_.pose.inlier_distance, radians(config_.pose.inlier_orientation), agrees);
  for (std::size_t q = 0; q < step.quads.size(); ++q) {
    if (!agrees[q]) continue;
    const auto edge = step.matches.previous[static_cast<std::size_t>(step.quads.match[q])];
    if (Cell* cell = cell_of(static_cast<std::size_t>(edge))) cell->explained += 1;
  }
  double sum = 0, held = 0;
  for (const Cell& cell : cells) {
    if (!(cell.edges > 0)) continue;
    sum += cell.explained / cell.edges;
    held += 1;
  }
  return held > 0 ? sum / held : 0;
}

/// Whether edges found anywhere agree with a motion: in as many places of the image as an estimate needs inliers. A found edge could lie
/// anywhere, so a wrong motion meets next to none of them; neighbours, which may err together, count once.
bool MotionSearch::is_seen(const MotionStep& anywhere, const MotionStep& found, const MotionPrior& prior) const {
  Eigen::Isometry3d motion = found.motion.current_from_previous;
  if (found.base != prior.base) motion = motion * prior.base_from_key->inverse();
  std::vector<std::uint8_t> agrees;
  pose::select_inliers(anywhere.quads.scoring, pose::LaterCameras(offset_.rig(), motion), config_.temporal.wide_inlier_distance,
                       radians(config_.pose.inlier_orientation), agrees);
  return pose::count_cells(anywhere.quads.scoring, agrees, config_.pose.vote_cell) >= config_.pose.min_inliers;
}

/// Matches all edges of a base within a few pixels of where a motion predicts them, again around what that finds until the places
/// stay. Within so few pixels a wrong motion finds some support too: a true one has to find more.
MotionStep MotionSearch::match(stages::Base base, Eigen::Isometry3d motion, const MotionPrior& prior) {
  const auto places = [&](int step) {
    return predict_places(offset_.rig(), frontend_.base(base), measured(base, prior), motion, config_.temporal.radius, step);
  };
  auto search = places(1);
  MotionStep step;
  for (int round = 0; round < config_.temporal.rounds; ++round) {
    step = estimate(base, frontend_.match(base, search), motion, config_.pose, prior);
    const int in_view = count_in_view(rig_.left, search.left);
    step.support = step.motion.inliers / std::max(1.0, static_cast<double>(in_view));
    step.area = explained_area(step, search.left);
    if (step.motion.status != pose::MotionStatus::ok) break;
    if (step.support < config_.temporal.min_support) {
      step.motion.status = pose::MotionStatus::no_consensus;
      break;
    }
    motion = step.motion.current_from_previous;
    if (round + 1 == config_.temporal.rounds) break;
    if (mean_distance(search.left, places(kSettledStep).left, kSettledStep) < kSettled) break;
    search = places(1);
  }
  return step;
}

/// What the matching of all edges says of a scouted motion.
MotionStep MotionSearch::confirm(MotionStep scouted, const MotionPrior& prior) {
  if (!scouted.ok()) return scouted;
  const Eigen::Isometry3d motion = scouted.motion.current_from_previous;
  if (prior.base_from_key) {
    MotionStep step = match(stages::Base::key, motion * *prior.base_from_key, prior);
    if (step.ok()) return step;
  }
  return match(prior.base, motion, prior);
}

MotionStep MotionSearch::find(const MotionPrior& prior) {
  const bool anywhere = config_.temporal.wide_edges > 0;
  MotionStep near;
  if (prior.prediction) {
    near = confirm(scout(prior, config_.temporal.scout_radius), prior);
    if (near.ok() && (!anywhere || near.support >= config_.temporal.sure_support)) return near;
  }
  if (!anywhere) return confirm(scout(prior, config_.temporal.scout_radius_wide * rig_.left.width), prior);
  const MotionStep seen = look_anywhere(prior);
  MotionStep step = confirm(seen, prior);
  const MotionStep beside = look_beside(seen, prior);
  if (beside.ok()) {
    MotionStep other = confirm(beside, prior);
    if (other.ok() && (!step.ok() || other.area > step.area)) step = std::move(other);
  }
  if (near.ok() && (!step.ok() || near.area > step.area)) step = std::move(near);
  if (step.ok() && !is_seen(seen, step, prior)) step.motion.status = pose::MotionStatus::no_consensus;
  return step;
}

}  // namespace quadedge::odometry
