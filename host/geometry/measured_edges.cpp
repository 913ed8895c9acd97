/// \file measured_edges.cpp  Measures eight edges at once in plain numbers, in vector lanes.
#include "geometry/measured_edges.hpp"

#include <algorithm>
#include <cmath>

#include "common/parallel.hpp"
#include "geometry/stereo_numbers.hpp"

namespace quadedge::pose {

namespace {

constexpr std::size_t kLanes = 8;

/// Columns of kLanes edges.
struct ObservedLanes {
  double left_x[kLanes], left_y[kLanes], right_x[kLanes], right_y[kLanes];
  double left_cos[kLanes], left_sin[kLanes], right_cos[kLanes], right_sin[kLanes], scale_shift[kLanes];
};

/// Columns of their measurements. A member that is a vector has a column per coordinate.
struct MeasuredLanes {
  int is_valid[kLanes];
  double ray[2][kLanes], inverse_depth[kLanes], inverse_depth_per_pixel[kLanes], epipolar_sine[kLanes];
  double direction[2][kLanes], scale_shift[2][kLanes], slope[kLanes], slope_per_radian[kLanes];
  double left_normal[3][kLanes], right_normal[3][kLanes];
};

QUADEDGE_VECTOR_CLONES
void measure_lanes(const RigNumbers& rig, const ObservedLanes& edges, MeasuredLanes& result) {
  MeasuredLanes lanes;  // on the stack, so that it cannot alias its inputs
  for (std::size_t k = 0; k < kLanes; ++k) {
    const MeasuredNumbers one =
        measure_numbers(rig, {edges.left_x[k], edges.left_y[k], edges.right_x[k], edges.right_y[k], edges.left_cos[k],
                              edges.left_sin[k], edges.right_cos[k], edges.right_sin[k], edges.scale_shift[k]});
    lanes.is_valid[k] = one.is_valid ? 1 : 0;
    lanes.ray[0][k] = one.ray.x;
    lanes.ray[1][k] = one.ray.y;
    lanes.inverse_depth[k] = one.inverse_depth;
    lanes.inverse_depth_per_pixel[k] = one.inverse_depth_per_pixel;
    lanes.epipolar_sine[k] = one.epipolar_sine;
    lanes.direction[0][k] = one.direction.x;
    lanes.direction[1][k] = one.direction.y;
    lanes.scale_shift[0][k] = one.scale_shift.x;
    lanes.scale_shift[1][k] = one.scale_shift.y;
    lanes.slope[k] = one.slope;
    lanes.slope_per_radian[k] = one.slope_per_radian;
    lanes.left_normal[0][k] = one.left_normal.x;
    lanes.left_normal[1][k] = one.left_normal.y;
    lanes.left_normal[2][k] = one.left_normal.z;
    lanes.right_normal[0][k] = one.right_normal.x;
    lanes.right_normal[1][k] = one.right_normal.y;
    lanes.right_normal[2][k] = one.right_normal.z;
  }
  result = lanes;
}

void set_lane(const StereoEdges& edges, std::size_t i, std::size_t k, ObservedLanes& lanes) {
  lanes.left_x[k] = static_cast<double>(edges.left_x[i]);
  lanes.left_y[k] = static_cast<double>(edges.left_y[i]);
  lanes.right_x[k] = static_cast<double>(edges.right_x[i]);
  lanes.right_y[k] = static_cast<double>(edges.right_y[i]);
  const auto left = static_cast<double>(edges.left_direction[i]), right = static_cast<double>(edges.right_direction[i]);
  lanes.left_cos[k] = std::cos(left);
  lanes.left_sin[k] = std::sin(left);
  lanes.right_cos[k] = std::cos(right);
  lanes.right_sin[k] = std::sin(right);
  lanes.scale_shift[k] = edges.left_scale_shift.empty() ? 0.0 : static_cast<double>(edges.left_scale_shift[i]);
}

void take_lane(const ObservedLanes& edges, const MeasuredLanes& lanes, std::size_t k,
               std::optional<StereoMeasurement>& measured) {
  if (lanes.is_valid[k] == 0) {
    measured.reset();
    return;
  }
  StereoMeasurement& result = measured ? *measured : measured.emplace();
  result.ray = {lanes.ray[0][k], lanes.ray[1][k], 1};
  result.inverse_depth = lanes.inverse_depth[k];
  result.inverse_depth_per_pixel = lanes.inverse_depth_per_pixel[k];
  result.epipolar_sine = lanes.epipolar_sine[k];
  result.direction = {lanes.direction[0][k], lanes.direction[1][k], 0};
  result.scale_shift = {lanes.scale_shift[0][k], lanes.scale_shift[1][k]};
  result.slope = lanes.slope[k];
  result.slope_per_radian = lanes.slope_per_radian[k];
  result.left_edge = {static_cast<float>(edges.left_cos[k]), static_cast<float>(edges.left_sin[k])};
  result.right_edge = {static_cast<float>(edges.right_cos[k]), static_cast<float>(edges.right_sin[k])};
  result.left_normal = {lanes.left_normal[0][k], lanes.left_normal[1][k], lanes.left_normal[2][k]};
  result.right_normal = {lanes.right_normal[0][k], lanes.right_normal[1][k], lanes.right_normal[2][k]};
}

}  // namespace

void measure_edges(const StereoRig& rig, const StereoEdges& edges, double min_epipolar_angle, MeasuredEdges& measured) {
  const RigNumbers numbers(rig, min_epipolar_angle);
  measured.resize(edges.size());
  for_row_blocks(edges.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    ObservedLanes observed = {};
    MeasuredLanes lanes;
    for (std::size_t first = begin; first < end; first += kLanes) {
      const std::size_t count = std::min(kLanes, end - first);
      for (std::size_t k = 0; k < count; ++k) set_lane(edges, first + k, k, observed);
      measure_lanes(numbers, observed, lanes);
      for (std::size_t k = 0; k < count; ++k) take_lane(observed, lanes, k, measured[first + k]);
    }
  });
}

}  // namespace quadedge::pose
