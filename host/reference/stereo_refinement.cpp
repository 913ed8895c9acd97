#include "reference/stereo_refinement.hpp"

#include <algorithm>
#include <cmath>

#include "common/filter_limits.hpp"
#include "common/matching_constants.hpp"
#include "reference/patches.hpp"

namespace quadedge::reference {
namespace {

double distance_from(const EpipolarLine& line, double x, double y) {
  return -(x - line.x) * line.ey + (y - line.y) * line.ex;
}

}  // namespace

double epipolar_shift(const EpipolarLine& line, double x, double y, double direction, double min_angle,
                      double max_shift) {
  const double dx = x - line.x, dy = y - line.y;
  const double s = dx * line.ex + dy * line.ey;
  const double distance = distance_from(line, x, y);
  const double across = -std::cos(direction) * line.ey + std::sin(direction) * line.ex;
  const double along = std::cos(direction) * line.ex + std::sin(direction) * line.ey;
  if (std::abs(across) <= std::sin(min_angle)) return s;
  const double shift = -distance / across;
  return std::abs(shift) < max_shift ? s + shift * along : s;
}

// LONG: a row from shift to similarity, as the kernel goes through it.
RefinedCandidates stereo_refinement(const ImageView& left_image, const ImageView& right_image,
                                    const std::vector<std::int8_t>& left_patches, const EdgeSet& left,
                                    const EdgeSet& right, const EpipolarGeometry& geometry,
                                    const Candidates& candidates, const StereoConfig& config, double patch_offset,
                                    CandidateScores& scores) {
  RefinedCandidates refined{std::vector<double>(candidates.target.size(), 0.0),
                            std::vector<double>(candidates.target.size(), 0.0)};
  const RefinementSettings settings{config.refine_steps, config.refine_tolerance, kRefinementHuber, kRefinementClamp};
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    const double cosine = std::cos(left.direction[i]), sine = std::sin(left.direction[i]);
    const double line_sine = left_epipolar_sine(geometry, left.x[i], left.y[i], left.direction[i]);
    const double stiffness = std::pow(kRefinementNoise / config.refine_prior_sigma * line_sine, 2);
    const PatchFrame left_frame = patch_frame(left.x[i], left.y[i], cosine, sine, 0, 0);
    const auto begin = static_cast<std::size_t>(candidates.first[i]),
               end = static_cast<std::size_t>(candidates.first[i + 1]);
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      refined.position[c] = epipolar_shift(line, right.x[j], right.y[j], right.direction[j], kShiftMinAngle, kShiftMax);
      for (std::size_t k = begin; k < c; ++k) {
        if (scores.state[k] != kCandidateAlive || std::abs(refined.position[k] - refined.position[c]) >= kSamePosition)
          continue;
        const bool better = scores.ncc[c] > scores.ncc[k];
        scores.state[better ? k : c] = kCandidateRepresented;
        if (!better) break;
      }
    }
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const double s = refined.position[c];
      const auto right_frame = [&](double position, double side) {
        return patch_frame(line.x + position * line.ex, line.y + position * line.ey, cosine, sine, side, patch_offset);
      };
      const PatchValues on_edge = cut_patch(left_image, left_frame, 0, 0);
      const auto found = align_edge(right_image, right_frame(s, 0), line.ex, line.ey, on_edge,
                                    patch_derivative(left_image, left_frame, line.ex, line.ey), stiffness, settings);
      if (!found) {
        scores.state[c] = static_cast<std::uint8_t>(order_of(StereoFilter::refinement));
        continue;
      }
      refined.position[c] = s + found->move;
      const auto side_ncc = [&](int side) {
        return patch_ncc(stored_side(left_patches.data() + i * kEdgePatchBytes, side),
                         cut_patch(right_image, right_frame(refined.position[c], side == 0 ? 1 : -1), 0, 0));
      };
      // A similar side cannot compensate for a dissimilar centre, which gets the lowest similarity of a side.
      const double centre = patch_ncc(on_edge, found->values);
      const double beside = 0.5 * (centre + 1) >= static_cast<double>(lowest_similarity(config))
                                ? std::max(side_ncc(0), side_ncc(1))
                                : -1;
      refined.similarity[c] = 0.5 * (centre + beside);
    }
    // Represented candidates stay where they are and take the similarity of the nearest alive one.
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateRepresented) continue;
      std::size_t nearest = end;
      for (std::size_t k = begin; k < end; ++k) {
        if (scores.state[k] != kCandidateAlive) continue;
        if (nearest == end || std::abs(refined.position[k] - refined.position[c]) <
                                  std::abs(refined.position[nearest] - refined.position[c]))
          nearest = k;
      }
      if (nearest == end)
        scores.state[c] = static_cast<std::uint8_t>(order_of(StereoFilter::refinement));
      else
        refined.similarity[c] = refined.similarity[nearest];
    }
  }
  return refined;
}

}  // namespace quadedge::reference
