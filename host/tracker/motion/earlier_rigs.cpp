/// \file earlier_rigs.cpp  When there are too many, drops the keyframe whose view differs least from the next one's.
#include "motion/earlier_rigs.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "motion/odometry_constants.hpp"
#include "motion/view_change.hpp"

namespace quadedge::odometry {

double EarlierRigs::difference(const Kept& one, const Eigen::Isometry3d& world_from_other) {
  return view_change(one.rig.world_from_left().inverse() * world_from_other, one.inverse_depth);
}

void EarlierRigs::remember(const KeyRig& rig, double inverse_depth) {
  if (find(rig.frame_edges()) != nullptr) return;  // was returned to
  if (!kept_.empty() && difference(kept_.back(), rig.world_from_left()) < kSameView) return;
  kept_.push_back({rig, inverse_depth});
  rig.frame_edges()->release_measurements();  // searched again only after a loss
  if (kept_.size() <= kEarlierRigs) return;
  std::size_t most_similar = 0;
  double smallest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
    const double change = difference(kept_[i], kept_[i + 1].rig.world_from_left());
    if (change >= smallest) continue;
    smallest = change;
    most_similar = i;
  }
  kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(most_similar));
}

std::vector<const KeyRig*> EarlierRigs::nearest(const Eigen::Isometry3d& world_from_left) const {
  std::vector<std::pair<double, const KeyRig*>> ordered;
  for (const Kept& kept : kept_) ordered.emplace_back(difference(kept, world_from_left), &kept.rig);
  std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const KeyRig*> result;
  for (std::size_t i = 0; i < std::min(ordered.size(), kEarlierTrials); ++i) result.push_back(ordered[i].second);
  return result;
}

const KeyRig* EarlierRigs::find(const frontend::FrameEdgesHandle& frame_edges) const {
  for (const Kept& kept : kept_)
    if (kept.rig.frame_edges() == frame_edges) return &kept.rig;
  return nullptr;
}

bool EarlierRigs::holds(int frame) const {
  return std::any_of(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.rig.frame() == frame; });
}

}  // namespace quadedge::odometry
