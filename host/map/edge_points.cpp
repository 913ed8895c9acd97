#include "quadedge/edge_points.hpp"

#include <limits>

#include "motion/disparity_offset.hpp"
#include "pose/quads.hpp"

namespace quadedge {

EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, const Config& config, double disparity_offset) {
  const StereoRig calibration = motion::with_disparity_offset(rig, disparity_offset);
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
