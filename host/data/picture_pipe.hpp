#pragma once
/// \file picture_pipe.hpp  Stereo pairs from a pipe: binary PGM or PPM pictures, one after the other.

#include <memory>

#include "data/split_views.hpp"
#include "quadedge/pair_stream.hpp"

namespace quadedge::data {

/// How to read the pipe.
struct PipeOptions {
  Split split = Split::none;  ///< none: the left and the right picture of every pair follow one another
  double fps = 0;             ///< pair i has the stamp i / fps, also where pairs before it were left out
  int queue = 0;              ///< as PairStream::longest_queue()
};

/// A stream of the pairs that come in at a file descriptor, which stays the caller's. The format is netpbm's: pictures
/// follow one another without anything in between, as `ffmpeg -f image2pipe -c:v pgm` and `cat *.pgm` write them; 8
/// bits or, with two bytes per value, up to 16. Its reader can be had once; it throws a DataError for what is no
/// picture, one of another size or depth than the first, one that ends early, and a left one without its right one.
std::shared_ptr<const PairStream> make_picture_pipe(int descriptor, const PipeOptions& options);

}  // namespace quadedge::data
