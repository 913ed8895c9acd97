/// \file image_delay.cpp  Pairs images with those of earlier frames and counts corners on their lines; pairs vote.
#include "calibration/image_delay.hpp"

#include <algorithm>
#include <cmath>

#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Of the corners searched, on their lines, for images of one moment: sound recordings reach 0.4, neighbours in time
/// 0.2.
constexpr double kFittingFound = 0.3;
/// kSoundOnLine of partners that are looked for, whose rows may be off by as much as a rectification leaves.
constexpr double kPartnerOnLine = 0.6;

/// Whether images are of one moment, as far as their corners say.
bool fits(const CornerSearch& search, double least) {
  return search.aligned >= static_cast<int>(kMinMatches) && search.on_line > least * search.aligned &&
         search.on_line > kFittingFound * search.searched;
}

double on_line_ratio(const CornerSearch& search) {
  return search.searched > 0 ? static_cast<double>(search.on_line) / search.searched : 0;
}

}  // namespace

void ImageDelaySearch::add(const StereoRig& rig, const Image& left, const Image& right, double max_disparity,
                           bool looks) {
  const CornerMatcher matcher(rig);
  const auto compare = [&](const Image& one, const Image& other) {
    return matcher.search({0, one.view(), other.view()}, max_disparity);
  };
  const CornerSearch here = looks ? compare(left, right) : CornerSearch{};
  if (looks && !fits(here, kSoundOnLine)) {
    doubted_ += kept_.size() == kMost ? 1 : 0;
    int best = 0;
    CornerSearch there;
    for (int size = 1; size <= static_cast<int>(kept_.size()); ++size) {
      const auto& [left_before, right_before] = kept_[static_cast<std::size_t>(size - 1)];
      for (const int delay : {size, -size}) {
        CornerSearch corners = delay > 0 ? compare(left_before, right) : compare(left, right_before);
        if (!fits(corners, kPartnerOnLine) || corners.on_line <= there.on_line) continue;
        there = std::move(corners);
        best = delay;
      }
    }
    if (best != 0 && here.on_line <= kLeftLines * there.on_line) {
      Votes& votes = votes_[best];
      ++votes.pairs;
      votes.on_line += on_line_ratio(there);
      votes.on_line_here += on_line_ratio(here);
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
