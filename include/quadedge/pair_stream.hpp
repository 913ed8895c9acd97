#pragma once
/// \file pair_stream.hpp  Stereo pairs that are not stored as image files: from videos and pipes.

#include <cstdint>
#include <memory>
#include <optional>

#include "quadedge/image.hpp"

namespace quadedge {

/// Two grey images of the same time.
struct StereoPair {
  int number = 0;  ///< number of the pair in its stream, from 0
  std::int64_t stamp_ns = 0;
  Image left = {}, right = {};
  Image left_mask = {}, right_mask = {};  ///< see StereoFrame; empty: none
  /// Valid as long as the pair.
  StereoFrame view() const { return {stamp_ns, left.view(), right.view(), left_mask.view(), right_mask.view()}; }
};

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
