#include "synthetic/disturbance.hpp"

#include <algorithm>
#include <cmath>

#include "synthetic/hash.hpp"
#include "synthetic/path.hpp"

namespace quadedge::synthetic {
namespace {

constexpr double kBoardDepth = 1.15;      // [m] before nearly everything in the scenes, behind their nearest depth
constexpr double kBoardRhythm = 0.11;     // [rad per frame]
constexpr double kBlurDepth = 2.5;        // [m] of the point that measures the blur
constexpr double kLongestExposure = 2.0;  // [frame periods]
constexpr double kMomentsPerPixel = 2.0;  // of blur

/// How far the image's middle moves per frame period around `frame` [px].
double image_speed(const PinholeCamera& camera, int frame) {
  constexpr double kHalf = 0.25;
  const Eigen::Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  const Eigen::Vector3d point = world_from_left(frame) * Eigen::Vector3d(kBlurDepth * camera.ray(middle));
  const Eigen::Vector2d before = camera.project(world_from_left(frame - kHalf).inverse() * point);
  const Eigen::Vector2d after = camera.project(world_from_left(frame + kHalf).inverse() * point);
  return (after - before).norm() / (2.0 * kHalf);
}

}  // namespace

MovingBoard::MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed) {
  const double side = std::sqrt(fraction);  // of the image's sides
  half_width_ = 0.5 * side * left.width / left.fx * kBoardDepth;
  half_height_ = 0.5 * side * left.height / left.fy * kBoardDepth;
  // Half of what would bring it to the border.
  sway_x_ = 0.5 * (1.0 - side) / side * half_width_;
  sway_y_ = 0.5 * (1.0 - side) / side * half_height_;
  TextureStyle style;
  style.feature = 0.16;
  style.levels = 3;
  style.alignment = 0.4;
  texture_ = std::make_shared<Texture>(style, combine(seed, 4), half_width_, half_height_, 0.5 * kBoardDepth / left.fx);
}

PlaneSurface MovingBoard::surface(double phase) const {
  const double p = kBoardRhythm * phase;
  Eigen::Isometry3d left_from_board = Eigen::Isometry3d::Identity();
  left_from_board.translation() << sway_x_ * std::sin(p + 0.5), sway_y_ * std::sin(1.3 * p),
      kBoardDepth + 0.05 * std::sin(0.8 * p);
  left_from_board.linear() = (Eigen::AngleAxisd(0.12 * std::sin(0.9 * p), Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(0.08 * std::sin(1.2 * p + 1.0), Eigen::Vector3d::UnitZ()))
                                 .toRotationMatrix();
  return PlaneSurface(world_from_left(phase) * left_from_board, half_width_, half_height_, texture_);
}

Radiance expose(const Scene& scene, const MovingBoard* board, const StereoRig& rig, Side side, int frame, double blur,
                int supersampling, int threads) {
  const PinholeCamera& camera = side == Side::right ? rig.right : rig.left;
  const auto at = [&](double phase, int rays) {
    Eigen::Isometry3d camera_from_world = world_from_left(phase).inverse();
    if (side == Side::right) camera_from_world = rig.right_from_left * camera_from_world;
    if (board == nullptr) return render(scene, camera, camera_from_world, rays, threads);
    const PlaneSurface surface = board->surface(phase);
    return render(scene, camera, camera_from_world, rays, threads, &surface);
  };
  if (!(blur > 0.0)) return at(frame, supersampling);
  const double exposure = std::min(blur / image_speed(rig.left, frame), kLongestExposure);  // [frame periods]
  // An odd number, so that the moment in the middle is the frame's own; the moments spread the rays, so that each needs
  // fewer.
  const int moments = 2 * static_cast<int>(std::ceil(0.5 * kMomentsPerPixel * blur)) + 1;
  const int rays = std::max(2, supersampling / 2);
  Radiance mean = at(frame, rays);
  for (int i = 0; i < moments; ++i) {
    if (2 * i + 1 == moments) continue;
    const Radiance moment = at(frame + exposure * ((i + 0.5) / moments - 0.5), rays);
    for (std::size_t pixel = 0; pixel < mean.grey.size(); ++pixel) mean.grey[pixel] += moment.grey[pixel];
  }
  for (double& grey : mean.grey) grey /= moments;
  return mean;
}

}  // namespace quadedge::synthetic
