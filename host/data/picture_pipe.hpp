#pragma once
/// \file picture_pipe.hpp  Stereo pairs from a pipe of binary PGM or PPM images.

#include <memory>

#include "data/split_views.hpp"
#include "quadedge/pair_stream.hpp"

namespace quadedge::data {

/// Format of the pipe.
struct PipeOptions {
  Split split = Split::none;  ///< none: the left and right images of a pair are sent in succession
  double fps = 0;             ///< pair i has the timestamp i / fps, even if earlier pairs were dropped
  int queue = 0;              ///< see PairStream::longest_queue()
};

/// A stream of the pairs read from a file descriptor, which remains owned by the caller. The format is netpbm's: images
/// in direct succession, as written by `ffmpeg -f image2pipe -c:v pgm` and `cat *.pgm`, with 8 bits or, with two bytes
/// per value, up to 16. Only one reader can be opened. It throws DataError for invalid images, images that differ in
/// size or depth from the first of their camera, incomplete images, and a left image without a right one.
std::shared_ptr<const PairStream> make_picture_pipe(int descriptor, const PipeOptions& options);

}  // namespace quadedge::data
