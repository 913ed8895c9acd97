#include "quadedge/edge_points.hpp"

#include <limits>

#include "odometry/disparity_offset.hpp"
#include "pose/quads.hpp"

namespace quadedge {

EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const Config& config, double disparity_offset) {
  StereoRig calibration;  // without tables
  calibration.left = rig.left;
  calibration.right = rig.right;
  calibration.right_from_left = rig.right_from_left;
  const Eigen::Vector2d nearer = odometry::direction_of_nearer(rig);
  calibration.right.cx -= disparity_offset * nearer.x();
  calibration.right.cy -= disparity_offset * nearer.y();
  pose::MeasuredEdges measured;
  pose::measure_edges(calibration, edges, config.stereo.min_epipolar_angle_rad(), measured);
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
