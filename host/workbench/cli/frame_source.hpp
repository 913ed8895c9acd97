#pragma once
/// \file frame_source.hpp  Frames in order, from disk or from the renderer.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/console.hpp"
#include "cli/processes.hpp"
#include "data/rendered_frames.hpp"
#include "output/run_record.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::cli {

/// A sequence that can be run. Only evaluation and drawings use the ground truth of its dataset.
class FrameSource {
 public:
  /// A recorded sequence or the user's own cameras. `stop`: as FramePrefetcher. `options`: how it was opened, see
  /// InputFacts.
  explicit FrameSource(Dataset dataset, std::function<bool()> stop = {}, std::vector<std::string> options = {});
  /// A built-in sequence, kept in the user's cache. Unless `quiet`, shows "rendering 12/60 ..." while frames are
  /// rendered. A signal of `interruption`, which may be null, ends it. \throws UsageError for options that cannot be
  /// rendered
  explicit FrameSource(const SyntheticOptions& options, bool quiet = true, const Interruption* interruption = nullptr);

  const Dataset& dataset() const { return dataset_; }
  const StereoRig& rig() const { return dataset_.rig; }
  report::InputFacts facts() const;
  /// Waits for the first frame. \throws DataError if it cannot be read
  void prepare();
  /// The next frame, or nothing at the end. \throws DataError for a frame that cannot be read
  std::optional<StereoPair> next();
  /// Pairs dropped so far because they came faster than they were taken.
  int dropped() const { return pairs_ ? pairs_->dropped() : 0; }
  /// The renderer's frames; null for recorded sequences.
  const data::RenderedFrames* rendered() const { return rendered_.get(); }

 private:
  Dataset dataset_;
  std::function<bool()> stop_;
  std::vector<std::string> options_;
  std::shared_ptr<const data::RenderedFrames> rendered_;
  std::unique_ptr<FramePrefetcher> pairs_;
  std::optional<StereoPair> first_;
};

/// Reads "WIDTHxHEIGHT" into the options. \throws UsageError.
void set_size(SyntheticOptions& options, const std::string& size);

}  // namespace quadedge::cli
