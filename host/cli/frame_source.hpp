#pragma once
/// \file frame_source.hpp  Frames in order, from disk or from the renderer.

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "data/rendered_frames.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"
#include "report/run_record.hpp"

namespace quadedge::cli {

/// A sequence that can be run. Only evaluation and drawings use its ground truth.
class FrameSource {
 public:
  virtual ~FrameSource() = default;
  virtual const StereoRig& rig() const = 0;
  virtual report::InputFacts facts() const = 0;
  /// Prepares the frames where that takes long. Returns a warning for the user, or nothing.
  virtual std::string prepare() { return {}; }
  /// The next frame, or nothing at the end. \throws DataError for a frame that cannot be read.
  virtual std::optional<FramePrefetcher::Frame> next() = 0;
  /// Starts again with the first frame.
  virtual void rewind() = 0;
  /// Poses of the left camera; empty when there are none.
  virtual const Trajectory& truth() const = 0;
  /// Where they come from.
  virtual std::string truth_name() const = 0;
  /// Pairs dropped so far because they came faster than they were taken.
  virtual int dropped() const { return 0; }
  /// What prepare() has cached for later runs, as a sentence for the user; empty: nothing.
  virtual std::string kept() const { return {}; }
};

/// A recorded sequence or the user's own cameras; images are read ahead on another thread. `stop`: as FramePrefetcher.
/// `options`: how it was opened, see InputFacts.
std::unique_ptr<FrameSource> make_recorded_source(Dataset dataset, std::function<bool()> stop = {},
                                                  std::vector<std::string> options = {});

/// The built-in sequence, rendered ahead and kept in the user's cache (see data::RenderedFrames). `watch`: called while
/// frames are prepared. \throws UsageError for options that cannot be rendered.
std::unique_ptr<FrameSource> make_synthetic_source(const SyntheticOptions& options,
                                                   data::RenderedFrames::Watch watch = {});

/// Reads "WIDTHxHEIGHT" into the options. \throws UsageError.
void set_size(SyntheticOptions& options, const std::string& size);

}  // namespace quadedge::cli
