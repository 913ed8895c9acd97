/// \file measured_points.cpp  Information of a depth along the ray, and of angles along and across the edge.
#include "places/measured_points.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "common/matching_constants.hpp"
#include "geometry/undistortion.hpp"
#include "motion/quads.hpp"
#include "motion/residuals.hpp"

namespace quadedge::points {
namespace {

constexpr double kEdgeReach = 0.5;  // half length of the segment of curve that an edge represents [px]

/// Sum of the outer products of three orthogonal directions, divided by the squares of their standard deviations.
Eigen::Matrix3d information_of(const Eigen::Vector3d& ray, const Eigen::Vector3d& direction, double depth_sigma,
                               double along, double across) {
  // Pixel and depth are independent: the measurements are the depth along the ray and two angles of the ray.
  const Eigen::Vector3d forward = ray.normalized();
  const Eigen::Vector3d sideways = (direction - direction.dot(forward) * forward).normalized();
  const Eigen::Vector3d normal = forward.cross(sideways);
  const double range_sigma = depth_sigma * ray.norm();
  return forward * forward.transpose() / (range_sigma * range_sigma) +
         sideways * sideways.transpose() / (along * along) + normal * normal.transpose() / (across * across);
}

}  // namespace

std::vector<std::optional<MeasuredPoint>> measure_points(const StereoRig& rig, const StereoEdges& edges,
                                                         const ImageView& image, const Config& config) {
  const pose::NoiseModel noise(config.pose);
  const PinholeView view(image, rig.left_undistortion, rig.left);
  std::vector<std::optional<MeasuredPoint>> points;
  points.reserve(edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    auto& point = points.emplace_back();
    const auto measured = pose::measure(rig, pose::observation_of(edges, i), kMinEpipolarAngle);
    if (!measured) continue;
    const pose::OrientedPoint oriented = measured->oriented_point();
    const double sigma = noise.on_epipolar_line(measured->epipolar_sine);
    const double metres_per_pixel = oriented.point.z() / rig.left.fx;
    point = MeasuredPoint{};
    point->position = oriented.point;
    point->tangent = oriented.tangent;
    point->information = information_of(measured->ray, measured->direction, pose::depth_sigma(*measured, sigma),
                                        kEdgeReach * metres_per_pixel, noise.across * metres_per_pixel);
    point->inverse_depth = measured->inverse_depth;
    point->inverse_depth_per_pixel = measured->inverse_depth_per_pixel;
    point->disparity_sigma = sigma;
    point->metres_per_pixel = metres_per_pixel;
    point->grey = view.at(edges.left_x[i], edges.left_y[i]);
  }
  return points;
}

float largest_sigma(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(information, Eigen::EigenvaluesOnly);
  return static_cast<float>(1 / std::sqrt(solver.eigenvalues()[0]));
}

}  // namespace quadedge::points
