/// \file pair_adjustment.cpp  Levenberg-Marquardt, Cauchy weights; eliminates points, then motions (Schur complement).
#include "calibration/pair_adjustment.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <tbb/parallel_for.h>

#include "common/numeric.hpp"
#include "geometry/calibration.hpp"
#include "geometry/lens_mapping.hpp"
#include "geometry/uncertain_pose.hpp"

namespace quadedge::rig {
namespace {

/// A view counts as if its error were this, ten times what it is: errors of views are not independent. [px]
constexpr double kViewSigma = 3;
/// Distances beyond this count less (Cauchy). [px]
constexpr double kViewScale = 0.6;
constexpr double kOutOfView = 1e3;                         // px, the error of a view that the lens does not show
constexpr double kLargestTurn = 0.3, kNearestPoint = 1.6;  // rad; baselines over depth
constexpr double kAgreeing = 8;                            // px
constexpr double kPointFloor = 1e-4;                       // of the information of a view
constexpr int kMaxSteps = 20;

constexpr int kMotion = 6, kRows = 2 * kViews;
using Rows = Eigen::Matrix<double, kRows, 1>;
using ByPoint = Eigen::Matrix<double, kRows, 3>;
using ByRest = Eigen::Matrix<double, kRows, Eigen::Dynamic, 0, kRows, kMotion + 32>;  // motion, then unknowns

Side side_of(int view) { return view % 2 == 0 ? Side::left : Side::right; }

}  // namespace

/// A calibration, ready to project, and what its numbers change.
struct PairAdjustment::Cameras {
  Cameras(const RigUnknowns& of, const Eigen::VectorXd& values, bool is_varied)
      : unknowns(of),
        calibration(of.at(values)),
        mapping{LensMapping(calibration.left), LensMapping(calibration.right)},
        rotation(calibration.right_from_left.linear()),
        baseline(calibration.right_from_left.translation()) {
    if (!is_varied) return;
    for (const Side side : kSides) {
      for (const int parameter : of.lens_parameters(side)) {
        Lens changed = lens(side);
        changed.parameters[static_cast<std::size_t>(parameter)] += kLensStep;
        varied[index_of(side)].emplace_back(changed);
      }
    }
  }

  static constexpr double kLensStep = 1e-6;

  const Lens& lens(Side side) const { return side == Side::left ? calibration.left : calibration.right; }
  std::optional<Eigen::Vector2d> project(Side side, const Eigen::Vector3d& point) const {
    return mapping[index_of(side)].project(point);
  }
  /// Derivative of a pixel by the point. \returns whether it exists
  bool slope(Side side, const Eigen::Vector3d& point, Eigen::Matrix<double, 2, 3>& result) const {
    const double step = 1e-6 * point.norm();
    for (int axis = 0; axis < 3; ++axis) {
      const auto ahead = project(side, point + step * Eigen::Vector3d::Unit(axis)),
                 behind = project(side, point - step * Eigen::Vector3d::Unit(axis));
      if (!ahead || !behind) return false;
      result.col(axis) = (*ahead - *behind) / (2 * step);
    }
    return true;
  }
  /// Derivative of a pixel by the unknowns of its camera.
  RigUnknowns::PixelByUnknowns by_camera(Side side, const Eigen::Vector3d& point) const {
    const auto s = index_of(side);
    const Eigen::Vector2d pixel = project(side, point).value_or(Eigen::Vector2d::Zero());
    Eigen::Matrix<double, 2, Eigen::Dynamic, 0, 2, 16> own =
        Eigen::MatrixXd::Zero(2, RigUnknowns::kFirstLensParameter + static_cast<Eigen::Index>(varied[s].size()));
    own(0, RigUnknowns::kFocalX) = pixel.x() - lens(side).camera.cx;
    own(1, RigUnknowns::kFocalY) = pixel.y() - lens(side).camera.cy;
    own(0, RigUnknowns::kCentreX) = own(1, RigUnknowns::kCentreY) = 1;
    for (std::size_t k = 0; k < varied[s].size(); ++k)
      if (const auto moved = varied[s][k].project(point))
        own.col(RigUnknowns::kFirstLensParameter + static_cast<Eigen::Index>(k)) = (*moved - pixel) / kLensStep;
    return own * unknowns.by_unknowns(side);
  }

