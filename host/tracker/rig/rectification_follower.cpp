/// \file rectification_follower.cpp  Judges the row model with hysteresis; several contradicting frames replace it.
#include "rig/rectification_follower.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "rig/corner_matching.hpp"

namespace quadedge::rig {
namespace {

constexpr double kLeast = 0.5;   // of stereo.epipolar_distance, from which the search loses candidates
constexpr double kLargest = 3;   // px; beyond, matches do not show the error any more
constexpr double kReleased = 2;  // hysteresis: a correction in use is dropped below kLeast divided by this
/// An error that leaves more of the distances than this unexplained is another one: of synchronisation, or of the lens.
constexpr double kUnexplained = 0.55;
constexpr double kChange = 0.05;  // px; smaller ones are not followed, so that disparities stay comparable
/// Frames that have to be known before others contradict them, contradicting ones in a row that replace them, and the
/// squared distance of these from the model, in units of its variance.
constexpr double kKnown = 5, kContradicting = 3.5, kFarOff = 9;

}  // namespace

RectificationFollower::RectificationFollower(const StereoRig& rig, const StereoConfig& config)
    : rig_(rig), least_(kLeast * config.epipolar_distance), rows_(rig.right), changed_(rig.right) {}

void RectificationFollower::start_frame() {
  error_ = next_;
  is_second_search_ = false;
}

bool RectificationFollower::suffices(const StereoFrame& frame, const StereoEdges& edges) {
  if (is_settled_ || is_second_search_) return true;
  is_second_search_ = true;
  std::vector<CornerMatch> matches;
  CornerMatcher(rig_).align(frame, edges, matches);
  RowModel rows = rows_;
  rows.add(matches);
  error_ = judge(rows);
  return error_.largest() == 0;
}

/// Whether the matches lie far off the model of the earlier frames, and near that of the last ones.
bool RectificationFollower::contradicts(const std::vector<CornerMatch>& matches) {
  const double distance = rows_.scatter(matches);
  if (rows_.sums().frames < kKnown || distance < least_ || distance * distance < kFarOff * rows_.sums().variance)
    return false;
  changed_.add(matches);
  return changed_.sums().frames > 0 && changed_.scatter(matches) < kUnexplained * distance;
}

double RectificationFollower::observe(const std::vector<CornerMatch>& matches) {
  if (!is_settled_) next_ = error_;
  is_settled_ = true;
  double change = 0;
  is_contradicted_ = contradicts(matches);
  if (!is_contradicted_) {
    changed_ = RowModel(rig_.right);
    rows_.add(matches);
  } else if (changed_.sums().frames > kContradicting) {
    change = rows_.scatter(matches);
    rows_ = std::exchange(changed_, RowModel(rig_.right));
  }
  const RectificationError wanted = judge(rows_);
  if ((wanted - next_).largest() > kChange) next_ = wanted;
  return change;
}

RectificationError RectificationFollower::judge(const RowModel& rows) const {
  const RectificationError error = rows.error();
  const double largest = error.largest(), released = next_.largest() > 0 ? kReleased : 1;
  if (released * largest < least_ || rows.unexplained() > std::min(1.0, released * kUnexplained)) return {};
  return error * std::min(1.0, kLargest / largest);
}

}  // namespace quadedge::rig
