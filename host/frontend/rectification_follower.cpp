#include "frontend/rectification_follower.hpp"

#include <algorithm>
#include <cmath>

#include "rig/corner_matching.hpp"

namespace quadedge::frontend {
namespace {

constexpr double kLeast = 0.5;     // of stereo.epipolar_distance, from which the search loses candidates
constexpr double kLargest = 2;     // px; beyond, patches at the uncorrected right points become too dissimilar
constexpr int kLeastSamples = 40;  // of a fit
/// Scatter around the fit over the distances from the lines, at most; with less, the correction does not pay.
constexpr double kScatterRatio = 0.35;
/// Slopes below four standard deviations are 0: 4 sqrt(12) by 1.48 for the deviation that belongs to the scatter,
/// by 1.25 for the loss of a robust fit.
constexpr double kSlopeNoise = 25;
constexpr double kSpreadRatio = 0.5;  // difference between frames over their mean, at most
constexpr double kReleased = 2;       // an error in use is kept up to limits this many times as wide
constexpr int kMemory = 20;           // frames
constexpr double kChange = 0.05;      // px; smaller ones are not followed, so that disparities stay comparable

}  // namespace

RectificationFollower::RectificationFollower(const StereoRig& rig, const StereoConfig& config)
    : rig_(rig), least_(kLeast * config.epipolar_distance) {}

void RectificationFollower::start_frame() {
  error_ = next_;
  is_second_search_ = false;
}

bool RectificationFollower::suffices(const StereoFrame& frame, const StereoEdges& edges) {
  if (is_settled_ || is_second_search_) return true;
  is_second_search_ = true;
  std::vector<rig::CornerMatch> matches;
  rig::CornerMatcher(rig_).align(frame, edges, matches);
  error_ = judge(rig::fit_across(matches, rig_.left.width, rig_.left.height));
  return error_.largest() == 0;
}

void RectificationFollower::take(const rig::EpipolarFit& fit) {
  if (!is_settled_) next_ = error_;
  is_settled_ = true;
  if (fit.samples < kLeastSamples) return;
  frames_ = std::min(frames_ + 1, kMemory);
  const auto follow = [&](double& mean, double value) { mean += (value - mean) / frames_; };
  follow(mean_.offset, fit.offset);
  follow(mean_.slope_x, fit.slope_x);
  follow(mean_.slope_y, fit.slope_y);
  follow(mean_.residual, fit.residual);
  follow(mean_.scatter, fit.scatter);
  follow(spread_, (fit - mean_).largest());
  mean_.samples = fit.samples;
  const RectificationError wanted = judge(mean_);
  if ((wanted - next_).largest() > kChange) next_ = wanted;
}

RectificationError RectificationFollower::judge(const rig::EpipolarFit& measured) const {
  const double largest = measured.largest(), released = next_.largest() > 0 ? kReleased : 1;
  if (measured.samples < kLeastSamples || released * largest < least_ ||
      measured.scatter > released * kScatterRatio * measured.residual || spread_ > released * kSpreadRatio * largest)
    return {};
  const double factor = std::min(1.0, kLargest / largest);
  const double noise = kSlopeNoise * measured.scatter / std::sqrt(static_cast<double>(measured.samples));
  const auto certain = [&](double slope) {
    return factor * slope * std::max(0.0, 1 - noise * noise / std::max(slope * slope, 1e-12));
  };
  return {factor * measured.offset, certain(measured.slope_x), certain(measured.slope_y)};
}

}  // namespace quadedge::frontend