  const RigUnknowns& unknowns;
  StereoCalibration calibration;
  LensMapping mapping[2];
  std::vector<LensMapping> varied[2];
  Eigen::Matrix3d rotation;
  Eigen::Vector3d baseline;
};

/// The views of one point: distances from where they are seen, weighted, and derivatives.
struct PairAdjustment::Terms {
  Rows error = Rows::Zero();  ///< px, not weighted
  Rows weight = Rows::Zero();
  double cost = 0;
  ByPoint by_point;
  ByRest by_rest;

  /// Where a point is in the camera of a view, times its inverse depth.
  static Eigen::Vector3d place(const Cameras& cameras, const Eigen::Isometry3d& motion, const Point& point, int view) {
    Eigen::Vector3d at = point.ray;
    if (view >= kLeftSecond) at = motion.linear() * at + point.inverse_depth * motion.translation();
    return side_of(view) == Side::left ? at : cameras.rotation * at + point.inverse_depth * cameras.baseline;
  }

  void measure(const Cameras& cameras, const Eigen::Isometry3d& motion, const Point& point, const SeenPoint& seen,
               double scale) {
    cost = 0;
    for (int view = 0; view < kViews; ++view) {
      auto here = error.segment<2>(2 * view);
      here.setZero();
      weight.segment<2>(2 * view).setZero();
      if (!seen.is_seen[static_cast<std::size_t>(view)]) continue;
      const auto pixel = cameras.project(side_of(view), place(cameras, motion, point, view));
      here = pixel ? Eigen::Vector2d(*pixel - seen.at[static_cast<std::size_t>(view)])
                   : Eigen::Vector2d::Constant(kOutOfView);
      const double square = here.squaredNorm() / (scale * scale), base = 1 / (kViewSigma * kViewSigma);
      if (pixel) weight.segment<2>(2 * view).setConstant(base / (1 + square));
      cost += base * scale * scale * std::log1p(square);
    }
  }

  /// \param learns whether by_rest has the unknowns
  void differentiate(const Cameras& cameras, const Eigen::Isometry3d& motion, const Point& point, bool learns) {
    const Eigen::Index unknowns = learns ? cameras.unknowns.count() : 0;
    by_point.setZero();
    by_rest.setZero(kRows, kMotion + unknowns);
    for (int view = 0; view < kViews; ++view) {
      if (weight[2 * view] == 0) continue;
      const Side side = side_of(view);
      const Eigen::Vector3d at = place(cameras, motion, point, view);
      Eigen::Matrix<double, 2, 3> by_place;
      if (!cameras.slope(side, at, by_place)) {
        weight.segment<2>(2 * view).setZero();
        continue;
      }
      Eigen::Matrix<double, 3, 3> by_parts;  // of the place, by the tangents and the inverse depth
      by_parts << point.beside, Eigen::Vector3d::Zero();
      Eigen::Matrix<double, 3, kMotion> by_motion = Eigen::Matrix<double, 3, kMotion>::Zero();
      if (view >= kLeftSecond) {
        by_motion << -pose::cross_matrix(motion.linear() * point.ray),
            point.inverse_depth * Eigen::Matrix3d::Identity();
        by_parts = (motion.linear() * by_parts).eval();
        by_parts.col(2) = motion.translation();
      }
      if (side == Side::right) {
        by_parts = (cameras.rotation * by_parts).eval();
        by_parts.col(2) += cameras.baseline;
        by_motion = (cameras.rotation * by_motion).eval();
      }
      by_point.middleRows<2>(2 * view) = by_place * by_parts;
      by_rest.block<2, kMotion>(2 * view, 0) = by_place * by_motion;
      if (!learns) continue;
      auto by_rig = by_rest.block(2 * view, kMotion, 2, unknowns);
      by_rig = cameras.by_camera(side, at);
      if (side == Side::left) continue;
      const int first = cameras.unknowns.first_rotation();
      const Eigen::Vector3d turned = at - point.inverse_depth * cameras.baseline;
      by_rig.middleCols<3>(first) -= by_place * pose::cross_matrix(turned) * cameras.unknowns.rotation_axes();
      by_rig.middleCols<2>(first + 3) += by_place * cameras.unknowns.baseline_slope() * point.inverse_depth;
    }
  }
};

/// The normal equations of a pair: what remains of its motion and the unknowns, and what its points then are.
struct PairAdjustment::Step {
  Eigen::MatrixXd normal;  ///< motion, then unknowns; points eliminated
  Eigen::VectorXd slope;
  Eigen::MatrixXd reduced;  ///< unknowns; motion eliminated
  Eigen::VectorXd reduced_slope;
  double cost = 0;
  struct PointStep {
    Eigen::Matrix3d inverse;
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMotion + 32> by_rest;
    Eigen::Vector3d slope;
  };
  std::vector<PointStep> points;
  Eigen::LDLT<Eigen::Matrix<double, kMotion, kMotion>> motion;

