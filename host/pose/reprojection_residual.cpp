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

}  // namespace quadedge::pose
