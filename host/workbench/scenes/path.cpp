/// \file path.cpp  Sums of sines with phases from the seed; image motion by projecting points at a fixed depth.
#include "scenes/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "quadedge/camera.hpp"
#include "scenes/hash.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMotionDepth = 2.5;  // [m], depth of the points whose image motion is measured

/// An ellipse in the horizontal plane, traversed in 114 frames, while height and attitude sway at other frequencies.
/// Stays within 0.7 m of the start at all times: steps of 1 to 4 cm and less than 1 degree per frame.
Isometry3d room_from_ellipse(double phase) {
  const double p = 0.055 * phase;
  const double yaw = -0.14 * std::sin(p) + 0.03 * std::sin(1.7 * p + 1.0);  // towards the middle of the scene
  const double pitch = 0.035 * std::sin(1.3 * p + 0.4);
  const double roll = 0.05 * std::sin(1.1 * p + 2.0);
  return pose({0.50 * std::sin(p), 0.10 * std::sin(0.73 * p + 0.6), -0.24 * std::cos(p) + 0.02 * std::sin(2.1 * p)},
              yaw, pitch, roll);
}
Isometry3d ellipse(double phase) {
  if (phase == 0.0) return Isometry3d::Identity();  // exactly
  return room_from_ellipse(0.0).inverse() * room_from_ellipse(phase);
}

/// A sum of sines.
class Sway {
 public:
  struct Wave {
    double amplitude, rhythm;  // [rad per frame]
  };
  /// Random phases; each frequency is changed by up to 8 %.
  Sway(std::initializer_list<Wave> waves, Random& random) {
    for (const Wave& wave : waves) {
      const double rhythm = wave.rhythm * random(0.92, 1.08);
      terms_.push_back({wave.amplitude, rhythm, random(0.0, 2.0 * kPi)});
    }
  }
  double operator()(double phase) const {
    double sum = 0.0;
    for (const Term& term : terms_) sum += term.amplitude * std::sin(term.rhythm * phase + term.start);
    return sum;
  }

 private:
  struct Term {
    double amplitude, rhythm, start;
  };
  std::vector<Term> terms_;
};

/// A camera held by a person who walks to and fro within 1.2 x 0.8 m at 0.5 to 1 m/s. Two steps per second raise and
/// sway the camera; the hand rotates it by up to 5 degrees at up to 3 Hz.
std::function<Isometry3d(double)> handheld(std::uint64_t seed) {
  Random random(combine(seed, 7));
  const Sway x({{0.52, 0.062}, {0.02, 0.28}}, random), y({{0.05, 0.021}, {0.022, 0.57}}, random);
  const Sway z({{0.34, 0.051}, {0.012, 0.55}}, random);
  const Sway yaw({{2.0 * kDegree, 0.23}, {1.15 * kDegree, 0.45}, {0.42 * kDegree, 0.85}}, random);
  const Sway pitch({{1.2 * kDegree, 0.19}, {0.8 * kDegree, 0.55}, {0.32 * kDegree, 0.92}}, random);
  const Sway roll({{1.8 * kDegree, 0.17}, {0.8 * kDegree, 0.41}}, random);
  return [=](double phase) {
    return pose({x(phase), y(phase), z(phase) - 0.35}, yaw(phase), pitch(phase), roll(phase));
  };
}

/// A car that drives along the lane, with the camera axis along its track and slight pitch and roll of the body.
std::function<Isometry3d(double)> drive(std::uint64_t seed, const Lane& lane) {
  Random random(combine(seed, 8));
  const Sway speed_change({{1.1, 0.08}}, random);  // [frames of travel]
  const Sway bounce({{0.006, 0.35}, {0.003, 0.74}}, random);
  const Sway pitch({{0.35 * kDegree, 0.31}, {0.15 * kDegree, 0.67}}, random);
  const Sway roll({{0.3 * kDegree, 0.22}}, random);
  const double rhythm = 2.0 * kPi / lane.length, start = random(0.0, 2.0 * kPi), lateral = 0.02 * lane.length;
  return [=](double phase) {
    const double distance = lane.step * (phase + speed_change(phase) - speed_change(0.0));
    const double track = rhythm * distance + start;
    return lane.world_from_start * pose({lateral * (std::sin(track) - std::sin(start)), bounce(phase), distance},
                                        std::atan(lateral * rhythm * std::cos(track)), pitch(phase), roll(phase));
  };
}

