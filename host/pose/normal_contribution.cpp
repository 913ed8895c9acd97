#include "pose/normal_contribution.hpp"

namespace quadedge::pose {

Evaluation::Evaluation(const Eigen::Isometry3d& current_from_previous, double offset_px, const StudentWeights& student)
    : offset(offset_px), weights(student) {
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) rotation[r][c] = current_from_previous.linear()(r, c);
  const auto& t = current_from_previous.translation();
  translation = {t.x(), t.y(), t.z()};
}

}  // namespace quadedge::pose
