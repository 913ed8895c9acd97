/// \file scoring.cpp  Projects in single precision, without branches, and sums costs in independent lanes.
#include "motion/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/parallel.hpp"

namespace quadedge::pose {

namespace {

constexpr std::size_t kBlock = 64;  ///< rows whose costs are computed before they are summed; a multiple of kSums
constexpr std::size_t kSums = 8;    ///< independent sums, which vector units can compute without reordering

void write_projection(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_previous, float* rows) {
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = camera.matrix() * camera_from_previous.linear();
  matrix.col(3) = camera.matrix() * camera_from_previous.translation();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) rows[4 * r + c] = static_cast<float>(matrix(r, c));
}

/// A homogeneous pixel; for a point, multiplied by the inverse depth.
struct Projected {
  float x, y, z;
};

/// Projects the point on the ray (x, y, 1) with the projection matrix `p` of a camera relative to the previous left
/// frame.
[[gnu::always_inline]] inline Projected project_point(const float* p, float x, float y, float inverse_depth) {
  return {p[0] * x + p[1] * y + p[2] + p[3] * inverse_depth, p[4] * x + p[5] * y + p[6] + p[7] * inverse_depth,
          p[8] * x + p[9] * y + p[10] + p[11] * inverse_depth};
}

/// The same for a direction, which is a point at infinity.
[[gnu::always_inline]] inline Projected project_direction(const float* p, float x, float y, float z) {
  return {p[0] * x + p[1] * y + p[2] * z, p[4] * x + p[5] * y + p[6] * z, p[8] * x + p[9] * y + p[10] * z};
}

[[gnu::always_inline]] inline float squared_norm(float x, float y) { return x * x + y * y; }

/// Squared distance from the segment of curve that an edge represents: (x, y) is the offset from the edge, (cosine,
/// sine) its direction.
[[gnu::always_inline]] inline float squared_distance(float x, float y, float cosine, float sine, float half_length) {
  const float along = std::abs(x * cosine + y * sine);
  const float beyond = along > half_length ? along - half_length : 0.0f;
  return squared_norm(x, y) - (along * along - beyond * beyond);
}

/// Whether a tangent projected to `tangent` at `point` is parallel to (cosine, sine) in the image.
[[gnu::always_inline]] inline bool same_direction(const Projected& point, const Projected& tangent, float cosine,
                                                  float sine, float min_cosine) {
  const float dx = tangent.x * point.z - point.x * tangent.z, dy = tangent.y * point.z - point.y * tangent.z;
  return std::abs(dx * cosine + dy * sine) >= min_cosine * std::sqrt(squared_norm(dx, dy));
}

/// Sum of the truncated squared distances of the rows [px^2].
QUADEDGE_VECTOR_CLONES
double cost_of_rows(const ScoringArrays& quads, const LaterCameras& cameras, float limit, std::size_t first,
                    std::size_t last) {
  const float *ray_x = quads.ray_x.data(), *ray_y = quads.ray_y.data(), *inverse_depth = quads.inverse_depth.data();
  const float *left_x = quads.left_x.data(), *left_y = quads.left_y.data();
  const float *right_x = quads.right_x.data(), *right_y = quads.right_y.data();
  const float *left_cos = quads.left_cos.data(), *left_sin = quads.left_sin.data();
  const float *right_cos = quads.right_cos.data(), *right_sin = quads.right_sin.data();
  const float half_length = quads.half_length;
  const LaterCameras c = cameras;  // a local copy stays in registers
  float sums[kSums] = {};
  float costs[kBlock];
  for (std::size_t begin = first; begin < last; begin += kBlock) {
    const std::size_t rows = std::min(kBlock, last - begin);
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t i = begin + k;
      const Projected in_left = project_point(c.left, ray_x[i], ray_y[i], inverse_depth[i]);
      const Projected in_right = project_point(c.right, ray_x[i], ray_y[i], inverse_depth[i]);
      const float left_inverse = 1.0f / in_left.z, right_inverse = 1.0f / in_right.z;
      const float left = squared_distance(in_left.x * left_inverse - left_x[i], in_left.y * left_inverse - left_y[i],
                                          left_cos[i], left_sin[i], half_length);
      const float right =
          squared_distance(in_right.x * right_inverse - right_x[i], in_right.y * right_inverse - right_y[i],
                           right_cos[i], right_sin[i], half_length);
      const float worse = left > right ? left : right;
      const float nearer = in_left.z < in_right.z ? in_left.z : in_right.z;
      const float cost = worse < limit ? worse : limit;  // NaN counts as the limit
      costs[k] = nearer > 0.0f ? cost : limit;
    }
    for (std::size_t k = rows; k < kBlock; ++k) costs[k] = 0.0f;
    for (std::size_t k = 0; k < kBlock; k += kSums)
      for (std::size_t lane = 0; lane < kSums; ++lane) sums[lane] += costs[k + lane];
  }
  double sum = 0;
  for (float lane : sums) sum += static_cast<double>(lane);
  return sum;
}

