/// \file epipolar_geometry.cpp  Lines from the homography at infinity and the epipole; rows as planes of the baseline.
#include "geometry/epipolar_geometry.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/matching_constants.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

constexpr float kSegmentTolerance = 1.0f;  // px beyond each end of the segment, doc/method.md section 3 filter 2
constexpr float kWholeImage = 1e5f;        // px, longer than any epipolar line

/// Maximum ratio between the sines of the angles that matching edges form with their epipolar lines.
constexpr float kDirectionSlack = 1.2F;

/// The numbering of the pixel at which a right point would lie without `error`.
EpipolarRows corrected(EpipolarRows rows, const StereoRig& rig, const RectificationError& error) {
  const Eigen::Vector2d middle(rig.right.cx, rig.right.cy);
  const Eigen::Vector3d t = rig.right.matrix() * rig.right_from_left.translation();
  const Eigen::Vector2d along = (t.head<2>() - t.z() * middle).normalized();
  const RectificationError::Terms terms = error.in_pixels(rig.right.width, rig.right.height);
  const auto by = [&](float x, float y) {
    return static_cast<double>(x) * along.y() - static_cast<double>(y) * along.x();
  };
  const auto move = [&](float& x, float& y, float& one) {
    const double moved = by(x, y);
    x -= static_cast<float>(moved * terms[1]);
    y -= static_cast<float>(moved * terms[2]);
    one -= static_cast<float>(moved * terms[0]);
  };
  move(rows.across_x, rows.across_y, rows.across_1);
  move(rows.forward_x, rows.forward_y, rows.forward_1);
  const auto at_middle = [&](float x, float y, float one) {
    return static_cast<double>(x) * middle.x() + static_cast<double>(y) * middle.y() + static_cast<double>(one);
  };
  const double depth = at_middle(rows.forward_x, rows.forward_y, rows.forward_1),
               row = at_middle(rows.across_x, rows.across_y, rows.across_1) / depth,
               per_px = (by(rows.across_x, rows.across_y) - row * by(rows.forward_x, rows.forward_y)) / depth;
  rows.bend_xx = static_cast<float>(per_px * terms[3]);
  rows.bend_xy = static_cast<float>(per_px * terms[4]);
  rows.bend_yy = static_cast<float>(per_px * terms[5]);
  return rows;
}

}  // namespace

double RectificationError::at(double u, double v) const {
  return offset + (slope_x + bend_xx * u + bend_xy * v) * u + (slope_y + bend_yy * v) * v;
}

double RectificationError::largest() const {
  constexpr int kSteps = 8;
  double most = 0;
  for (int row = 0; row <= kSteps; ++row)
    for (int column = 0; column <= kSteps; ++column)
      most = std::max(
          most, std::abs(at(static_cast<double>(column) / kSteps - 0.5, static_cast<double>(row) / kSteps - 0.5)));
  return most;
}

RectificationError::Terms RectificationError::in_pixels(int width, int height) const {
  return {offset - 0.5 * (slope_x + slope_y) + 0.25 * (bend_xx + bend_xy + bend_yy),
          (slope_x - bend_xx - 0.5 * bend_xy) / width,
          (slope_y - bend_yy - 0.5 * bend_xy) / height,
          bend_xx / width / width,
          bend_xy / width / height,
          bend_yy / height / height};
}

EpipolarGeometry make_epipolar_geometry(const StereoRig& rig, const StereoConfig& config) {
  if (config.max_disparity <= 0 && config.min_depth <= 0) {
    throw UsageError("stereo.max_disparity [px] or stereo.min_depth [m] must be given to limit the disparity");
  }
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const Eigen::Vector3d translation = rig.right_from_left.translation();
  const Eigen::Matrix3d h = rig.right.matrix() * rotation * rig.left.matrix().inverse();
  const Eigen::Vector3d t = rig.right.matrix() * translation;
  // Scaled to unit length, because only its direction matters.
  const Eigen::Vector3d epipole = (rig.left.matrix() * (-(rotation.transpose() * translation))).normalized();

  EpipolarGeometry geometry{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      geometry.h[static_cast<std::size_t>(3 * row + column)] = static_cast<float>(h(row, column));
    }
    geometry.t[static_cast<std::size_t>(row)] = static_cast<float>(t(row));
    geometry.epipole[static_cast<std::size_t>(row)] = static_cast<float>(epipole(row));
  }
  geometry.inverse_min_depth = config.max_disparity > 0 ? 0.0f : static_cast<float>(1.0 / config.min_depth);
  geometry.max_disparity = static_cast<float>(config.max_disparity);
  geometry.tolerance = kSegmentTolerance;
  geometry.epipolar_distance = static_cast<float>(config.epipolar_distance);
  geometry.orientation = static_cast<float>(config.orientation_rad());
  geometry.min_epipolar_sine = static_cast<float>(std::sin(kMinEpipolarAngle));
  return geometry;
}