  void add(Terms& terms, double damping, const Eigen::Vector3d& floor, PointStep& point) {
    const ByRest weighted = terms.weight.asDiagonal() * terms.by_rest;
    Eigen::Matrix3d own = terms.by_point.transpose() * terms.weight.asDiagonal() * terms.by_point;
    own.diagonal() += damping * own.diagonal() + floor;
    point.inverse = own.inverse();
    point.by_rest = terms.by_point.transpose() * weighted;
    point.slope = terms.by_point.transpose() * terms.weight.cwiseProduct(terms.error);
    normal += terms.by_rest.transpose() * weighted - point.by_rest.transpose() * point.inverse * point.by_rest;
    slope += weighted.transpose() * terms.error - point.by_rest.transpose() * (point.inverse * point.slope);
    cost += terms.cost;
  }

  void eliminate_motion(double damping) {
    const Eigen::Index unknowns = normal.rows() - kMotion;
    Eigen::Matrix<double, kMotion, kMotion> own = normal.topLeftCorner<kMotion, kMotion>();
    own.diagonal() += damping * own.diagonal() + Eigen::Matrix<double, kMotion, 1>::Constant(1e-9);
    motion.compute(own);
    const Eigen::MatrixXd across = normal.topRightCorner(kMotion, unknowns);
    reduced = normal.bottomRightCorner(unknowns, unknowns) - across.transpose() * motion.solve(across);
    reduced_slope = slope.tail(unknowns) - across.transpose() * motion.solve(slope.head<kMotion>());
  }

  /// The changes of motion and unknowns, by those of the unknowns.
  Eigen::VectorXd rest(const Eigen::VectorXd& unknowns) const {
    Eigen::VectorXd result(normal.rows());
    result << -motion.solve(slope.head<kMotion>() + normal.topRightCorner(kMotion, unknowns.size()) * unknowns),
        unknowns;
    return result;
  }
};

PairAdjustment::PairAdjustment(const RigUnknowns& unknowns, const std::vector<const FramePair*>& pairs)
    : unknowns_(unknowns), scale_(kViewScale) {
  for (const FramePair* pair : pairs)
    pairs_.push_back({pair, pair->second_from_first, std::vector<Point>(pair->points.size())});
}

template <class Function>
void PairAdjustment::for_all_points(const Function& function) {
  tbb::parallel_for(std::size_t{0}, pairs_.size(), [&](std::size_t p) {
    Pair& pair = pairs_[p];
    Terms terms;
    for (std::size_t i = 0; i < pair.points.size(); ++i) function(pair, pair.points[i], pair.seen->points[i], terms);
  });
}

void PairAdjustment::start() {
  const Cameras cameras(unknowns_, values_, false);
  for_all_points([&](const Pair&, Point& point, const SeenPoint& seen, const Terms&) {
    const auto ray = cameras.mapping[0].ray(seen.at[kLeftFirst]);
    const auto right_ray = seen.is_seen[kRightFirst] ? cameras.mapping[1].ray(seen.at[kRightFirst]) : std::nullopt;
    point.is_alive = point.is_valid = ray.has_value();
    if (!ray) return;
    point.ray = *ray;
    const Eigen::Vector3d side = std::abs(ray->x()) < 0.7 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
    point.beside.col(0) = side.cross(*ray).normalized();
    point.beside.col(1) = ray->cross(point.beside.col(0));
    point.inverse_depth = 0.02 / cameras.baseline.norm();
    if (!right_ray) return;
    const Eigen::Vector3d by_depth = cameras.baseline.cross(*right_ray);
    point.inverse_depth = -(cameras.rotation * *ray).cross(*right_ray).dot(by_depth) / by_depth.squaredNorm();
  });
}

void PairAdjustment::settle_points(int rounds) {
  const Cameras cameras(unknowns_, values_, false);
  const double length = cameras.baseline.norm();
  for_all_points([&](const Pair& pair, Point& point, const SeenPoint& seen, Terms& terms) {
    for (int round = 0; point.is_alive && round < rounds; ++round) {
      terms.measure(cameras, pair.motion, point, seen, kViewScale);
      terms.differentiate(cameras, pair.motion, point, false);
      Eigen::Matrix3d own = terms.by_point.transpose() * terms.weight.asDiagonal() * terms.by_point;
      own.diagonal() += 1e-4 * own.diagonal() + Eigen::Vector3d(1, 1, length * length);
      const Eigen::Vector3d move =
          -own.ldlt().solve(terms.by_point.transpose() * terms.weight.cwiseProduct(terms.error));
      const Eigen::Vector2d turn = move.head<2>().cwiseMax(-kLargestTurn).cwiseMin(kLargestTurn);
      point.ray = (point.ray + point.beside * turn).normalized();
      point.inverse_depth = std::clamp(point.inverse_depth + move[2], -0.003 / length, kNearestPoint / length);
    }
  });
}

void PairAdjustment::cull(double limit) {
  const Cameras cameras(unknowns_, values_, false);
  for_all_points([&](const Pair& pair, Point& point, const SeenPoint& seen, Terms& terms) {
    terms.measure(cameras, pair.motion, point, seen, kViewScale);
    for (int view = 0; view < kViews; ++view)
      if (terms.error.segment<2>(2 * view).norm() > limit) point.is_alive = false;
  });
}

double PairAdjustment::cost(const std::vector<Pair>& pairs, const Eigen::VectorXd& values) const {
  const Cameras cameras(unknowns_, values, false);
  std::vector<double> costs(pairs.size(), 0.0);
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t p) {
    Terms terms;
    for (std::size_t i = 0; i < pairs[p].points.size(); ++i) {
      if (!pairs[p].points[i].is_alive) continue;
      terms.measure(cameras, pairs[p].motion, pairs[p].points[i], pairs[p].seen->points[i], scale_);
      costs[p] += terms.cost;
    }
  });
  double sum = 0;
  for (const double each : costs) sum += each;
  return sum;
}

