#pragma once
/// \file stream_reader.hpp  Stereo pairs from a stream: what videos and pipes have in common, and the pipe of
/// binary PGM or PPM images.

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "quadedge/pair_stream.hpp"

namespace quadedge::data {

/// Arrangement of the left and the right view in an image.
enum class Split { none, left_right, top_bottom };

/// Parses "" (none), "left-right" or "top-bottom" (the left view on top). \throws UsageError
Split parse_split(const std::string& word);

/// How a stream is read.
struct StreamOptions {
  Split split = Split::none;  ///< none: the left and right images are separate
  double fps = 0;             ///< pair i has the timestamp i / fps, even if earlier pairs were dropped; 0: the stream's
  int queue = 0;              ///< see PairStream::longest_queue()
  int first = 0, last = -1;   ///< half-open range of pairs; -1: to the end
  std::vector<std::int64_t> stamps_ns{};  ///< one per pair of the whole stream, in place of all others; empty: none
  std::string stamps_from{};              ///< file of the timestamps
};

/// Reads a stream from its beginning and hands out a part of it.
class StreamReader : public PairReader {
 public:
  explicit StreamReader(StreamOptions options) : options_(std::move(options)) {}
  std::optional<StereoPair> next() final;
  void stop() override { stopped_ = true; }
  /// The first pair of the whole stream, or nothing; next() still hands it out.
  const std::optional<StereoPair>& look() { return first_ = read(); }

 protected:
  /// The next pair of the whole stream with its own timestamp, if it has any.
  virtual std::optional<StereoPair> read() = 0;
  /// The left and the right view of a picture. \throws DataError that names it, if a side cannot be halved
  StereoPair halves(const Image& both, const std::string& picture) const;

  const StreamOptions options_;
  int number_ = 0;  ///< of the pair that read() reads
  std::atomic<bool> stopped_{false};

 private:
  std::optional<StereoPair> first_;
};

/// A stream whose readers a function makes.
class StreamOfReaders : public PairStream {
 public:
  using Make = std::function<std::unique_ptr<StreamReader>()>;
  StreamOfReaders(Make make, int queue) : make_(std::move(make)), queue_(queue) {}
  std::unique_ptr<PairReader> open() const override { return begun_ ? std::move(begun_) : make_(); }
  int longest_queue() const override { return queue_; }
  /// The first pair; the first reader still hands it out. \throws DataError that names `stream` if there is none
  StereoPair look(const std::string& stream);

 private:
  Make make_;
  int queue_;
  mutable std::unique_ptr<StreamReader> begun_;
};

// Stereo pairs from a pipe of binary PGM or PPM images.

/// A stream of the pairs read from a file descriptor, which remains owned by the caller. The format is netpbm's: images
/// in direct succession, as written by `ffmpeg -f image2pipe -c:v pgm` and `cat *.pgm`, with 8 bits or, with two bytes
/// per value, up to 16. Only one reader can be opened. It throws DataError for invalid images, images that differ in
/// size or depth from the first of their camera, incomplete images, and a left image without a right one.
std::shared_ptr<StreamOfReaders> make_picture_pipe(int descriptor, const StreamOptions& options);

}  // namespace quadedge::data
