/// \file rig_finding.cpp  Numbers of a calibration, and the disparity offset, outside the ranges of valid rigs.
#include "rig/rig_finding.hpp"

#include <cmath>

#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {

std::string name(Side side) { return side == Side::left ? "left" : "right"; }

std::string percent(double ratio) { return printed("%.0f %%", 100 * ratio); }

std::vector<RigFinding> implausible_numbers(const StereoRig& rig) {
  std::vector<RigFinding> found;
  const auto add = [&](const std::string& text) { found.push_back({{WarningKind::implausible_calibration, text}}); };
  const double baseline = rig.baseline();
  if (baseline > 5) add(printed("the baseline is %.3f m: is it given in millimetres?", baseline));
  if (baseline < 0.005) add(printed("the baseline is %.6f m: is it given in metres?", baseline));
  for (const Side side : kSides) {
    const PinholeCamera& camera = side == Side::left ? rig.left : rig.right;
    const std::string of = "the " + name(side) + " camera's ";
    const double widths = camera.fx / camera.width, shape = camera.fx / camera.fy;
    if (widths < 0.2 || widths > 20)
      add(of + printed("focal length is %.2f image widths: is it given in pixels?", widths));
    if (shape < 1 / 1.5 || shape > 1.5)
      add(of + printed("fx is %.2f times its fy: are the pixels really not square?", shape));
    if (!(camera.cx >= 0 && camera.cx < camera.width && camera.cy >= 0 && camera.cy < camera.height))
      add(of + printed("principal point (%.1f, %.1f) lies outside its image", camera.cx, camera.cy));
  }
  return found;
}

std::optional<RigFinding> judge_disparity_offset(double learned, double free, double sigma) {
  const bool is_shown = sigma > 0 && std::abs(learned) > sigma && learned * free > 0;
  const double offset = is_shown && std::abs(free) > std::abs(learned) ? free : learned;
  if (!(std::abs(offset) > kMaxOffset)) return std::nullopt;
  return RigFinding{
      {WarningKind::large_disparity_offset,
       printed("all disparities seem to be off by %.1f px, so that distances and the path length are doubtful: is the "
               "right camera's yaw or principal point wrong?",
               offset) +
           kMends}};
}

}  // namespace quadedge::rig
