#pragma once
/// \file rendered_frames.hpp  The pairs of a rendered sequence, cached between runs.

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "quadedge/pair_stream.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::data {

/// Renders on all cores before the first pair is handed out, so that rendering does not slow down whoever uses it, and
/// caches views as PNG files whose names identify the options and the renderer. Several processes may share the folder.
class RenderedFrames : public PairStream, public std::enable_shared_from_this<RenderedFrames> {
 public:
  /// Maximum size of the images in memory, and of the cache folder [bytes]; the least recently used files are removed
  /// first.
  static constexpr std::uintmax_t kBound = std::uintmax_t{512} << 20U;

  /// To be owned by a shared pointer. \param folder  cache folder of all sequences; empty: no cache
  /// \throws UsageError for options that cannot be rendered
  RenderedFrames(const SyntheticOptions& options, const std::string& folder, std::uintmax_t bound = kBound);
  std::unique_ptr<PairReader> open() const override;

  const SyntheticSequence& sequence() const { return sequence_; }
  int ready() const { return views_ / 2; }               ///< frames that the last reader has made so far
  int rendered() const { return (rendered_ + 1) / 2; }   ///< frames that were not in the cache
  const std::string& folder() const { return folder_; }  ///< of the cache; empty without one
  /// Reason why views are not cached; empty if they are. To be read when frames are ready.
  const std::string& cache_error() const { return cache_error_; }

 private:
  class Reader;
  Image view(int frame, Side side) const;

  const SyntheticSequence sequence_;
  const std::string folder_, start_;  ///< cache folder; start of the names of the views in it
  const std::uintmax_t bound_;
  mutable std::atomic<int> views_{0}, rendered_{0};
  mutable std::atomic<bool> caches_;
  mutable std::string cache_error_;
};

/// Version of everything that determines the pixels: changes with the renderer's sources.
const char* renderer_version();

}  // namespace quadedge::data
