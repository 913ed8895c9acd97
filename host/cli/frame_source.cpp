#include "cli/frame_source.hpp"

#include <cstdio>

#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

class RecordedSource : public FrameSource {
 public:
  explicit RecordedSource(Dataset dataset) : dataset_(std::move(dataset)) { rewind(); }
  const StereoRig& rig() const override { return dataset_.rig; }
  report::InputFacts facts() const override {
    return {dataset_.path,           dataset_.format,         dataset_.name, static_cast<int>(dataset_.frames.size()),
            dataset_.rig.left.width, dataset_.rig.left.height};
  }
  double max_disparity() const override { return dataset_.max_disparity; }
  std::optional<FramePrefetcher::Frame> next() override { return prefetcher_->next(); }
  void rewind() override { prefetcher_ = std::make_unique<FramePrefetcher>(dataset_); }
  const Trajectory& truth() const override { return dataset_.truth; }
  std::string truth_name() const override { return dataset_.truth_file; }

 private:
  Dataset dataset_;
  std::unique_ptr<FramePrefetcher> prefetcher_;
};

class SyntheticSource : public FrameSource {
 public:
  explicit SyntheticSource(const SyntheticOptions& options) : options_(options), sequence_(options) {
    for (int i = 0; i < sequence_.frames(); ++i)
      truth_.push_back({sequence_.stamp_ns(i), sequence_.world_from_left(i)});
  }
  const StereoRig& rig() const override { return sequence_.rig(); }
  report::InputFacts facts() const override {
    return {"built-in",
            "synthetic",
            options_.scene,
            sequence_.frames(),
            sequence_.rig().left.width,
            sequence_.rig().left.height};
  }
  double max_disparity() const override { return sequence_.max_disparity(); }
  std::optional<FramePrefetcher::Frame> next() override {
    if (next_ >= sequence_.frames()) return std::nullopt;
    FramePrefetcher::Frame frame;
    frame.number = next_++;
    frame.stamp_ns = sequence_.stamp_ns(frame.number);
    frame.left = sequence_.render(frame.number, false).image;
    frame.right = sequence_.render(frame.number, true).image;
    return frame;
  }
  void rewind() override { next_ = 0; }
  const Trajectory& truth() const override { return truth_; }
  std::string truth_name() const override { return "exact poses of the renderer"; }

 private:
  SyntheticOptions options_;
  SyntheticSequence sequence_;
  Trajectory truth_;
  int next_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> make_recorded_source(Dataset dataset) {
  return std::make_unique<RecordedSource>(std::move(dataset));
}

std::unique_ptr<FrameSource> make_synthetic_source(const SyntheticOptions& options) {
  return std::make_unique<SyntheticSource>(options);
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
