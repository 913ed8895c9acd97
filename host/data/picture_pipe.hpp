#pragma once
/// \file picture_pipe.hpp  Stereo pairs from a pipe of binary PGM or PPM images.

#include <memory>

#include "data/stream_reader.hpp"

namespace quadedge::data {

/// A stream of the pairs read from a file descriptor, which remains owned by the caller. The format is netpbm's: images
/// in direct succession, as written by `ffmpeg -f image2pipe -c:v pgm` and `cat *.pgm`, with 8 bits or, with two bytes
/// per value, up to 16. Only one reader can be opened. It throws DataError for invalid images, images that differ in
/// size or depth from the first of their camera, incomplete images, and a left image without a right one.
std::shared_ptr<StreamOfReaders> make_picture_pipe(int descriptor, const StreamOptions& options);

}  // namespace quadedge::data
