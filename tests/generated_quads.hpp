#pragma once
/// \file generated_quads.hpp  Quads with a known motion, generated from geometry, exact or with edge noise.

#include "common/matching_constants.hpp"
#include "motion/quads.hpp"
#include "testing.hpp"

namespace generated {

using quadedge::pose::OrientedPoint;
using quadedge::pose::QuadObservations;

/// Normal and uniform random numbers that are the same on every platform. None is drawn among the arguments of a call,
/// whose order is the compiler's choice.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53);
  }
  double normal() {
    const double radius = std::sqrt(-2.0 * std::log(uniform(1e-300, 1.0)));
    return radius * std::cos(uniform(0.0, 6.283185307179586));
  }
  Eigen::Vector3d unit() {
    const double z = normal(), y = normal(), x = normal();
    return Eigen::Vector3d(x, y, z).normalized();
  }
  Eigen::Isometry3d motion(double max_angle, double max_shift) {
    Eigen::Isometry3d m = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d axis = unit();
    m.linear() = Eigen::AngleAxisd(uniform(0, max_angle), axis).toRotationMatrix();
    const Eigen::Vector3d direction = unit();
    m.translation() = uniform(0, max_shift) * direction;
    return m;
  }

 private:
  std::mt19937_64 engine_;
};

/// Rectified rig of a car: f 700 px, baseline 0.54 m, 1241 x 376.
inline quadedge::StereoRig car_rig() {
  quadedge::StereoRig rig;
  rig.left = {700, 700, 620, 188, 1241, 376};
  rig.right = rig.left;
  rig.right_from_left.translation() = Eigen::Vector3d(-0.54, 0, 0);
  return rig;
}

/// A general rig: different cameras and image sizes, a mostly vertical baseline, converging by a few degrees.
inline quadedge::StereoRig crooked_rig() {
  quadedge::StereoRig rig;
  rig.left = {540, 545, 371, 230, 740, 460};
  rig.right = {600, 590, 330, 260, 640, 480};
  rig.right_from_left.linear() = Eigen::AngleAxisd(0.08, Eigen::Vector3d(1, 0.3, -0.5).normalized()).toRotationMatrix();
  rig.right_from_left.translation() = Eigen::Vector3d(0.05, -0.22, 0.03);
  return rig;
}

/// An oriented point as a stereo observation, exact.
inline quadedge::pose::StereoObservation observe(const quadedge::StereoRig& rig, const OrientedPoint& p) {
  const Eigen::Vector3d in_right = rig.right_from_left * p.point;
  const double step = 1e-6;  // central difference of the projection along the tangent
  const auto direction = [&](const quadedge::PinholeCamera& camera, const Eigen::Vector3d& point,
                             const Eigen::Vector3d& tangent) {
    const Eigen::Vector3d d = step * point.z() * tangent;
    const Eigen::Vector2d motion = camera.project(point + d) - camera.project(point - d);
    return std::atan2(motion.y(), motion.x());
  };
  return {rig.left.project(p.point), rig.right.project(in_right), direction(rig.left, p.point, p.tangent),
          direction(rig.right, in_right, rig.right_from_left.linear() * p.tangent)};
}

/// Appends an observation to the stereo edges of a frame, with its position as index.
inline void append(quadedge::StereoEdges& edges, const quadedge::pose::StereoObservation& observation) {
  const auto index = static_cast<std::int32_t>(edges.size());
  edges.left_index.push_back(index);
  edges.right_index.push_back(index);
  edges.left_x.push_back(static_cast<float>(observation.left.x()));
  edges.left_y.push_back(static_cast<float>(observation.left.y()));
  edges.left_direction.push_back(static_cast<float>(observation.left_direction));
  edges.right_x.push_back(static_cast<float>(observation.right.x()));
  edges.right_y.push_back(static_cast<float>(observation.right.y()));
  edges.right_direction.push_back(static_cast<float>(observation.right_direction));
  edges.ncc.push_back(0.9F);
}

/// Standard deviations: across and along an edge [px], of directions [rad].
struct Noise {
  double across = 0, along = 0, direction = 0;
};

