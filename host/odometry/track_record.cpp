#include "odometry/track_record.hpp"

#include <algorithm>

#include "odometry/odometry_constants.hpp"

namespace quadedge::odometry {

void TrackRecord::remember(const MotionStep& found) {
  const double support = std::max(found.verdict.support, kSupportDecay * recent_support_);
  recent_support_ = found.ok() ? support : kUnknownSupport;
  is_doubtful_ = found.doubt.exists();
}

double TrackRecord::confident_support() const {
  if (limits_.wide_edges == 0) return 0;
  return std::min(limits_.confident_support, std::max(kChanceSupport, kRecentSupportRatio * recent_support_));
}

}  // namespace quadedge::odometry
