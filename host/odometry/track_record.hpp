#pragma once
/// \file track_record.hpp  What the motions of earlier frames say about the next prediction.

#include <algorithm>

#include "odometry/motion_step.hpp"
#include "odometry/odometry_constants.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// Remembers the support that recent motions had and whether the last one was in doubt.
class TrackRecord {
 public:
  explicit TrackRecord(const Config& config) : limits_(config.temporal) {}

  /// Records the motion that was chosen; a failure resets the support.
  void remember(const MotionStep& found) {
    const double support = std::max(found.verdict.support, kSupportDecay * recent_support_);
    recent_support_ = found.ok() ? support : kUnknownSupport;
    is_doubtful_ = found.doubt.exists();
  }

  /// Support from which a motion near the prediction is accepted without further tests: temporal.confident_support, or
  /// less if recent motions had low support; 0 if there is no global search to ask.
  double confident_support() const {
    if (limits_.wide_edges == 0) return 0;
    return std::min(limits_.confident_support, std::max(kChanceSupport, kRecentSupportRatio * recent_support_));
  }
  /// Whether the last motion, which the prediction repeats, was ambiguous.
  bool is_doubtful() const { return is_doubtful_; }

 private:
  static constexpr double kUnknownSupport = 1;

  TemporalConfig limits_;
  double recent_support_ = kUnknownSupport;
  bool is_doubtful_ = false;
};

}  // namespace quadedge::odometry
