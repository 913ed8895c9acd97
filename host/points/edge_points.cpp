#include <limits>

#include "common/matching_constants.hpp"
#include "odometry/disparity_offset.hpp"
#include "pose/quads.hpp"
#include "quadedge/match_stereo.hpp"

namespace quadedge {

EdgePoints edge_points(const StereoEdges& edges, const StereoRig& rig, double disparity_offset) {
  const StereoRig calibration = odometry::with_disparity_offset(rig, disparity_offset);
  pose::MeasuredEdges measured;
  pose::measure_edges(calibration, edges, kMinEpipolarAngle, measured);
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