EpipolarGeometry corrected(EpipolarGeometry g, const RectificationError& error, const StereoRig& rig) {
  const EpipolarLine middle = epipolar_line(g, static_cast<float>(rig.left.cx), static_cast<float>(rig.left.cy));
  if (!middle.valid) return g;
  const auto ex = static_cast<double>(middle.ex), ey = static_cast<double>(middle.ey);
  const RectificationError::Terms terms = error.in_pixels(rig.right.width, rig.right.height);
  for (std::size_t k = 0; k < terms.size(); ++k) g.across[k] = static_cast<float>(terms[k]);
  const double x = error.slope_x / rig.right.width, y = error.slope_y / rig.right.height, roll = -x * ex - y * ey;
  const double along[3] = {roll * ey, -roll * ex, roll * (rig.right.cy * ex - rig.right.cx * ey)};
  for (std::size_t k = 0; k < 3; ++k) {
    const double shift = along[0] * static_cast<double>(g.h[k]) + along[1] * static_cast<double>(g.h[3 + k]) +
                         along[2] * static_cast<double>(g.h[6 + k]);
    g.h[k] += static_cast<float>(shift * ex);
    g.h[3 + k] += static_cast<float>(shift * ey);
  }
  return g;
}

EpipolarGeometry without_limits(EpipolarGeometry geometry, bool all_disparities, bool all_orientations) {
  if (all_disparities) geometry.tolerance = kWholeImage;
  if (all_orientations) geometry.orientation = 4.0f;  // larger than any angle
  return geometry;
}

EpipolarLine epipolar_line(const EpipolarGeometry& g, float x, float y) {
  EpipolarLine line;
  const float hx = g.h[0] * x + g.h[1] * y + g.h[2];
  const float hy = g.h[3] * x + g.h[4] * y + g.h[5];
  const float hz = g.h[6] * x + g.h[7] * y + g.h[8];
  line.x = hx / hz;
  line.y = hy / hz;
  const float dx = g.t[0] - line.x * g.t[2];
  const float dy = g.t[1] - line.y * g.t[2];
  const float length = std::sqrt(dx * dx + dy * dy);
  line.valid = hz > 1e-6f && length > 1e-6f;
  line.ex = dx / length;
  line.ey = dy / length;
  line.s_max = g.max_disparity;
  if (g.inverse_min_depth > 0.0f) {
    const float w = g.inverse_min_depth;
    const float nz = hz + w * g.t[2];
    const float nx = (hx + w * g.t[0]) / nz - line.x;
    const float ny = (hy + w * g.t[1]) / nz - line.y;
    line.s_max = nz > 1e-6f ? std::sqrt(nx * nx + ny * ny) : 1e5f;
  }
  const float px = line.x, py = line.y, ex = line.ex, ey = line.ey;
  const float by_x = g.across[3] * px + g.across[4] * py, by_y = g.across[5] * py;
  const float across = g.across[0] + (g.across[1] + by_x) * px + (g.across[2] + by_y) * py;
  const float turn = (g.across[1] + by_x + g.across[3] * px) * ex + (g.across[2] + 2.0f * by_y + g.across[4] * px) * ey;
  line.x += across * ey;
  line.y -= across * ex;
  line.ex += turn * ey;
  line.ey -= turn * ex;
  return line;
}

float left_epipolar_sine(const EpipolarGeometry& g, float x, float y, float direction) {
  const float dx = g.epipole[0] - g.epipole[2] * x;
  const float dy = g.epipole[1] - g.epipole[2] * y;
  return std::fabs(std::cos(direction) * dy - std::sin(direction) * dx) / std::sqrt(dx * dx + dy * dy);
}

EpipolarRows epipolar_rows(const StereoRig& rig, Side side) {
  const Eigen::Matrix3d rotation = rig.right_from_left.linear();
  const Eigen::Vector3d baseline = -(rotation.transpose() * rig.right_from_left.translation());
  const Eigen::Vector3d along = baseline.normalized();
  const Eigen::Vector3d axes = Eigen::Vector3d::UnitZ() + rotation.transpose() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d forward = axes - axes.dot(along) * along;
  // Without such a plane (one camera behind the other), any plane serves.
  forward = forward.norm() > 1e-6 * axes.norm() ? Eigen::Vector3d(forward.normalized()) : along.unitOrthogonal();
  const Eigen::Vector3d across = forward.cross(along);
  const Eigen::Matrix3d rays = side == Side::left
                                   ? Eigen::Matrix3d(rig.left.matrix().inverse())
                                   : Eigen::Matrix3d(rotation.transpose() * rig.right.matrix().inverse());
  const Eigen::RowVector3f above = (rig.left.fy * across.transpose() * rays).cast<float>();
  const Eigen::RowVector3f below = (forward.transpose() * rays).cast<float>();
  return {above.x(), above.y(), above.z(), below.x(), below.y(), below.z(), 0, 0, 0};
}

SelectionArguments selection_arguments(const StereoRig& rig, Side side, const RectificationError& error) {
  const PinholeCamera& camera = side == Side::left ? rig.left : rig.right;
  const EpipolarRows rows = epipolar_rows(rig, side);
  return {camera.width, camera.height, side == Side::left ? rows : corrected(rows, rig, error),
          static_cast<float>(std::sin(kMinEpipolarAngle)), side == Side::left ? 1.0F : kDirectionSlack};
}

}  // namespace quadedge
