#include "reference/temporal_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Dense>

#include "reference/photometric.hpp"

namespace quadedge::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Gauss-Newton on the coefficients of `axes` (unit vectors in the current image, one per column) from the start at `moving`.
template <int Dimensions>
std::optional<Eigen::Vector2d> align_held(const ImageView& fixed_image, const PatchFrame& fixed, const ImageView& image,
                                          const PatchFrame& moving, double turn,
                                          const Eigen::Matrix<double, 2, Dimensions>& axes, double stiffness,
                                          const RefinementSettings& settings) {
  using Vector = Eigen::Matrix<double, Dimensions, 1>;
  const PatchValues goal = cut_patch(fixed_image, fixed, 0, 0);
  const Eigen::Matrix2d to_previous = Eigen::Rotation2Dd(turn).toRotationMatrix();
  std::array<PatchValues, Dimensions> gradients;
  for (int k = 0; k < Dimensions; ++k) {
    const Eigen::Vector2d axis = to_previous * axes.col(k);
    gradients[static_cast<std::size_t>(k)] = patch_derivative(fixed_image, fixed, axis.x(), axis.y());
  }
  Vector move = Vector::Zero();
  double rms = 0;
  for (int step = 0; step < settings.steps; ++step) {
    const Eigen::Vector2d place = axes * move;
    const PatchValues values = cut_patch(image, moving, place.x(), place.y());
    Eigen::Matrix<double, Dimensions, Dimensions> normal = stiffness * Eigen::Matrix<double, Dimensions, Dimensions>::Identity();
    Vector right_side = -stiffness * move;
    double squares = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      Vector gradient;
      for (int d = 0; d < Dimensions; ++d) gradient(d) = gradients[static_cast<std::size_t>(d)][k];
      const double residual = goal[k] - values[k];
      const double weight = huber_weight(residual, settings.huber);
      normal += weight * gradient * gradient.transpose();
      right_side += weight * residual * gradient;
      squares += residual * residual;
    }
    rms = std::sqrt(squares / 49);
    const Vector change = normal.inverse() * right_side;
    move += change;
    if (!(move.norm() <= settings.clamp)) return std::nullopt;
    if (change.norm() < settings.tolerance) break;
  }
  if (rms > settings.rms_max) return std::nullopt;
  return axes * move;
}

PatchFrame frame_at(double x, double y, double direction, bool dark, double offset) {
  return patch_frame(x, y, std::cos(direction), std::sin(direction), dark ? 1 : -1, offset);
}

}  // namespace

Agreement temporal_agreement(const Candidates& left_candidates, CandidateScores& left, const Candidates& right_candidates,
                             const CandidateScores& right) {
  Agreement agreement{std::vector<float>(left_candidates.target.size(), 0.0f),
                      std::vector<std::uint8_t>(left_candidates.target.size(), 0)};
  for (std::size_t row = 0; row + 1 < left_candidates.first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(left_candidates.first[row]); c < static_cast<std::size_t>(left_candidates.first[row + 1]); ++c) {
      if (left.rejected_by[c] != 0) continue;
      bool found = false;
      for (auto d = static_cast<std::size_t>(right_candidates.first[row]);
           d < static_cast<std::size_t>(right_candidates.first[row + 1]) && !found; ++d) {
        if (right.rejected_by[d] != 0 || right_candidates.target[d] != left_candidates.target[c]) continue;
        found = true;
        agreement.score[c] = 0.5f * (left.ncc[c] + right.ncc[d]);
        agreement.right_pairing[c] = right.pairing[d];
      }
      if (!found) left.rejected_by[c] = kAgreementOrder;
    }
  }
  return agreement;
}

