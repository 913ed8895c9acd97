#pragma once
/// \file track_record.hpp  What the motions of earlier frames say about the next prediction.

#include <algorithm>

#include "motion/motion_constants.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/config.hpp"

namespace quadedge::motion {

/// Remembers the support that recent motions had and whether the last one was in doubt.
class TrackRecord {
 public:
  explicit TrackRecord(const Config& config) : limits_(config.temporal) {}

  /// Records the motion that was chosen; a failure resets the support.
  void remember(const MotionStep& found) {
    recent_support_ = found.ok() ? std::max(found.verdict.support, kSupportDecay * recent_support_) : 0;
    is_doubtful_ = found.doubt.exists();
    --frames_to_check_;
    if (!found.ok()) {
      frames_to_check_ = 0;
      rechecks_ = kRechecks;
    }
    if (!found.is_checked) return;
    rechecks_ = is_doubtful_ ? kRechecks : std::max(0, rechecks_ - 1);
    frames_to_check_ = rechecks_ > 0 ? 0 : kCheckInterval - 1;
    checked_moving_ratio_ = found.verdict.moving_ratio;
  }

  /// Support from which a motion near the prediction is accepted without further tests: temporal.confident_support, or
  /// less if recent motions had low support and no other motion was found; 0 if there is no global search to ask.
  double confident_support() const {
    if (limits_.wide_edges == 0) return 0;
    if (!is_settled()) return limits_.confident_support;
    return std::min(limits_.confident_support, std::max(kChanceSupport, kRecentSupportRatio * recent_support_));
  }
  /// Whether the parts of the image that do not follow a motion have to be searched for another one.
  bool is_check_due(const Verdict& verdict) const {
    if (limits_.wide_edges == 0) return false;
    const double noticeable = std::max(kCheckedMovingRatio, checked_moving_ratio_ + kMovingRatioStep);
    return frames_to_check_ <= 0 || verdict.moving_ratio > noticeable;
  }
  /// Whether the last searches found no other motion.
  bool is_settled() const { return rechecks_ == 0; }
  /// Whether the last motion, which the prediction repeats, was ambiguous.
  bool is_doubtful() const { return is_doubtful_; }

 private:
  TemporalConfig limits_;
  double recent_support_ = 0;  // since the last failure
  bool is_doubtful_ = false;
  int frames_to_check_ = 0, rechecks_ = kRechecks;
  double checked_moving_ratio_ = 0;
};

}  // namespace quadedge::motion
