#include "pose/scoring.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "common/row_blocks.hpp"

namespace quadedge::pose {

namespace {

constexpr std::size_t kBlock = 64;  ///< rows whose costs are computed before they are added up; a multiple of kSums
constexpr std::size_t kSums = 8;    ///< independent sums, so that a vector unit may add without reordering anything

void write_projection(const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_previous, float* rows) {
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = camera.matrix() * camera_from_previous.linear();
  matrix.col(3) = camera.matrix() * camera_from_previous.translation();
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) rows[4 * r + c] = static_cast<float>(matrix(r, c));
}

/// Does the image of the tangent at homogeneous pixel (x, y, z) run along (cosine, sine)?
bool same_direction(const float* p, float x, float y, float z, float tx, float ty, float tz, float cosine, float sine,
                    float limit) {
  const float qx = p[0] * tx + p[1] * ty + p[2] * tz;
  const float qy = p[4] * tx + p[5] * ty + p[6] * tz;
  const float qz = p[8] * tx + p[9] * ty + p[10] * tz;
  const float dx = qx * z - x * qz, dy = qy * z - y * qz;
  return std::abs(dx * cosine + dy * sine) >= limit * std::sqrt(dx * dx + dy * dy);
}

/// Sum of the rows' truncated squared distances [px^2].
double cost_of_rows(const ScoringArrays& quads, const LaterCameras& cameras, float limit, std::size_t first,
                    std::size_t last) {
  const float *rx = quads.ray_x.data(), *ry = quads.ray_y.data(), *rho = quads.inverse_depth.data();
  const float *lx = quads.left_x.data(), *ly = quads.left_y.data(), *gx = quads.right_x.data(),
              *gy = quads.right_y.data();
  const LaterCameras c = cameras;  // a local copy stays in registers
  const float *l = c.left, *g = c.right;
  float sums[kSums] = {};
  float costs[kBlock];
  for (std::size_t begin = first; begin < last; begin += kBlock) {
    const std::size_t rows = std::min(kBlock, last - begin);
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t i = begin + k;
      const float a = rx[i], b = ry[i], d = rho[i];
      const float lz = l[8] * a + l[9] * b + l[10] + l[11] * d;
      const float gz = g[8] * a + g[9] * b + g[10] + g[11] * d;
      const float li = 1.0f / lz, gi = 1.0f / gz;
      const float ex = (l[0] * a + l[1] * b + l[2] + l[3] * d) * li - lx[i];
      const float ey = (l[4] * a + l[5] * b + l[6] + l[7] * d) * li - ly[i];
      const float fx = (g[0] * a + g[1] * b + g[2] + g[3] * d) * gi - gx[i];
      const float fy = (g[4] * a + g[5] * b + g[6] + g[7] * d) * gi - gy[i];
      const float left = ex * ex + ey * ey, right = fx * fx + fy * fy;
      const float worse = left > right ? left : right;
      const float near = lz < gz ? lz : gz;
      const float cost = worse < limit ? worse : limit;  // NaN counts as the limit
      costs[k] = near > 0.0f ? cost : limit;
    }
    for (std::size_t k = rows; k < kBlock; ++k) costs[k] = 0.0f;
    for (std::size_t k = 0; k < kBlock; k += kSums)
      for (std::size_t lane = 0; lane < kSums; ++lane) sums[lane] += costs[k + lane];
  }
  double sum = 0;
  for (float lane : sums) sum += static_cast<double>(lane);
  return sum;
}

bool is_inlier(const ScoringArrays& quads, std::size_t i, const LaterCameras& cameras, float limit, float min_cosine) {
  const float *l = cameras.left, *g = cameras.right;
  const float a = quads.ray_x[i], b = quads.ray_y[i], d = quads.inverse_depth[i];
  const float lz = l[8] * a + l[9] * b + l[10] + l[11] * d, gz = g[8] * a + g[9] * b + g[10] + g[11] * d;
  if (!(lz > 0.0f && gz > 0.0f)) return false;
  const float lx = l[0] * a + l[1] * b + l[2] + l[3] * d, ly = l[4] * a + l[5] * b + l[6] + l[7] * d;
  const float ex = lx / lz - quads.left_x[i], ey = ly / lz - quads.left_y[i];
  if (!(ex * ex + ey * ey < limit)) return false;
  const float gx = g[0] * a + g[1] * b + g[2] + g[3] * d, gy = g[4] * a + g[5] * b + g[6] + g[7] * d;
  const float fx = gx / gz - quads.right_x[i], fy = gy / gz - quads.right_y[i];
  if (!(fx * fx + fy * fy < limit)) return false;
  const float tx = quads.tangent_x[i], ty = quads.tangent_y[i], tz = quads.tangent_z[i];
  return same_direction(l, lx, ly, lz, tx, ty, tz, quads.left_cos[i], quads.left_sin[i], min_cosine) &&
         same_direction(g, gx, gy, gz, tx, ty, tz, quads.right_cos[i], quads.right_sin[i], min_cosine);
}

}  // namespace

LaterCameras::LaterCameras(const StereoRig& rig, const Eigen::Isometry3d& current_from_previous) {
  write_projection(rig.left, current_from_previous, left);
  write_projection(rig.right, rig.right_from_left * current_from_previous, right);
}

double truncated_cost(const ScoringArrays& quads, const LaterCameras& cameras, double threshold) {
  const std::size_t count = quads.size();
  if (count == 0) return 1.0;
  const double sum = sum_row_blocks(count, 0.0, [&](std::size_t begin, std::size_t end, double& block_sum) {
    block_sum = cost_of_rows(quads, cameras, static_cast<float>(threshold * threshold), begin, end);
  });
  return sum / (threshold * threshold * static_cast<double>(count));
}

int select_inliers(const ScoringArrays& quads, const LaterCameras& cameras, double threshold, double max_angle,
                   std::vector<std::uint8_t>& inlier) {
  inlier.assign(quads.size(), 0);
  const float limit = static_cast<float>(threshold * threshold), min_cosine = static_cast<float>(std::cos(max_angle));
  return sum_row_blocks(quads.size(), 0, [&](std::size_t begin, std::size_t end, int& found) {
    for (std::size_t i = begin; i < end; ++i) {
      inlier[i] = is_inlier(quads, i, cameras, limit, min_cosine) ? 1 : 0;
      found += inlier[i];
    }
  });
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
