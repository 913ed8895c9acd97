/// \file predicted_edges.cpp  Projects eight edges at once, with an arc tangent that compilers vectorise.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "common/parallel.hpp"
#include "geometry/lanes.hpp"
#include "geometry/measured_edges.hpp"
#include "geometry/stereo_numbers.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::pose {

namespace {

/// What a prediction needs of a measured edge. NaN without a measurement.
struct KnownEdge {
  double ray_x, ray_y, inverse_depth, direction_x, direction_y, slope;

  template <class Self>
  [[gnu::always_inline]] static auto members(Self& self) {
    return std::tie(self.ray_x, self.ray_y, self.inverse_depth, self.direction_x, self.direction_y, self.slope);
  }
};

struct EdgeLanes {
  float x[kLanes], y[kLanes], direction[kLanes];
};

/// A camera and where it stands.
struct MovedCamera {
  MovedCamera(const PinholeCamera& camera_of, const Eigen::Isometry3d& camera_from_points)
      : camera(camera_of),
        rotation(camera_from_points.linear()),
        translation(numbers_of(camera_from_points.translation())) {}
  CameraNumbers camera;
  RotationNumbers rotation;
  Vector3 translation;
};

/// atan2(y, x), accurate to 1e-15, by the rational function of Cephes (S. L. Moshier: Methods and Programs for
/// Mathematical Functions, 1989) for the arc tangent of numbers up to 0.66.
[[gnu::always_inline]] inline double angle_of(double y, double x) {
  const double across = std::abs(y), along = std::abs(x);
  const bool is_steep = across > along;
  const double low = is_steep ? along : across, high = is_steep ? across : along;
  const bool is_oblique = low > 0.66 * high;
  const double t = (is_oblique ? low - high : low) / (is_oblique ? low + high : high), z = t * t;
  const double p =
      (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z -
       1.228866684490136173410e2) *
          z -
      6.485021904942025371773e1;
  const double q =
      ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z +
       4.853903996359136964868e2) *
          z +
      1.945506571482613964425e2;
  const double flat = (is_oblique ? 0.25 * kPi : 0.0) + (t + t * z * (p / q));
  const double forward = is_steep ? 0.5 * kPi - flat : flat;
  return std::copysign(x < 0 ? kPi - forward : forward, y);
}

[[gnu::always_inline]] inline void project_lane(const MovedCamera& seen_by, const Vector3& from, const Vector3& along,
                                                std::size_t lane, EdgeLanes& edges) {
  constexpr float kNowhere = std::numeric_limits<float>::quiet_NaN();
  const CameraNumbers& camera = seen_by.camera;
  const Vector3 point = plus(seen_by.rotation * from, seen_by.translation);
  const Vector3 motion = image_motion(camera, point, seen_by.rotation * along);
  const bool is_seen = (point.z > 0) & (dot(motion, motion) > 0);  // false for NaN
  const auto x = static_cast<float>(camera.fx * point.x / point.z + camera.cx),
             y = static_cast<float>(camera.fy * point.y / point.z + camera.cy),
             direction = static_cast<float>(angle_of(motion.y, motion.x));
  edges.x[lane] = is_seen ? x : kNowhere;
  edges.y[lane] = is_seen ? y : kNowhere;
  edges.direction[lane] = is_seen ? direction : kNowhere;
}

QUADEDGE_VECTOR_CLONES
void predict_lanes(const Lanes<KnownEdge>& known, const MovedCamera& left, const MovedCamera& right, EdgeLanes& in_left,
                   EdgeLanes& in_right) {
  EdgeLanes lefts, rights;  // on the stack, so that they cannot alias the inputs
  for (std::size_t k = 0; k < kLanes; ++k) {
    const KnownEdge edge = row_of<KnownEdge>(known, k);
    const Vector3 ray = {edge.ray_x, edge.ray_y, 1.0};
    const Vector3 point = over(ray, edge.inverse_depth);
    const Vector3 tangent = plus({edge.direction_x, edge.direction_y, 0.0}, edge.slope * ray);
    const Vector3 unit = over(tangent, norm(tangent));
    project_lane(left, point, unit, k, lefts);
    project_lane(right, point, unit, k, rights);
  }
  in_left = lefts;
  in_right = rights;
}

KnownEdge known(const std::optional<StereoMeasurement>& measured) {
  if (!measured) return {0, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0, 0};
  return {measured->ray.x(),       measured->ray.y(),       measured->inverse_depth,
          measured->direction.x(), measured->direction.y(), measured->slope};
}

void take_lane(const EdgeLanes& lanes, std::size_t k, std::size_t i, EdgePositions& edges) {
  edges.x[i] = lanes.x[k];
  edges.y[i] = lanes.y[k];
  edges.direction[i] = lanes.direction[k];
}

}  // namespace

void predict_edges(const StereoRig& rig, const MeasuredEdges& measured, const Eigen::Isometry3d& current_from_previous,
                   std::size_t step, EdgePositions& left, EdgePositions& right) {
  const MovedCamera left_camera(rig.left, current_from_previous),
      right_camera(rig.right, rig.right_from_left * current_from_previous);
  for (auto* edges : {&left, &right})
    for (auto* column : {&edges->x, &edges->y, &edges->direction}) column->resize(measured.size());
  for_row_blocks((measured.size() + step - 1) / step,
                 [&](std::size_t, std::size_t begin, std::size_t end) {
                   Lanes<KnownEdge> points = {};
                   EdgeLanes lefts, rights;
                   for (std::size_t first = begin; first < end; first += kLanes) {
                     const std::size_t count = std::min(kLanes, end - first);
                     for (std::size_t k = 0; k < count; ++k) set_row(points, k, known(measured[(first + k) * step]));
                     predict_lanes(points, left_camera, right_camera, lefts, rights);
                     for (std::size_t k = 0; k < count; ++k) {
                       take_lane(lefts, k, (first + k) * step, left);
                       take_lane(rights, k, (first + k) * step, right);
                     }
                   }
                 },
                 kCheapRows);
}

}  // namespace quadedge::pose
