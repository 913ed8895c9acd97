#pragma once
/// \file rendered_frames.hpp  Frames of a rendered sequence, made ahead of their use and kept between runs.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::data {

/// How far a sequence is.
struct RenderingProgress {
  int ready = 0;     ///< frames that need not be waited for
  int frames = 0;    ///< of the whole sequence
  int rendered = 0;  ///< of the ready ones, those that were not kept from an earlier run
};

/// Renders whole blocks of frames on all cores before the first of them is asked for, so that whoever takes them works
/// at its own speed. Views are kept as PGM images with a checksum in FOLDER/KEY, where KEY stands for the scene's
/// options and the renderer: one that is there, whole and sound, is read instead of rendered. Several processes may
/// share the folder. What cannot be kept is rendered all the same.
class RenderedFrames {
 public:
  /// Bytes of images that may be in memory at a time, and that stay in the folder: the sequences that were not used for
  /// the longest time go first.
  static constexpr std::uintmax_t kBound = std::uintmax_t{512} << 20U;

  /// Told now and then by the thread that waits for frames; false ends the sequence.
  using Watch = std::function<bool(const RenderingProgress&)>;

  /// \param folder  of all kept sequences; empty: nothing is kept \throws UsageError for options that cannot be
  /// rendered
  RenderedFrames(const SyntheticOptions& options, const std::string& folder, Watch watch = {},
                 std::uintmax_t bound = kBound);

  const SyntheticSequence& sequence() const { return sequence_; }
  /// Makes the next frames ready if none is. Returns false when the watch ended the sequence.
  bool prepare();
  /// The next frame, or nothing at the end.
  std::optional<FramePrefetcher::Frame> next();
  /// Starts again with the first frame.
  void rewind();

  const RenderingProgress& progress() const { return progress_; }
  /// Where this sequence's views are kept, FOLDER/KEY; empty without a folder.
  const std::string& folder() const { return folder_; }
  /// How many of the ready frames another run will find in folder().
  int kept() const;
  /// Why views that were rendered are not kept; empty when they are.
  const std::string& why_not_kept() const { return why_not_kept_; }

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
  int first_ = 0, next_ = 0;  ///< number of the block's first frame and of the one that comes next
  bool ended_ = false;
  std::atomic<bool> keeps_;
  std::string why_not_kept_;
};

/// Stands for everything in this program that decides the pixels: changes with the sources of the renderer.
const char* renderer_version();

}  // namespace quadedge::data