std::vector<RefinedPlace> temporal_refinement(const RigImages& previous_images, const RigImages& current_images,
                                              const StereoEdges& previous, const StereoEdges& current,
                                              const stages::EpipolarGeometry& geometry, const Candidates& candidates,
                                              const Agreement& agreement, const TemporalConfig& config, double patch_offset,
                                              CandidateScores& scores, int row_step) {
  std::vector<RefinedPlace> places(candidates.target.size());
  const RefinementSettings settings{config.refine_steps, config.refine_tolerance, config.refine_huber, config.refine_clamp,
                                    config.refine_rms_max};
  const double stiffness = std::pow(config.refine_noise / config.refine_prior, 2);
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    const std::size_t i = row * static_cast<std::size_t>(row_step);
    for (auto c = static_cast<std::size_t>(candidates.first[row]); c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.rejected_by[c] != 0) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      const bool dark = (scores.pairing[c] & 1) == 0, right_dark = (agreement.right_pairing[c] & 1) == 0;
      const auto move = align_held<2>(
          previous_images.left, frame_at(previous.left_x[i], previous.left_y[i], previous.left_direction[i], dark, patch_offset),
          current_images.left, frame_at(current.left_x[j], current.left_y[j], current.left_direction[j], dark, patch_offset),
          previous.left_direction[i] - current.left_direction[j], Eigen::Matrix2d::Identity(), stiffness, settings);
      if (!move) {
        scores.rejected_by[c] = kTemporalRefinementOrder;
        continue;
      }
      const Eigen::Vector2d left(current.left_x[j] + move->x(), current.left_y[j] + move->y());
      const EpipolarLine old_line = epipolar_line(geometry, current.left_x[j], current.left_y[j]);
      const EpipolarLine line = epipolar_line(geometry, static_cast<float>(left.x()), static_cast<float>(left.y()));
      const double s = (current.right_x[j] - old_line.x) * old_line.ex + (current.right_y[j] - old_line.y) * old_line.ey;
      const Eigen::Vector2d axis(line.ex, line.ey);
      const Eigen::Vector2d start = Eigen::Vector2d(line.x, line.y) + s * axis;
      const auto right_move = align_held<1>(
          previous_images.right,
          frame_at(previous.right_x[i], previous.right_y[i], previous.right_direction[i], right_dark, patch_offset),
          current_images.right, frame_at(start.x(), start.y(), current.right_direction[j], right_dark, patch_offset),
          previous.right_direction[i] - current.right_direction[j], axis, stiffness, settings);
      if (!right_move) {
        scores.rejected_by[c] = kTemporalRefinementOrder;
        continue;
      }
      const Eigen::Vector2d right = start + *right_move;
      places[c] = {left.x(), left.y(), right.x(), right.y()};
    }
  }
  return places;
}

TemporalMatches temporal_clusters(const Candidates& candidates, const CandidateScores& scores, const Agreement& agreement,
                                  const std::vector<RefinedPlace>& places, const StereoEdges& current,
                                  const TemporalConfig& config, int row_step) {
  TemporalMatches matches;
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    std::vector<std::size_t> alive;
    for (auto c = static_cast<std::size_t>(candidates.first[row]); c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.rejected_by[c] == 0) alive.push_back(c);
    }
    if (alive.empty()) continue;
    // Single linkage: flood from every member that has no cluster yet.
    std::vector<int> cluster_of(alive.size(), -1);
    int clusters = 0;
    for (std::size_t seed = 0; seed < alive.size(); ++seed) {
      if (cluster_of[seed] >= 0) continue;
      std::vector<std::size_t> open = {seed};
      cluster_of[seed] = clusters;
      while (!open.empty()) {
        const std::size_t a = open.back();
        open.pop_back();
        for (std::size_t b = 0; b < alive.size(); ++b) {
          if (cluster_of[b] >= 0) continue;
          const auto &p = places[alive[a]], &q = places[alive[b]];
          const auto direction = [&](std::size_t m) { return current.left_direction[static_cast<std::size_t>(candidates.target[alive[m]])]; };
          if (std::hypot(p.left_x - q.left_x, p.left_y - q.left_y) >= config.cluster_gap) continue;
          if (angle_between(direction(a), direction(b)) > config.cluster_orientation * kPi / 180) continue;
          cluster_of[b] = clusters;
          open.push_back(b);
        }
      }
      ++clusters;
    }
    const auto winner = static_cast<std::size_t>(
        std::max_element(alive.begin(), alive.end(), [&](std::size_t a, std::size_t b) { return agreement.score[a] < agreement.score[b]; }) -
        alive.begin());
    RefinedPlace sum;
    double members = 0;
    for (std::size_t m = 0; m < alive.size(); ++m) {
      if (cluster_of[m] != cluster_of[winner]) continue;
      const auto& place = places[alive[m]];
      sum = {sum.left_x + place.left_x, sum.left_y + place.left_y, sum.right_x + place.right_x, sum.right_y + place.right_y};
      ++members;
    }
    matches.previous.push_back(static_cast<std::int32_t>(row) * row_step);
    matches.current.push_back(candidates.target[alive[winner]]);
    matches.left_x.push_back(static_cast<float>(sum.left_x / members));
    matches.left_y.push_back(static_cast<float>(sum.left_y / members));
    matches.right_x.push_back(static_cast<float>(sum.right_x / members));
    matches.right_y.push_back(static_cast<float>(sum.right_y / members));
    matches.ncc.push_back(agreement.score[alive[winner]]);
    matches.rivals.push_back(clusters - 1);
  }
  return matches;
}

}  // namespace quadedge::reference
