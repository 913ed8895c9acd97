/// \file frame_source.cpp  Wraps a dataset or a renderer, and tests the first pair for images that are rectified.
#include "cli/frame_source.hpp"

#include <cstdio>
#include <utility>

#include "cli/calibration_check.hpp"
#include "data/atomic_file.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

std::shared_ptr<const data::RenderedFrames> render(const SyntheticOptions& options) {
  const std::string cache = data::cache_folder();
  return std::make_shared<data::RenderedFrames>(options, cache.empty() ? cache : cache + "/rendered");
}

}  // namespace

FrameSource::FrameSource(Dataset dataset, std::function<bool()> stop, std::vector<std::string> options)
    : dataset_(std::move(dataset)), stop_(std::move(stop)), options_(std::move(options)) {}

FrameSource::FrameSource(const SyntheticOptions& options, bool quiet, const Interruption* interruption)
    : rendered_(render(options)) {
  const SyntheticSequence& sequence = rendered_->sequence();
  dataset_.format = "synthetic";
  dataset_.path = "built-in";
  dataset_.name = sequence.name();
  dataset_.rig = sequence.rig();
  dataset_.stream = rendered_;
  dataset_.truth_file = "exact poses of the renderer";
  for (int i = 0; i < sequence.frames(); ++i) {
    dataset_.frames.push_back({sequence.stamp_ns(i), {}, {}});
    dataset_.truth.push_back({sequence.stamp_ns(i), sequence.world_from_left(i)});
  }
  // The time of the progress begins with the first frame.
  stop_ = [=, frames = rendered_, progress = std::make_shared<std::optional<Progress>>()] {
    if (!*progress) progress->emplace(quiet, "frames");
    if (frames->rendered() > 0) (*progress)->update("rendering", frames->ready(), frames->sequence().frames());
    return interruption != nullptr && interruption->signal() != 0;
  };
}

report::InputFacts FrameSource::facts() const {
  report::InputFacts facts{dataset_.path,           dataset_.format,
                           dataset_.name,           static_cast<int>(dataset_.frames.size()),
                           dataset_.rig.left.width, dataset_.rig.left.height};
  facts.warnings = dataset_.warnings;
  facts.options = options_;
  return facts;
}

void FrameSource::prepare() {
  pairs_ = std::make_unique<FramePrefetcher>(dataset_, 2, stop_);
  first_ = pairs_->next();
  if (first_ && !rendered_)
    if (const std::string proposal = rectified_proposal(dataset_, *first_); !proposal.empty())
      note("warning: " + proposal);
  if (stop_) stop_();  // shows that rendering is done
}

std::optional<StereoPair> FrameSource::next() {
  if (!pairs_) prepare();
  return first_ ? std::exchange(first_, std::nullopt) : pairs_->next();
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
