#include "report/errors_csv.hpp"

#include <cmath>

#include "data/text.hpp"

namespace quadedge::report {

std::string errors_csv(const TrajectoryEvaluation& evaluation) {
  const auto field = [](double value) {
    return "," + (std::isfinite(value) ? data::format_exact(value) : std::string());
  };
  std::string text = "stamp_s,ape_rotation_deg,ape_translation_m,rpe_rotation_deg,rpe_translation_m\n";
  for (const auto& pose : evaluation.per_pose) {
    text += data::format_seconds(pose.stamp_ns) + field(pose.ape_rotation_deg) + field(pose.ape_translation_m) +
            field(pose.rpe_rotation_deg) + field(pose.rpe_translation_m) + "\n";
  }
  return text;
}

}  // namespace quadedge::report
