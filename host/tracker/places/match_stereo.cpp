/// \file match_stereo.cpp  Runs the front end on one pair, with rows and range that it finds itself, and triangulates.

#include "quadedge/match_stereo.hpp"

#include <limits>

#include "common/images.hpp"
#include "common/matching_constants.hpp"
#include "edges/frontend.hpp"
#include "geometry/corrected_rig.hpp"
#include "geometry/undistortion.hpp"
#include "motion/quads.hpp"
#include "places/measured_points.hpp"
#include "rig/rectification_follower.hpp"

namespace quadedge {
namespace {

/// Of the width, for rectified images of unknown cameras: the published Middlebury scenes of 2014 reach 0.09 to 0.12.
constexpr double kUsualRange = 0.12;

}  // namespace

StereoMatches match_stereo(const StereoFrame& frame, const StereoRig& rig, Device& device, const Config& config) {
  check_rig(rig, "stereo rig");
  check_config(config);
  RecordedImages(rig).check(frame);
  const auto use = device.use();
  StereoMatches matches;
  matches.rig = with_equal_scales(rig);
  rig::RectificationFollower rows(matches.rig, config.stereo);
  const auto frontend = frontend::make_frontend(matches.rig, device, config, &matches.warnings);
  frontend->correct_rows(&rows);
  matches.edges = frontend->process(frame)->edges;
  matches.left_edges = frontend->edges(Side::left);
  for (const auto& point : points::measure_points(matches.rig, matches.edges, frame.left, config)) {
    auto& result = matches.points.emplace_back();
    if (point)
      result = CloudPoint{point->position, point->tangent.cast<float>(), point->grey,
                          points::largest_sigma(point->information), 1};
  }
  return matches;
}

StereoRig rectified_images(int width, int height, int right_width, int right_height) {
  StereoRig rig;
  const double focal = width;
  rig.left = {focal, focal, (width - 1) / 2.0, (height - 1) / 2.0, width, height};
  rig.right = {focal, focal, rig.left.cx, rig.left.cy, right_width, right_height};
  rig.right_from_left.translation() << -1, 0, 0;
  rig.max_disparity = kUsualRange * width;
  return rig;
}

EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const RigEstimate& estimate) {
  pose::MeasuredEdges measured;
  pose::measure_edges(corrected_rig(rig, estimate), edges, kMinEpipolarAngle, measured);
  const auto count = static_cast<Eigen::Index>(measured.size());
  EdgePoints points{Eigen::Matrix3Xd::Constant(3, count, std::numeric_limits<double>::quiet_NaN()), {}};
  points.tangent = points.position;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& measurement = measured[static_cast<std::size_t>(i)];
    if (!measurement) continue;
    const pose::OrientedPoint point = measurement->oriented_point();
    points.position.col(i) = point.point;
    points.tangent.col(i) = point.tangent;
  }
  return points;
}

}  // namespace quadedge