/// Adds noise as matching does: the left position moves across and along the edge (unless `exact_left`); the right
/// position follows on its epipolar line and has an additional error along it, which depends on the edge's angle to it.
inline quadedge::pose::StereoObservation disturb(const quadedge::StereoRig& rig, const OrientedPoint& p,
                                                 const Noise& noise, bool exact_left, Random& random) {
  quadedge::pose::StereoObservation o = observe(rig, p);
  if (!exact_left) {
    const Eigen::Vector2d along(std::cos(o.left_direction), std::sin(o.left_direction));
    o.left +=
        noise.along * random.normal() * along + noise.across * random.normal() * Eigen::Vector2d(-along.y(), along.x());
  }
  const Eigen::Vector3d moved = rig.right_from_left * (p.point.z() * rig.left.ray(o.left));
  const Eigen::Vector3d farther = moved + 0.01 * (moved - rig.right_from_left.translation());
  o.right = rig.right.project(moved);
  const Eigen::Vector2d line = (rig.right.project(farther) - o.right).normalized();
  const double sine = line.x() * std::sin(o.right_direction) - line.y() * std::cos(o.right_direction);
  const double information =
      noise.across > 0 ? std::pow(sine / noise.across, 2) + (1 - sine * sine) / std::pow(noise.along, 2) : 0;
  if (information > 0) o.right += line * random.normal() / std::sqrt(information);
  o.left_direction += noise.direction * random.normal();
  o.right_direction += noise.direction * random.normal();
  return o;
}

/// Appends a quad made of four edges. \returns false, and appends nothing, if a stereo edge has no depth or tangent
inline bool append(quadedge::pose::QuadObservations& quads, const quadedge::StereoRig& rig,
                   const quadedge::pose::StereoObservation& previous, const quadedge::pose::StereoObservation& current,
                   float ncc, double direction_sigma = quadedge::pose::kSigmaDirection) {
  const auto before = quadedge::pose::measure(rig, previous, quadedge::kMinEpipolarAngle);
  const auto after = quadedge::pose::measure(rig, current, quadedge::kMinEpipolarAngle);
  if (!before || !after) return false;
  const std::size_t row = quads.size();
  quads.resize(row + 1);
  quads.set(row, *before, *after, current, ncc, 0, static_cast<std::int32_t>(row), direction_sigma);
  return true;
}

/// Parameters of the generated quads.
struct Problem {
  quadedge::StereoRig rig = car_rig();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  int quads = 500;
  double near = 5, far = 100;  ///< depths, uniform in the inverse [m]
  double outliers = 0;         ///< ratio with a wrong current edge
  Noise noise;
  double width_ratio = 1;  ///< fraction of the image, from its left border, with quads in the earlier frame
  int copies = 1;          ///< number of quads in a row, half a pixel apart along the tangent, that share one error
};

struct Generated {
  quadedge::pose::QuadObservations quads;
  std::vector<bool> correct;
};

inline OrientedPoint random_point(const quadedge::StereoRig& rig, double near, double far, Random& random,
                                  double width_ratio = 1) {
  const double y = random.uniform(0, rig.left.height), x = random.uniform(0, width_ratio * rig.left.width);
  const double depth = 1.0 / random.uniform(1.0 / far, 1.0 / near);
  return {depth * rig.left.ray({x, y}), random.unit()};
}

