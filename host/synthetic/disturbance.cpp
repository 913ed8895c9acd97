#include "synthetic/disturbance.hpp"

#include <algorithm>
#include <cmath>

#include "synthetic/dead_leaves.hpp"
#include "synthetic/hash.hpp"

namespace quadedge::synthetic {
namespace {

constexpr double kBoardDepth = 1.15;      // [m], in front of nearly everything but beyond the nearest depth
constexpr double kBoardRhythm = 0.11;     // [rad per frame]
constexpr double kMomentsPerPixel = 2.0;  // of image motion

}  // namespace

MovingBoard::MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed) {
  const double side = std::sqrt(fraction);  // of the image's sides
  half_width_ = 0.5 * side * left.width / left.fx * kBoardDepth;
  half_height_ = 0.5 * side * left.height / left.fy * kBoardDepth;
  // Half the amplitude at which it would reach the border.
  sway_x_ = 0.5 * (1.0 - side) / side * half_width_;
  sway_y_ = 0.5 * (1.0 - side) / side * half_height_;
  TextureStyle style;
  style.feature = 0.16;
  style.levels = 3;
  style.alignment = 0.4;
  texture_ = std::make_shared<Texture>(dead_leaves(style, combine(seed, 4)), half_width_, half_height_,
                                       0.5 * kBoardDepth / left.fx);
}

PlaneSurface MovingBoard::surface(double phase, const Eigen::Isometry3d& scene_from_left) const {
  const double p = kBoardRhythm * phase;
  Eigen::Isometry3d left_from_board = Eigen::Isometry3d::Identity();
  left_from_board.translation() << sway_x_ * std::sin(p + 0.5), sway_y_ * std::sin(1.3 * p),
      kBoardDepth + 0.05 * std::sin(0.8 * p);
  left_from_board.linear() = (Eigen::AngleAxisd(0.12 * std::sin(0.9 * p), Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(0.08 * std::sin(1.2 * p + 1.0), Eigen::Vector3d::UnitZ()))
                                 .toRotationMatrix();
  return PlaneSurface(scene_from_left * left_from_board, half_width_, half_height_, texture_);
}

Radiance expose(const Exposure& exposure, int frame, Side side) {
  const auto at = [&](double phase, int rays) {
    const Eigen::Isometry3d scene_from_left = exposure.path.scene_from_left(phase);
    Eigen::Isometry3d camera_from_scene = scene_from_left.inverse();
    if (side == Side::right) camera_from_scene = exposure.rig.right_from_left * camera_from_scene;
    if (exposure.board == nullptr)
      return render(exposure.scene, exposure.rays, camera_from_scene, rays, exposure.threads);
    const PlaneSurface surface = exposure.board->surface(phase, scene_from_left);
    return render(exposure.scene, exposure.rays, camera_from_scene, rays, exposure.threads, &surface);
  };
  if (!(exposure.duration > 0.0)) return at(frame, exposure.supersampling);
  // An odd number, so that the middle moment is the time of the frame; the rays are spread over the moments, so that
  // each moment needs fewer.
  const double motion = exposure.path.image_motion(exposure.rig.left, frame, exposure.duration);
  const int moments = 2 * static_cast<int>(std::ceil(0.5 * kMomentsPerPixel * motion)) + 1;
  const int rays = std::max(2, exposure.supersampling / 2);
  Radiance mean = at(frame, rays);
  for (int i = 0; i < moments; ++i) {
    if (2 * i + 1 == moments) continue;
    const Radiance moment = at(frame + exposure.duration * ((i + 0.5) / moments - 0.5), rays);
    for (std::size_t pixel = 0; pixel < mean.grey.size(); ++pixel) mean.grey[pixel] += moment.grey[pixel];
  }
  for (double& grey : mean.grey) grey /= moments;
  return mean;
}

}  // namespace quadedge::synthetic