/// One step of Levenberg and Marquardt: the pairs after it, and the change of the unknowns.
std::vector<PairAdjustment::Pair> PairAdjustment::stepped(bool learns, double damping, Eigen::VectorXd& change) {
  const Cameras cameras(unknowns_, values_, learns);
  const Eigen::Index unknowns = learns ? unknowns_.count() : 0;
  const double length = cameras.baseline.norm(),
               pixels = std::pow(cameras.calibration.left.camera.fx / kViewSigma, 2) * kPointFloor;
  const Eigen::Vector3d floor(pixels, pixels, pixels * length * length);
  std::vector<Step> steps(pairs_.size());
  tbb::parallel_for(std::size_t{0}, pairs_.size(), [&](std::size_t p) {
    const Pair& pair = pairs_[p];
    Step& step = steps[p];
    step.normal.setZero(kMotion + unknowns, kMotion + unknowns);
    step.slope.setZero(kMotion + unknowns);
    step.points.resize(pair.points.size());
    Terms terms;
    for (std::size_t i = 0; i < pair.points.size(); ++i) {
      if (!pair.points[i].is_alive) continue;
      terms.measure(cameras, pair.motion, pair.points[i], pair.seen->points[i], scale_);
      terms.differentiate(cameras, pair.motion, pair.points[i], learns);
      step.add(terms, damping, floor, step.points[i]);
    }
    step.eliminate_motion(damping);
  });
  information_.setZero(unknowns, unknowns);
  change.setZero(unknowns);
  if (learns) {
    const Eigen::VectorXd weight = unknowns_.priors().cwiseAbs2().cwiseInverse();
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(unknowns);  // half the derivative of the cost
    for (const Step& step : steps) {
      information_ += step.reduced;
      slope += step.reduced_slope;
    }
    Eigen::MatrixXd whole = information_;
    whole.diagonal() += weight;
    whole.diagonal() *= 1 + damping;
    change = -whole.ldlt().solve(slope + weight.cwiseProduct(values_));
  }
  std::vector<Pair> after = pairs_;
  tbb::parallel_for(std::size_t{0}, after.size(), [&](std::size_t p) {
    Pair& pair = after[p];
    const Eigen::VectorXd rest = steps[p].rest(change);
    pair.motion.linear() = rotation_by(rest.head<3>()) * pair.motion.linear();
    pair.motion.translation() += rest.segment<3>(3);
    for (std::size_t i = 0; i < pair.points.size(); ++i) {
      Point& point = pair.points[i];
      if (!point.is_alive) continue;
      const Step::PointStep& own = steps[p].points[i];
      const Eigen::Vector3d move = -own.inverse * (own.slope + own.by_rest * rest);
      point.ray = (point.ray + point.beside * move.head<2>()).normalized();
      point.inverse_depth += move[2];
    }
  });
  return after;
}