/// Marks the inliers, one byte per row, and counts them. All tests are computed for every row, so that the loop
/// vectorises.
/// \param limit squared distance [px^2] \param min_cosine between projected and measured direction
QUADEDGE_VECTOR_CLONES
int mark_inliers(const ScoringArrays& quads, const LaterCameras& cameras, float limit, float min_cosine,
                 std::size_t first, std::size_t last, std::uint8_t* inlier) {
  const float *ray_x = quads.ray_x.data(), *ray_y = quads.ray_y.data(), *inverse_depth = quads.inverse_depth.data();
  const float *tangent_x = quads.tangent_x.data(), *tangent_y = quads.tangent_y.data(),
              *tangent_z = quads.tangent_z.data();
  const float *left_x = quads.left_x.data(), *left_y = quads.left_y.data(), *left_cos = quads.left_cos.data(),
              *left_sin = quads.left_sin.data();
  const float *right_x = quads.right_x.data(), *right_y = quads.right_y.data(), *right_cos = quads.right_cos.data(),
              *right_sin = quads.right_sin.data();
  const float half_length = quads.half_length;
  const LaterCameras c = cameras;  // a local copy stays in registers
  int found = 0;
  int passes[kBlock];
  for (std::size_t begin = first; begin < last; begin += kBlock) {
    const std::size_t rows = std::min(kBlock, last - begin);
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t i = begin + k;
      const Projected left = project_point(c.left, ray_x[i], ray_y[i], inverse_depth[i]);
      const Projected right = project_point(c.right, ray_x[i], ray_y[i], inverse_depth[i]);
      const Projected left_tangent = project_direction(c.left, tangent_x[i], tangent_y[i], tangent_z[i]);
      const Projected right_tangent = project_direction(c.right, tangent_x[i], tangent_y[i], tangent_z[i]);
      const bool in_front = (left.z > 0.0f) & (right.z > 0.0f);
      const bool near = (squared_distance(left.x / left.z - left_x[i], left.y / left.z - left_y[i], left_cos[i],
                                          left_sin[i], half_length) < limit) &
                        (squared_distance(right.x / right.z - right_x[i], right.y / right.z - right_y[i], right_cos[i],
                                          right_sin[i], half_length) < limit);
      const bool along = same_direction(left, left_tangent, left_cos[i], left_sin[i], min_cosine) &
                         same_direction(right, right_tangent, right_cos[i], right_sin[i], min_cosine);
      passes[k] = in_front & near & along;
    }
    for (std::size_t k = 0; k < rows; ++k) {
      inlier[begin + k] = static_cast<std::uint8_t>(passes[k]);
      found += passes[k];
    }
  }
  return found;
}

}  // namespace

LaterCameras::LaterCameras(const StereoRig& rig, const Eigen::Isometry3d& current_from_previous) {
  write_projection(rig.left, current_from_previous, left);
  write_projection(rig.right, rig.right_from_left * current_from_previous, right);
}

double truncated_cost(const ScoringArrays& quads, const LaterCameras& cameras, double threshold) {
  const std::size_t count = quads.size();
  if (count == 0) return 1.0;
  const double sum = sum_row_blocks(
      count, 0.0,
      [&](std::size_t begin, std::size_t end, double& block_sum) {
        block_sum = cost_of_rows(quads, cameras, static_cast<float>(threshold * threshold), begin, end);
      },
      kCheapRows);
  return sum / (threshold * threshold * static_cast<double>(count));
}

int select_inliers(const ScoringArrays& quads, const LaterCameras& cameras, double threshold, double max_angle,
                   std::vector<std::uint8_t>& inlier) {
  inlier.assign(quads.size(), 0);
  const float limit = static_cast<float>(threshold * threshold), min_cosine = static_cast<float>(std::cos(max_angle));
  return sum_row_blocks(
      quads.size(), 0,
      [&](std::size_t begin, std::size_t end, int& found) {
        found = mark_inliers(quads, cameras, limit, min_cosine, begin, end, inlier.data());
      },
      kCheapRows);
}

int count_cells(const ScoringArrays& quads, const std::vector<std::uint8_t>& mask, double cell) {
  std::set<std::pair<int, int>> cells;
  const auto number = [&](float position) {
    return static_cast<int>(std::floor(static_cast<double>(position) / cell));
  };
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (mask[i]) cells.emplace(number(quads.left_x[i]), number(quads.left_y[i]));
  }
  return static_cast<int>(cells.size());
}

}  // namespace quadedge::pose
