#pragma once
/// \file rendered_frames.hpp  Frames of a rendered sequence, rendered ahead of time and cached between runs.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::data {

/// Progress of the rendering.
struct RenderingProgress {
  int ready = 0;     ///< frames that are available
  int frames = 0;    ///< of the whole sequence
  int rendered = 0;  ///< available frames that were not cached by an earlier run
};

/// Renders blocks of frames on all cores before the first of them is used, so that rendering does not slow down the
/// consumer. Views are cached as PGM images with a checksum in FOLDER/KEY, where KEY identifies the scene options and
/// the renderer. Valid cached views are read instead of rendered. Several processes may share the folder. Views that
/// cannot be cached are rendered in every run.
class RenderedFrames {
 public:
  /// Maximum size of the images in memory, and of the cache folder [bytes]; the least recently used sequences are
  /// removed first.
  static constexpr std::uintmax_t kBound = std::uintmax_t{512} << 20U;

  /// Called occasionally by the thread that waits for frames; returning false ends the sequence.
  using Watch = std::function<bool(const RenderingProgress&)>;

  /// \param folder  cache folder of all sequences; empty: no cache \throws UsageError for options that cannot be
  /// rendered
  RenderedFrames(const SyntheticOptions& options, const std::string& folder, Watch watch = {},
                 std::uintmax_t bound = kBound);

  const SyntheticSequence& sequence() const { return sequence_; }
  /// Makes the next frames available. Returns false if the watch ended the sequence.
  bool prepare();
  /// Returns the next frame, or nothing at the end.
  std::optional<FramePrefetcher::Frame> next();
  /// Restarts at the first frame.
  void rewind();

  const RenderingProgress& progress() const { return progress_; }
  /// Cache folder of this sequence, FOLDER/KEY; empty without a cache.
  const std::string& folder() const { return folder_; }
  /// Number of available frames that another run will find in folder().
  int kept() const;
  /// Reason why rendered views are not cached; empty if they are.
  const std::string& cache_error() const { return cache_error_; }

 private:
  bool make_view(int frame, Side side, Image& image);
  std::uintmax_t frames_within_bound() const;
  void make_folder();
  bool tell(int ready, int rendered_views);

  SyntheticSequence sequence_;
  std::string all_folders_, folder_;
  Watch watch_;
  std::uintmax_t bound_;
  int threads_;
  RenderingProgress progress_;
  std::vector<FramePrefetcher::Frame> block_;
  int first_ = 0, next_ = 0;  ///< index of the first frame of the block and of the next frame
  bool ended_ = false;
  std::atomic<bool> keeps_;
  std::string cache_error_;
};

/// Version of everything that determines the pixels: changes with the renderer's sources.
const char* renderer_version();

}  // namespace quadedge::data