void PairAdjustment::optimise(bool learns, const std::vector<std::pair<int, double>>& culls) {
  const auto prior_cost = [&](const Eigen::VectorXd& of) {
    return learns ? of.cwiseQuotient(unknowns_.priors()).squaredNorm() : 0.0;
  };
  constexpr double kStart = 1e-5, kLeast = 1e-7, kMost = 1e3, kSettled = 3e-5;
  double damping = kStart;
  for (int step = 0; step < kMaxSteps; ++step) {
    for (const auto& [when, limit] : culls) {
      if (when != step) continue;
      for (Pair& pair : pairs_)
        for (Point& point : pair.points) point.is_alive = point.is_valid;
      settle_points(4);
      cull(limit);
    }
    const double before = cost(pairs_, values_) + prior_cost(values_);
    Eigen::VectorXd change;
    std::vector<Pair> after = stepped(learns, damping, change);
    const Eigen::VectorXd changed = learns ? Eigen::VectorXd(values_ + change) : values_;
    const double now = cost(after, changed) + prior_cost(changed);
    if (!(now < before)) {
      damping *= 10;
      if (damping > kMost) break;
      continue;
    }
    pairs_ = std::move(after);
    values_ = changed;
    damping = std::max(damping / 3, kLeast);
    const bool is_culled = culls.empty() || step > culls.back().first;
    if (is_culled && before - now < kSettled * before) break;
  }
}

void PairAdjustment::adjust(bool learns, const std::vector<std::pair<int, double>>& culls) {
  start();
  settle_points(12);
  cull(20);
  optimise(learns, culls);
}

Eigen::VectorXd PairAdjustment::learn() {
  values_.setZero(unknowns_.count());
  adjust(true, {{2, 8}, {4, 4}, {7, 2}});
  Eigen::VectorXd ignored;
  stepped(true, 0, ignored);
  return values_;
}

void PairAdjustment::fit(const Eigen::VectorXd& fixed) {
  values_ = fixed;
  adjust(false, {{2, 8}, {4, kFitLimit}});
}

std::vector<PairAdjustment::Residual> PairAdjustment::residuals() const {
  const Cameras cameras(unknowns_, values_, false);
  std::vector<Residual> residuals;
  Terms terms;
  for (const Pair& pair : pairs_) {
    for (std::size_t i = 0; i < pair.points.size(); ++i) {
      const Point& point = pair.points[i];
      const SeenPoint& seen = pair.seen->points[i];
      if (point.is_alive) terms.measure(cameras, pair.motion, point, seen, kViewScale);
      for (std::size_t view = 0; view < kViews; ++view) {
        if (!seen.is_seen[view]) continue;
        const double error = terms.error.segment<2>(2 * static_cast<Eigen::Index>(view)).norm(),
                     distance = point.is_alive ? std::min(error, kFitLimit) : kFitLimit;
        residuals.push_back({static_cast<View>(view), seen.at[view], distance, point.inverse_depth, point.is_alive});
      }
    }
  }
  return residuals;
}

int PairAdjustment::points() const {
  int count = 0;
  for (const Pair& pair : pairs_)
    count += static_cast<int>(
        std::count_if(pair.points.begin(), pair.points.end(), [](const Point& point) { return point.is_alive; }));
  return count;
}

double PairAdjustment::find_motion(const RigUnknowns& unknowns, FramePair& pair) {
  PairAdjustment adjustment(unknowns, {&pair});
  adjustment.values_.setZero(unknowns.count());
  adjustment.start();
  for (const double scale : {20.0, 5.0, 1.5}) {
    adjustment.scale_ = scale;
    adjustment.optimise(false, {});
  }
  adjustment.cull(kAgreeing);
  pair.second_from_first = adjustment.pairs_.front().motion;
  return pair.points.empty() ? 0 : static_cast<double>(adjustment.points()) / static_cast<double>(pair.points.size());
}

}  // namespace quadedge::rig
