#include "pose/reprojection_residual.hpp"

namespace quadedge::pose {

ReprojectionTerm make_reprojection_term(const QuadObservations& quads, std::size_t quad, const NoiseModel& noise,
                                        double scale) {
  const StereoMeasurement &previous = quads.previous[quad], &current = quads.current[quad];
  const double cosine = quads.scoring.left_cos[quad], sine = quads.scoring.left_sin[quad];
  ReprojectionTerm term;
  term.ray_x = previous.ray.x();
  term.ray_y = previous.ray.y();
  term.inverse_depth = previous.inverse_depth;
  term.inverse_depth_sigma = previous.inverse_depth_per_pixel * noise.on_epipolar_line(previous.epipolar_sine);
  term.inverse_depth_per_pixel = previous.inverse_depth_per_pixel;
  term.current_inverse_depth_per_pixel = current.inverse_depth_per_pixel;
  term.current_x = current.ray.x();
  term.current_y = current.ray.y();
  // Each edge is moved to the scale half-way between the two.
  term.scale_drift_x = 0.5 * (previous.scale_drift.x() + current.scale_drift.x());
  term.scale_drift_y = 0.5 * (previous.scale_drift.y() + current.scale_drift.y());
  term.across_x = -sine / noise.across;
  term.across_y = cosine / noise.across;
  const double along = noise.along_in_time(static_cast<double>(quads.scoring.half_length), scale);
  term.along_x = cosine / along;
  term.along_y = sine / along;
  term.current_inverse_depth = current.inverse_depth;
  term.current_inverse_depth_weight =
      1.0 / (current.inverse_depth_per_pixel * noise.on_epipolar_line(current.epipolar_sine));
  return term;
}

ReprojectionTerm per_ray_unit(const ReprojectionTerm& term, const PinholeCamera& left) {
  ReprojectionTerm result = term;
  result.across_x *= left.fx;
  result.across_y *= left.fy;
  result.along_x *= left.fx;
  result.along_y *= left.fy;
  return result;
}

bool reprojection_jacobian(const ReprojectionTerm& term, const PinholeCamera& left,
                           const Eigen::Isometry3d& current_from_previous, double depth, ReprojectionJacobian& result) {
  const Eigen::Vector3d translation = current_from_previous.translation();
  const double rho = term.inverse_depth + depth * term.inverse_depth_sigma;
  const Eigen::Vector3d ray = current_from_previous.linear() * Eigen::Vector3d(term.ray_x, term.ray_y, 1);
  const Eigen::Vector3d point = ray + rho * translation;
  const ReprojectionResidual residual =
      reprojection_residual(term, {point.x(), point.y(), point.z()}, rho,
                            {translation.x(), translation.y(), translation.z()}, left.fx, left.fy);
  if (!residual.in_front) return false;
  const auto vector = [](const Residuals& r) { return Eigen::Vector3d(r.across, r.along, r.inverse_depth); };
  result.value = vector(residual.value);
  result.by_depth = vector(residual.by_depth);
  result.by_offset = vector(residual.by_offset);
  const Vector3 gradients[3] = {residual.across_by_point, residual.along_by_point, {0, 0, residual.inverse_depth_by_z}};
  for (int row = 0; row < 3; ++row) {
    const Eigen::Vector3d by_point(gradients[row].x, gradients[row].y, gradients[row].z);
    result.by_pose.row(row) << point.cross(by_point).transpose(), rho * by_point.transpose();
  }
  return true;
}

}  // namespace quadedge::pose
