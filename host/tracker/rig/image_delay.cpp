/// \file image_delay.cpp  Pairs images with those of earlier frames and counts corners on their lines; pairs vote.
#include "rig/image_delay.hpp"

#include <algorithm>
#include <cmath>

#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Of the corners of a left image, those found in a right one.
struct OnLines {
  int searched = 0, aligned = 0, on_line = 0;

  /// Whether the images are of one moment, as far as their corners say.
  bool fits(double least) const {
    return aligned >= kMinMatches && on_line > least * aligned && on_line > kFittingFound * searched;
  }
  double ratio() const { return searched > 0 ? static_cast<double>(on_line) / searched : 0; }
};

OnLines count(const CornerMatcher& matcher, const Image& left, const Image& right, double max_disparity) {
  const CornerSearch search = matcher.search({0, left.view(), right.view()}, max_disparity);
  OnLines corners{search.searched};
  for (const CornerMatch& match : search.found) {
    if (!match.is_aligned) continue;
    ++corners.aligned;
    corners.on_line += std::abs(match.across) < kOnLine ? 1 : 0;
  }
  return corners;
}

}  // namespace

void ImageDelaySearch::add(const StereoRig& rig, const Image& left, const Image& right, double max_disparity,
                           bool looks) {
  const CornerMatcher matcher(rig);
  const OnLines here = looks ? count(matcher, left, right, max_disparity) : OnLines{};
  if (looks && !here.fits(kFittingOnLine)) {
    doubted_ += kept_.size() == kMost ? 1 : 0;
    int best = 0;
    OnLines there;
    for (int size = 1; size <= static_cast<int>(kept_.size()); ++size) {
      const auto& [left_before, right_before] = kept_[static_cast<std::size_t>(size - 1)];
      for (const int delay : {size, -size}) {
        const OnLines corners = delay > 0 ? count(matcher, left_before, right, max_disparity)
                                          : count(matcher, left, right_before, max_disparity);
        if (!corners.fits(kPartnerOnLine) || corners.on_line <= there.on_line) continue;
        there = corners;
        best = delay;
      }
    }
    if (best != 0 && here.on_line <= kLeftLines * there.on_line) {
      Votes& votes = votes_[best];
      ++votes.pairs;
      votes.on_line += there.ratio();
      votes.on_line_here += here.ratio();
    }
  }
  kept_.emplace_front(left, right);
  if (kept_.size() > kMost) kept_.pop_back();
}

std::string ImageDelaySearch::text() const {
  const auto most = std::max_element(votes_.begin(), votes_.end(),
                                     [](const auto& a, const auto& b) { return a.second.pairs < b.second.pairs; });
  if (most == votes_.end() || most->second.pairs < 2 || 2 * most->second.pairs <= doubted_) return {};
  const Votes& votes = most->second;
  const int frames = std::abs(most->first);
  const std::string by = printed(frames == 1 ? "%d frame" : "%d frames", frames),
                    side = most->first > 0 ? "right" : "left";
  return "the " + side + " camera is " + by + " late: " +
         printed("%.0f %% of the corners lie on their epipolar lines if the ", 100 * votes.on_line / votes.pairs) +
         side + " images are taken " + by +
         printed(" earlier, %.0f %% as the images are paired; pair them by their time of exposure",
                 100 * votes.on_line_here / votes.pairs);
}

}  // namespace quadedge::rig