inline Generated generate(const Problem& problem, std::uint64_t seed) {
  Random random(seed);
  Generated result;
  while (static_cast<int>(result.quads.size()) < problem.quads) {
    const auto p = random_point(problem.rig, problem.near, problem.far, random, problem.width_ratio);
    const Eigen::Vector3d moved = problem.motion * p.point;
    if (moved.z() < 0.5 * problem.near) continue;
    const Eigen::Vector2d seen = problem.rig.left.project(moved);
    if (seen.x() < 0 || seen.y() < 0 || seen.x() > problem.rig.left.width || seen.y() > problem.rig.left.height)
      continue;
    const bool correct = random.uniform(0, 1) >= problem.outliers;
    const Random errors = random;  // copied, so that all copies of a quad share one error
    const double step = 0.5 * p.point.z() / problem.rig.left.fx;
    for (int copy = 0; copy < problem.copies; ++copy) {
      random = errors;
      const OrientedPoint here{p.point + copy * step * p.tangent, p.tangent};
      const OrientedPoint there{problem.motion * here.point, problem.motion.linear() * here.tangent};
      const auto before = disturb(problem.rig, here, problem.noise, true, random);
      auto after = disturb(problem.rig, there, problem.noise, false, random);
      if (!correct) {
        const auto wrong = observe(problem.rig, random_point(problem.rig, problem.near, problem.far, random));
        const double down = random.uniform(-60, 60), right = random.uniform(-60, 60);
        after.left = before.left + Eigen::Vector2d(right, down);
        after.right = after.left + (wrong.right - wrong.left);
        after.left_direction = wrong.left_direction;
        after.right_direction = wrong.right_direction;
      }
      const float ncc = static_cast<float>(random.uniform(0.8, 1.0));
      if (append(result.quads, problem.rig, before, after, ncc, problem.noise.direction))
        result.correct.push_back(correct);
    }
  }
  return result;
}

/// Noisy quads of two frames and a pose off their true motion, to check derivatives of residuals. Calls
/// `check(quads, i, rig, pose)` for every quad.
template <class Check>
void for_quads_off_motion(const Check& check) {
  Random random(20);
  for (const auto& rig : {car_rig(), crooked_rig()}) {
    Problem problem;
    problem.rig = rig;
    problem.near = 2;
    problem.far = 20;
    problem.quads = 30;
    problem.motion = random.motion(0.1, 0.5);
    problem.noise = {0.3, 0.5, 0.05};
    const auto generated = generate(problem, 21);
    const Eigen::Isometry3d pose = random.motion(0.02, 0.1) * problem.motion;
    for (std::size_t i = 0; i < generated.quads.size(); ++i) check(generated.quads, i, rig, pose);
  }
}

/// A car that drives on, by default with the noise of matching.
inline Problem drive(const Noise& noise = {0.15, 0.5, 0.035}) {
  Problem problem;
  problem.motion.linear() = Eigen::AngleAxisd(0.03, Eigen::Vector3d(0.1, 1, 0.1).normalized()).toRotationMatrix();
  problem.motion.translation() << 0.05, 0.02, -1.2;
  problem.noise = noise;
  return problem;
}

/// The quads of `problem` in their order, disturbed, after change(number, observation before, observation after) has
/// been made; those whose change returns false are left out.
template <class Change>
QuadObservations changed_quads(const Problem& problem, std::uint64_t seed, const Change& change) {
  Random random(seed);
  QuadObservations quads;
  for (int i = 0; static_cast<int>(quads.size()) < problem.quads;) {
    const auto p = random_point(problem.rig, problem.near, problem.far, random);
    const OrientedPoint moved{problem.motion * p.point, problem.motion.linear() * p.tangent};
    if (moved.point.z() < 0.5 * problem.near) continue;
    auto before = disturb(problem.rig, p, problem.noise, true, random);
    auto after = disturb(problem.rig, moved, problem.noise, false, random);
    if (change(i, before, after)) append(quads, problem.rig, before, after, 1.0f);
    ++i;
  }
  return quads;
}

/// Adds the quads of another scene.
inline void append(quadedge::pose::QuadObservations& quads, const quadedge::pose::QuadObservations& others) {
  const auto both = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  both(quads.previous, others.previous);
  both(quads.current, others.current);
  both(quads.ncc, others.ncc);
  both(quads.competing_clusters, others.competing_clusters);
  both(quads.match, others.match);
  for (auto column : quadedge::pose::kScoringColumns) both(quads.scoring.*column, others.scoring.*column);
  quads.scoring.half_length = others.scoring.half_length;
}

/// Rotation angle [rad] of the difference of two motions.
inline double rotation_error(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return Eigen::AngleAxisd(a.linear() * b.linear().transpose()).angle();
}
inline double translation_error(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm();
}

}  // namespace generated
