#include "data/video_stream.hpp"

#include <cmath>

#include "data/text.hpp"

namespace quadedge::data {
namespace {

class VideoReader : public PairReader {
 public:
  explicit VideoReader(VideoPair videos) : videos_(std::move(videos)), left_(videos_.left) {
    if (videos_.right) right_.emplace(*videos_.right);
  }

  std::optional<StereoPair> next() override {
    auto left = left_.next();
    StereoPair pair;
    pair.number = number_;
    if (right_) {
      auto right = right_->next();
      if (left && !right) end_early(*videos_.right, videos_.left);
      if (right && !left) end_early(videos_.left, *videos_.right);
      if (!left) return std::nullopt;
      check_times(left->stamp_ns, right->stamp_ns);
      pair.left = std::move(left->image);
      pair.right = std::move(right->image);
    } else {
      if (!left) return std::nullopt;
      std::tie(pair.left, pair.right) = split_views(left->image, videos_.split, videos_.left.file);
    }
    pair.stamp_ns = videos_.fps > 0 ? std::llround(number_ / videos_.fps * 1e9) : left->stamp_ns;
    ++number_;
    return pair;
  }

 private:
  [[noreturn]] void end_early(const Video& shorter, const Video& other) const {
    fail(shorter.file, "the end after " + counted(number_, "frame"), "as many as in " + other.file);
  }
  /// Checks that the frames of a pair differ by less than half a period in time.
  void check_times(std::int64_t left, std::int64_t right) const {
    const double fps = videos_.left.fps;
    if (videos_.fps > 0 || !(fps > 0)) return;
    const double apart = static_cast<double>(right - left) / 1e9;
    if (std::abs(apart) * fps < 0.5) return;
    fail(videos_.right->file, "frame " + std::to_string(number_) + " at " + format_seconds(right) + " s",
         format_seconds(left) + " s as in " + videos_.left.file);
  }

  VideoPair videos_;
  VideoFile left_;
  std::optional<VideoFile> right_;
  int number_ = 0;
};

class VideoStream : public PairStream {
 public:
  explicit VideoStream(VideoPair videos) : videos_(std::move(videos)) {}
  std::unique_ptr<PairReader> open() const override { return std::make_unique<VideoReader>(videos_); }

 private:
  VideoPair videos_;
};

}  // namespace

std::shared_ptr<const PairStream> make_video_stream(const VideoPair& videos) {
  return std::make_shared<VideoStream>(videos);
}

}  // namespace quadedge::data
