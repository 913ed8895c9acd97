#include "evaluation/quad_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "common/numeric.hpp"
#include "evaluation/cues.hpp"
#include "pose/two_quads.hpp"

namespace quadedge::evaluation {
namespace {

double median(std::vector<double> values) { return values.size() < kFewestMotions ? kNan : upper_median(values); }

/// Angle between two lines from the cosine of their directions [deg].
double line_angle(double cosine) { return std::acos(std::min(1.0, std::abs(cosine))) * kDegreesPerRadian; }

/// Errors of the motions of a set of pairs.
struct Motions {
  std::vector<double> rotation, translation;
  MotionError typical() const { return {median(rotation), median(translation)}; }
};

}  // namespace

MotionError motion_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth) {
  const Eigen::Isometry3d difference = truth.inverse() * estimate;
  const Eigen::Quaterniond q(difference.linear());
  return {2 * std::atan2(q.vec().norm(), std::abs(q.w())) * kDegreesPerRadian, difference.translation().norm()};
}

std::array<double, 5> constraint_values(const pose::OrientedPair& previous, const pose::OrientedPair& current) {
  const Eigen::Vector3d d = previous.second.point - previous.first.point,
                        d_bar = current.second.point - current.first.point;
  const double length = d.norm(), length_bar = d_bar.norm();
  if (!(length > 0) || !(length_bar > 0)) return {kNan, kNan, kNan, kNan, kNan};
  const Eigen::Vector3d unit = d / length, unit_bar = d_bar / length_bar;
  const double first = unit.dot(previous.first.tangent), first_bar = unit_bar.dot(current.first.tangent);
  const double second = unit.dot(previous.second.tangent), second_bar = unit_bar.dot(current.second.tangent);
  const double tangents = previous.first.tangent.dot(previous.second.tangent);
  const double tangents_bar = current.first.tangent.dot(current.second.tangent);
  // The roles of the quads are interchangeable: the better of both counts, before and after.
  const double angle = std::max(std::min(line_angle(first), line_angle(first_bar)),
                                std::min(line_angle(second), line_angle(second_bar)));
  return {std::abs(length - length_bar) / length, std::abs(first - first_bar), std::abs(second - second_bar),
          std::abs(tangents - tangents_bar), angle};
}

PairMeasurement measure_pairs(const pose::QuadObservations& quads, const std::vector<std::size_t>& usable,
                              const std::vector<std::uint8_t>& veridical, std::uint64_t seed,
                              const Eigen::Isometry3d& current_from_previous, std::vector<CueDistribution>& cues) {
  PairMeasurement measured;
  if (usable.size() >= 2) {
    const pose::ConstraintLimits limits;
    std::array<Motions, kConstraintNames.size()> motions;
    std::mt19937_64 random(seed);
    for (int n = 0; n < kDrawnPairs; ++n) {
      const std::size_t a = usable[draw(random, usable.size())], b = usable[draw(random, usable.size())];
      if (a == b) continue;
      const bool both = veridical[a] != 0 && veridical[b] != 0;
      const pose::OrientedPair previous{quads.previous[a].oriented_point(), quads.previous[b].oriented_point()};
      const pose::OrientedPair current{quads.current[a].oriented_point(), quads.current[b].oriented_point()};
      const auto check = pose::check_constraints(previous, current, limits);
      const auto values = constraint_values(previous, current);
      std::optional<MotionError> error;
      for (std::size_t order = 0; order < kConstraintNames.size(); ++order) {
        if (order > 0 && !check.passed[order - 1]) break;
        ++measured.table[order].pairs;
        measured.table[order].veridical += both ? 1 : 0;
        if (order < values.size()) {
          CueDistribution* cue = find_cue(cues, CueTable::constraints, static_cast<int>(order) + 1);
          if (cue != nullptr) (both ? cue->veridical : cue->other).add(values[order]);
        }
        if (motions[order].rotation.size() >= kMostMotions) continue;
        if (!error) {
          const bool swapped = check.swapped;
          const auto motion =
              pose::solve_two_quads(swapped ? pose::OrientedPair{previous.second, previous.first} : previous,
                                    swapped ? pose::OrientedPair{current.second, current.first} : current, 1.0);
          if (!motion) continue;
          error = motion_error(*motion, current_from_previous);
        }
        motions[order].rotation.push_back(error->rotation_deg);
        motions[order].translation.push_back(error->translation_m);
      }
    }
    for (std::size_t order = 0; order < motions.size(); ++order) measured.accuracy[order] = motions[order].typical();
  } else {
    measured.accuracy.fill({kNan, kNan});
  }
  return measured;
}

}  // namespace quadedge::evaluation
