#pragma once
/// \file pair_stream.hpp  Stereo pairs that are not stored as image files: from videos and pipes.

#include <memory>
#include <optional>

#include "quadedge/image.hpp"

namespace quadedge {

/// Reads pairs in order, each once. To be used by one thread, except for stop().
class PairReader {
 public:
  virtual ~PairReader() = default;
  /// Returns the next pair, or nothing at the end or after stop(). Blocks while a pipe has no data. \throws DataError
  /// that names the stream and the problem.
  virtual std::optional<StereoPair> next() = 0;
  /// Ends a next() that blocks in another thread, within 0.1 s.
  virtual void stop() {}
};

/// A source of stereo pairs.
class PairStream {
 public:
  virtual ~PairStream() = default;
  /// Returns a reader that starts at the first pair. \throws DataError if the stream cannot be opened; UsageError if it
  /// can be read only once (a pipe) and has been read.
  virtual std::unique_ptr<PairReader> open() const = 0;
  /// Length of the queue of a live stream: if this many pairs are waiting, a new pair replaces the oldest. 0: the
  /// stream waits for its reader, and no pair is dropped.
  virtual int longest_queue() const { return 0; }
};

}  // namespace quadedge
