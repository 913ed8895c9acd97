#pragma once
/// \file pair_stream.hpp  Stereo pairs that are no image files of their own: from videos, from a pipe.

#include <cstdint>
#include <memory>
#include <optional>

#include "quadedge/image.hpp"

namespace quadedge {

/// Two grey images of one time.
struct StereoPair {
  int number = 0;  ///< of the pair in its stream, from 0
  std::int64_t stamp_ns = 0;
  Image left, right;
};

/// Pairs in order, each once. Used by one thread, but for stop().
class PairReader {
 public:
  virtual ~PairReader() = default;
  /// The next pair, or nothing at the end or after stop(); a pipe is waited for. \throws DataError that names the
  /// stream and what is wrong with it.
  virtual std::optional<StereoPair> next() = 0;
  /// Ends a next() that waits in another thread, within a tenth of a second.
  virtual void stop() {}
};

/// Where such pairs come from.
class PairStream {
 public:
  virtual ~PairStream() = default;
  /// A reader that begins with the first pair. \throws DataError for a stream that cannot be opened; UsageError for one
  /// that can be read once only (a pipe) and was.
  virtual std::unique_ptr<PairReader> open() const = 0;
  /// Whether pairs come when they come, like those of a camera: where so many wait already, a new pair takes the place
  /// of the oldest. 0: the stream waits for its reader, and no pair is left out.
  virtual int longest_queue() const { return 0; }
};

}  // namespace quadedge
