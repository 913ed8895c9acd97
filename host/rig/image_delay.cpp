/// \file image_delay.cpp  Pairs images with those of earlier frames and counts corners on their lines; frames vote.
#include "rig/image_delay.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

/// Of the corners of a left image, those found in a right one.
struct OnLines {
  int searched = 0, aligned = 0, on_line = 0;

  /// Whether the images are of one moment, as far as their corners say.
  bool fits(double least = kFittingOnLine) const {
    return aligned >= kMinMatches && on_line > least * aligned && on_line > kFittingFound * searched;
  }
  double ratio() const { return searched > 0 ? static_cast<double>(on_line) / searched : 0; }
};

OnLines count(const CornerMatcher& matcher, const StereoFrame& frame, double max_disparity, std::size_t every = 1) {
  const CornerSearch search = matcher.search(frame, max_disparity, ImageTurn::none, every);
  OnLines corners{search.searched};
  for (const CornerMatch& match : search.found) {
    if (!match.is_aligned) continue;
    ++corners.aligned;
    corners.on_line += std::abs(match.across) < kOnLine ? 1 : 0;
  }
  return corners;
}

/// The delay, if its corners are clearly more often on their lines than those of the images as paired.
std::optional<ImageDelay> judged(int delay, const OnLines& there, const OnLines& here) {
  if (!there.fits(kPartnerOnLine) || here.on_line > kLeftLines * there.on_line) return std::nullopt;
  return ImageDelay{delay, there.ratio(), here.ratio()};
}

void copy(const ImageView& from, Image& to) {
  if (to.width != from.width || to.height != from.height || to.max_value != from.max_value)
    to = Image(from.width, from.height, from.max_value);
  const std::size_t bytes = bytes_per_pixel(from.max_value) * static_cast<std::size_t>(from.width);
  for (int y = 0; y < from.height; ++y)
    std::memcpy(to.pixels.data() + static_cast<std::size_t>(y) * bytes, from.pixels + y * from.stride, bytes);
}

}  // namespace

std::optional<ImageDelay> ImageDelayFinder::find(const CornerMatcher& matcher, const StereoFrame& frame,
                                                 double max_disparity, DelaySizes sizes) const {
  if (kept_.empty()) return std::nullopt;
  const OnLines here = count(matcher, frame, max_disparity);
  if (here.fits()) return std::nullopt;
  for (int size = sizes.least; size <= sizes.most; ++size) {
    for (const int delay : {size, -size}) {
      const auto pair = delayed(frame, delay);
      if (!pair) continue;
      const OnLines sample = count(matcher, *pair, max_disparity, kSparseCorners);
      if (sample.on_line <= kPromisingOnLine * sample.aligned) continue;
      if (const auto found = judged(delay, count(matcher, *pair, max_disparity), here)) return found;
    }
  }
  return std::nullopt;
}

std::optional<ImageDelay> ImageDelayFinder::measure(const CornerMatcher& matcher, const StereoFrame& frame,
                                                    double max_disparity, int delay) const {
  const auto pair = delayed(frame, delay);
  if (!pair) return std::nullopt;
  const OnLines here = count(matcher, frame, max_disparity), there = count(matcher, *pair, max_disparity);
  if (here.fits() && here.on_line > kLeftLines * there.on_line) return std::nullopt;
  return ImageDelay{delay, there.ratio(), here.ratio()};
}

std::optional<StereoFrame> ImageDelayFinder::delayed(const StereoFrame& frame, int delay) const {
  const auto back = static_cast<std::size_t>(std::abs(delay));
  if (back == 0 || back > kept_.size()) return std::nullopt;
  const Pair& before = kept_[back - 1];
  if (delay > 0) return StereoFrame{frame.stamp_ns, before.left.view(), frame.right};
  return StereoFrame{frame.stamp_ns, frame.left, before.right.view()};
}

void ImageDelayFinder::keep(const StereoFrame& frame) {
  ++count_;
  if (kept_.size() < DelaySizes::kMost) kept_.emplace_back();
  std::rotate(kept_.begin(), std::prev(kept_.end()), kept_.end());
  copy(frame.left, kept_.front().left);
  copy(frame.right, kept_.front().right);
}

DelaySizes DelayRounds::next_frame() {
  wait_ = std::max(0, wait_ - 1);
  if (wait_ > 0) return {1, 0};
  return is_urgent_ ? DelaySizes{} : DelaySizes{size_, size_};
}

void DelayRounds::add(bool is_found, bool is_lost) {
  if (is_found || (!is_urgent_ && !is_lost && ++size_ <= DelaySizes::kMost)) return;
  size_ = 1;
  wait_ = period_ = is_urgent_ || is_lost ? kDelayPeriod : std::min(2 * period_, kLongestDelayPeriod);
  is_urgent_ = is_lost;
}

void DelayRounds::hasten() {
  is_urgent_ = true;
  wait_ = 0;
}

void DelayVotes::add(const std::optional<ImageDelay>& found) {
  if (found) {
    frames_without_ = 0;
    if (++votes_[found->frames] >= kDelayVotes) decided_ = found->frames;
  } else if (++frames_without_ >= kDelayForgotten) {
    *this = {};
  }
}

}  // namespace quadedge::rig
