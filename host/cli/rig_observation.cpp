/// \file rig_observation.cpp  Distances from epipolar lines in every frame, disparity residuals at new keyframes.
#include "cli/rig_observation.hpp"

#include <initializer_list>
#include <utility>

#include "common/matching_constants.hpp"
#include "geometry/corrected_rig.hpp"
#include "motion/latest_frame.hpp"

namespace quadedge::cli {
namespace {

/// By how many pixels of the right image a point lies farther along its line than the motion predicts, if all
/// disparities are `offset` px larger than those of the quad.
double beyond_prediction(const pose::StereoMeasurement& before, const pose::StereoMeasurement& after,
                         const Eigen::Isometry3d& motion, double offset) {
  const double inverse_depth = before.inverse_depth + offset * before.inverse_depth_per_pixel;
  const double z = motion.linear().row(2).dot(before.ray) + inverse_depth * motion.translation().z();
  return offset + (after.inverse_depth - inverse_depth / z) / after.inverse_depth_per_pixel;
}

void observe_rows(const odometry::LatestFrame& frame, const PinholeCamera& right, report::RigMaps& maps) {
  const RectificationError& error = frame.rows.error();
  maps.row_correction = error.largest();
  maps.width = right.width;
  maps.height = right.height;
  for (const rig::CornerMatch& match : frame.corner_matches) {
    const double u = match.right.x() / right.width, v = match.right.y() / right.height;
    maps.rows_before.add(u, v, match.across);
    maps.rows_after.add(u, v, match.across - error.at(u - 0.5, v - 0.5));
  }
}

/// Adds what the offsets [px] leave, each to its map.
void observe_columns(const odometry::LatestFrame& frame, const StereoRig& calibration,
                     std::initializer_list<std::pair<double, report::CellMap*>> offsets) {
  const odometry::MotionStep& step = *frame.step;
  const pose::QuadObservations& quads = step.quads;
  // Measured anew, since measured_edges() would keep them for the next frame, whose latency counts.
  const auto measured = [&](const frontend::FrameEdges& of) {
    pose::MeasuredEdges edges;
    pose::measure_edges(corrected_rig(calibration, step.rig.of(of.rig())), of.edges, kMinEpipolarAngle, edges);
    return edges;
  };
  const pose::MeasuredEdges before = measured(*step.base), after = measured(*frame.frame_edges);
  for (std::size_t q = 0; q < step.motion.inlier.size(); ++q) {
    if (step.motion.inlier[q] == 0) continue;
    const auto row = static_cast<std::size_t>(quads.match[q]);
    const auto &one = before[static_cast<std::size_t>(step.matches.previous[row])],
               &other = after[static_cast<std::size_t>(step.matches.current[row])];
    if (!one || !other) continue;
    const double u = static_cast<double>(quads.scoring.right_x[q]) / calibration.right.width,
                 v = static_cast<double>(quads.scoring.right_y[q]) / calibration.right.height;
    for (const auto& [offset, map] : offsets)
      map->add(u, v,
               beyond_prediction(*one, *other, step.motion.learned.current_from_previous,
                                 offset - step.rig.disparity_offset));
  }
}

}  // namespace

void observe_rig(const StereoOdometry& odometry, const FrameResult& result, report::RigMaps& maps) {
  const auto frame = odometry::LatestFrame::of(odometry);
  if (!result.world_from_left || frame.corner_matches.empty()) return;
  const double frames = frame.rows.rows().sums().frames;
  if (frames < maps.frames) maps = {};
  const PoseConfig& given = odometry.config().pose;
  if (maps.frames == 0) maps.offset_start = maps.offset_end = {given.disparity_offset, given.disparity_offset_sigma};
  maps.frames = frames;
  if (frame.rows.is_contradicted()) return;
  observe_rows(frame, odometry.rig().right, maps);
  if (frame.step == nullptr || !frame.step->ok()) return;
  maps.offset_end = {result.rig.disparity_offset, result.rig.disparity_offset_sigma};
  maps.disparity_error = result.rig.disparity_error;
  if (!result.new_key_rig) return;
  observe_columns(frame, odometry.rig(),
                  {{0, &maps.columns_before}, {result.rig.disparity_offset, &maps.columns_after}});
}

}  // namespace quadedge::cli
