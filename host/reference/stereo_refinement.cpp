#include "reference/stereo_refinement.hpp"

#include <cmath>

#include "reference/photometric.hpp"

namespace quadedge::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

double epipolar_shift(const EpipolarLine& line, double x, double y, double direction, double min_angle, double max_shift) {
  const double dx = x - line.x, dy = y - line.y;
  const double s = dx * line.ex + dy * line.ey;
  const double distance = -dx * line.ey + dy * line.ex;
  const double across = -std::cos(direction) * line.ey + std::sin(direction) * line.ex;
  const double along = std::cos(direction) * line.ex + std::sin(direction) * line.ey;
  if (std::abs(across) <= std::sin(min_angle)) return s;
  const double shift = -distance / across;
  return std::abs(shift) < max_shift ? s + shift * along : s;
}

std::vector<double> stereo_refinement(const ImageView& left_image, const ImageView& right_image, const EdgeSet& left,
                                      const EdgeSet& right, const stages::EpipolarGeometry& geometry,
                                      const Candidates& candidates, const StereoConfig& config, double patch_offset,
                                      CandidateScores& scores) {
  std::vector<double> places(candidates.target.size(), 0.0);
  const RefinementSettings settings{config.refine_steps, config.refine_tolerance, config.refine_huber, config.refine_clamp,
                                    config.refine_rms_max, std::pow(config.refine_noise / config.refine_prior, 2)};
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    const double cosine = std::cos(left.direction[i]), sine = std::sin(left.direction[i]);
    for (auto c = static_cast<std::size_t>(candidates.first[i]); c < static_cast<std::size_t>(candidates.first[i + 1]); ++c) {
      if (scores.rejected_by[c] != 0) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      const double s = epipolar_shift(line, right.x[j], right.y[j], right.direction[j], config.shift_min_angle * kPi / 180,
                                      config.shift_max);
      const int pairing = scores.pairing[c];
      const double left_side = pairing == 0 || pairing == 2 ? 1 : -1;
      const double right_side = pairing == 0 || pairing == 3 ? 1 : -1;
      const double turn = angle_between(right.direction[j], left.direction[i]) > 0.5f * 3.14159265358979f ? -1 : 1;
      const auto frame = patch_frame(left.x[i], left.y[i], cosine, sine, left_side, patch_offset);
      const auto moving = patch_frame(line.x + s * line.ex, line.y + s * line.ey, turn * cosine, turn * sine, right_side, patch_offset);
      const auto alignment = align_along_line(right_image, moving, turn * line.ex, turn * line.ey, cut_patch(left_image, frame, 0, 0),
                                              patch_derivative(left_image, frame, line.ex, line.ey), settings);
      places[c] = s + turn * alignment.alpha;
      if (!alignment.good) scores.rejected_by[c] = kStereoRefinementOrder;
    }
  }
  return places;
}

}  // namespace quadedge::reference
