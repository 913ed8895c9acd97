/// \file range_follower.cpp  A quantile of the disparities sets the next range; matched probes beyond it enlarge it.
#include "edges/range_follower.hpp"

#include <algorithm>

#include "geometry/disparity_range.hpp"

namespace quadedge::frontend {
namespace {

constexpr int kProbes = 256;           // approximate number per frame
constexpr int kLeastStep = 8;          // left edges per probe, at least
constexpr int kLeastEdges = 50;        // stereo edges (of the probes: a fifth) from which a range is judged
constexpr float kBeyondRatio = 0.04F;  // of the probes' matches; accidental ones reach 0.02
/// Quantile of the disparities that the range has to cover; the largest ones are mostly accidental.
constexpr double kQuantile = 0.97;
// Range for a quantile q: at least kLeastReach q, when changed kReach q, each plus kMargin; narrowed where kReach q is
// less than kWorthwhile of it.
constexpr float kLeastReach = 1.1F, kReach = 1.3F, kMargin = 16, kWorthwhile = 0.7F;
constexpr float kNarrowing = 0.9F;  // largest change per frame

/// Reorders `values`, which must not be empty.
float quantile(std::vector<float>& values, double ratio) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(ratio * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace

RangeFollower::RangeFollower(const StereoRig& rig, const Config& config)
    : geometry_(make_epipolar_geometry(rig, with_disparity_range(config, rig).stereo)),
      middle_x_(static_cast<float>(rig.left.cx)),
      middle_y_(static_cast<float>(rig.left.cy)) {
  if (has_disparity_range(config.stereo)) return;
  limit_ = static_cast<float>(disparity_limit(rig));
  geometry_.max_disparity = std::min(geometry_.max_disparity, limit_);
  next_ = geometry_.max_disparity;
}

void RangeFollower::start_frame() {
  if (limit_ > 0) geometry_.max_disparity = next_;
  is_second_search_ = false;
}

DisparityProbe RangeFollower::probe(int left_edges) const {
  if (limit_ <= geometry_.max_disparity) return {0, 0};
  return {std::max((left_edges + kProbes - 1) / kProbes, kLeastStep), limit_};
}

bool RangeFollower::suffices(const StereoEdges& edges, int left_edges) {
  if (limit_ == 0) return true;
  const float range = geometry_.max_disparity;
  const DisparityProbe probes = probe(left_edges);
  probed_.clear();
  found_.clear();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry_, edges.left_x[i], edges.left_y[i]);
    const float disparity = (edges.right_x[i] - line.x) * line.ex + (edges.right_y[i] - line.y) * line.ey;
    found_.push_back(disparity);
    if (probes.step > 0 && edges.left_index[i] % probes.step == 0) probed_.push_back(disparity);
  }
  // The probes first: of a scene beyond the range, little else is found.
  if (!is_second_search_ && 5 * probed_.size() >= kLeastEdges) {
    const auto beyond = static_cast<float>(
        std::count_if(probed_.begin(), probed_.end(), [&](float disparity) { return disparity > range + 1; }));
    if (beyond > kBeyondRatio * static_cast<float>(probed_.size())) {
      geometry_.max_disparity = std::max(range, covering(quantile(probed_, kQuantile)));
      is_second_search_ = true;
      return false;
    }
  }
  if (found_.size() < kLeastEdges) return true;
  const float largest = quantile(found_, kQuantile), wanted = covering(largest);
  next_ = range;
  if (range < std::min(kLeastReach * largest + kMargin, limit_)) next_ = wanted;
  if (wanted < kWorthwhile * range) next_ = std::max(wanted, kNarrowing * range);
  return true;
}

double RangeFollower::disparity() const {
  return static_cast<double>(epipolar_line(geometry_, middle_x_, middle_y_).s_max);
}

float RangeFollower::covering(float disparity) const { return std::min(kReach * disparity + kMargin, limit_); }

}  // namespace quadedge::frontend
