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
  /// A built-in sequence, kept in the user's cache. `watch`: called while frames are made, and where a frame is handed
  /// out; ends the sequence where it returns false. \throws UsageError for options that cannot be rendered
  explicit FrameSource(const SyntheticOptions& options, std::function<bool(const data::RenderedFrames&)> watch = {});

  const Dataset& dataset() const { return dataset_; }
  const StereoRig& rig() const { return dataset_.rig; }
  report::InputFacts facts() const;
  /// Waits for the first frame. \throws DataError if it cannot be read
  void prepare();
  /// The next frame, or nothing at the end. \throws DataError for a frame that cannot be read
  std::optional<StereoPair> next();
  /// Starts again with the first frame.
  void rewind() { pairs_.reset(); }
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
  bool has_begun_ = false;
};

/// Reads "WIDTHxHEIGHT" into the options. \throws UsageError.
void set_size(SyntheticOptions& options, const std::string& size);

// What the user sees of rendering ahead.

/// "rendering 12/60 ..." while frames are rendered; silent while they are read.
class RenderingStatus {
 public:
  /// `interruption` may be null; else its signal ends the rendering.
  RenderingStatus(bool quiet, const Interruption* interruption) : quiet_(quiet), interruption_(interruption) {}
  /// Returns false after a signal.
  bool show(const data::RenderedFrames& frames);

 private:
  bool quiet_;
  const Interruption* interruption_;
  std::optional<Progress> progress_;  ///< its time begins with the first frame
};

}  // namespace quadedge::cli
