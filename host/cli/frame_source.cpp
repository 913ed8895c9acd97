#include "cli/frame_source.hpp"

#include <cstdio>

#include "data/user_folder.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class RecordedSource : public FrameSource {
 public:
  RecordedSource(Dataset dataset, std::function<bool()> stop, std::vector<std::string> options)
      : dataset_(std::move(dataset)), stop_(std::move(stop)), options_(std::move(options)) {
    rewind();
  }
  const StereoRig& rig() const override { return dataset_.rig; }
  report::InputFacts facts() const override {
    report::InputFacts facts{dataset_.path,           dataset_.format,
                             dataset_.name,           static_cast<int>(dataset_.frames.size()),
                             dataset_.rig.left.width, dataset_.rig.left.height};
    facts.warnings = dataset_.warnings;
    facts.options = options_;
    return facts;
  }
  std::optional<FramePrefetcher::Frame> next() override { return prefetcher_->next(); }
  void rewind() override { prefetcher_ = std::make_unique<FramePrefetcher>(dataset_, kAhead, stop_); }
  const Trajectory& truth() const override { return dataset_.truth; }
  std::string truth_name() const override { return dataset_.truth_file; }
  int dropped() const override { return prefetcher_->dropped(); }

 private:
  static constexpr int kAhead = 2;
  Dataset dataset_;
  std::function<bool()> stop_;
  std::vector<std::string> options_;
  std::unique_ptr<FramePrefetcher> prefetcher_;
};

class SyntheticSource : public FrameSource {
 public:
  SyntheticSource(const SyntheticOptions& options, data::RenderedFrames::Watch watch)
      : frames_(options, rendered_folder(), std::move(watch)) {
    const auto& sequence = frames_.sequence();
    for (int i = 0; i < sequence.frames(); ++i) truth_.push_back({sequence.stamp_ns(i), sequence.world_from_left(i)});
  }
  const StereoRig& rig() const override { return frames_.sequence().rig(); }
  report::InputFacts facts() const override {
    return {"built-in",       "synthetic",      frames_.sequence().name(), frames_.sequence().frames(),
            rig().left.width, rig().left.height};
  }
  std::string prepare() override {
    frames_.prepare();
    return frames_.cache_error().empty() ? "" : "rendered frames are not cached: " + frames_.cache_error();
  }
  std::optional<FramePrefetcher::Frame> next() override { return frames_.next(); }
  void rewind() override { frames_.rewind(); }
  const Trajectory& truth() const override { return truth_; }
  std::string truth_name() const override { return "exact poses of the renderer"; }
  std::string kept() const override {
    if (frames_.kept() == 0) return {};
    return std::to_string(frames_.kept()) + " of " + std::to_string(frames_.progress().frames) +
           " rendered frames are cached in " + frames_.folder();
  }

 private:
  static std::string rendered_folder() {
    const std::string cache = data::cache_folder();
    return cache.empty() ? cache : cache + "/rendered";
  }

  data::RenderedFrames frames_;
  Trajectory truth_;
};

}  // namespace

std::unique_ptr<FrameSource> make_recorded_source(Dataset dataset, std::function<bool()> stop,
                                                  std::vector<std::string> options) {
  return std::make_unique<RecordedSource>(std::move(dataset), std::move(stop), std::move(options));
}

std::unique_ptr<FrameSource> make_synthetic_source(const SyntheticOptions& options, data::RenderedFrames::Watch watch) {
  return std::make_unique<SyntheticSource>(options, std::move(watch));
}

void set_size(SyntheticOptions& options, const std::string& size) {
  if (size.empty()) return;
  int width = 0, height = 0, length = 0;
  if (std::sscanf(size.c_str(), "%5dx%5d%n", &width, &height, &length) != 2 ||
      length != static_cast<int>(size.size()) || width <= 0 || height <= 0) {
    throw UsageError("--size " + size + ": expected WIDTHxHEIGHT in pixels, for example 640x400");
  }
  // The field of view stays, so that a small picture shows the same scene.
  options.focal *= static_cast<double>(width) / options.width;
  options.width = width;
  options.height = height;
}

}  // namespace quadedge::cli