/// A closed loop of `period` frames, at most 5 cm each and up to 1.2 m wide.
std::function<Isometry3d(double)> loop(std::uint64_t seed, int period) {
  Random random(combine(seed, 9));
  const double size = std::min(1.0, 0.05 * period / 3.6);  // of 3.6 m
  const double a = random(0.0, 2.0 * kPi), b = random(0.0, 2.0 * kPi), c = random(0.0, 2.0 * kPi);
  return [=](double phase) {
    const double wrapped = std::fmod(phase, static_cast<double>(period));  // so that the last pose equals the first
    const double p = 2.0 * kPi * wrapped / period;
    const Vector3d place(0.6 * std::sin(p), 0.06 * std::sin(2.0 * p + a), 0.5 * (std::cos(p) - 1.0));
    return pose(size * place, size * 0.1 * std::sin(p + b), size * 0.03 * std::sin(2.0 * p + c),
                size * 0.05 * std::sin(p + a));
  };
}

}  // namespace

CameraPath::CameraPath(const std::string& name, std::uint64_t seed, int frames, const Lane& lane)
    : longest_(std::numeric_limits<int>::max()), typical_(600) {
  if (name == "handheld") {
    motion_ = handheld(seed);
  } else if (name == "drive") {
    motion_ = drive(seed, lane);
    longest_ = static_cast<int>(lane.length / lane.step) - 1;  // margin of 2 frames for variations of the speed
    typical_ = longest_;
  } else if (name == "loop") {
    typical_ = std::max(1, frames - 1);
    motion_ = loop(seed, typical_);
  } else {
    motion_ = ellipse;
  }
  world_from_scene_ = motion_(0.0).inverse();
}

Isometry3d CameraPath::world_from_left(double phase) const {
  const Isometry3d pose = motion_(phase);
  if (pose.matrix() == motion_(0.0).matrix()) return Isometry3d::Identity();  // exactly
  return world_from_scene_ * pose;
}

double CameraPath::image_motion(const PinholeCamera& camera, double phase, double periods) const {
  const Isometry3d before = motion_(phase - 0.5 * periods).inverse(), after = motion_(phase + 0.5 * periods).inverse();
  const Isometry3d scene_from_left = motion_(phase);
  const double right = camera.width - 1.0, bottom = camera.height - 1.0;
  const std::array<Vector2d, 5> pixels = {Vector2d(0.5 * right, 0.5 * bottom), Vector2d(0.0, 0.0), Vector2d(right, 0.0),
                                          Vector2d(0.0, bottom), Vector2d(right, bottom)};
  double largest = 0.0;
  for (const Vector2d& pixel : pixels) {
    const Vector3d point = scene_from_left * Vector3d(kMotionDepth * camera.ray(pixel));
    largest = std::max(largest, (camera.project(after * point) - camera.project(before * point)).norm());
  }
  return largest;
}

double CameraPath::mean_image_motion(const PinholeCamera& camera) const {
  constexpr double kHalf = 0.25;
  const Vector2d middle(0.5 * (camera.width - 1), 0.5 * (camera.height - 1));
  double sum = 0.0;
  for (int frame = 0; frame < typical_; ++frame) {
    const Vector3d point = motion_(frame) * Vector3d(kMotionDepth * camera.ray(middle));
    const Vector2d before = camera.project(motion_(frame - kHalf).inverse() * point);
    const Vector2d after = camera.project(motion_(frame + kHalf).inverse() * point);
    sum += (after - before).norm() / (2.0 * kHalf);
  }
  return sum / typical_;
}

}  // namespace quadedge::synthetic
