#pragma once
/// \file video_stream.hpp  Stereo pairs of one video that holds both views, or of two.

#include <memory>
#include <string>

#include "data/split_views.hpp"
#include "quadedge/pair_stream.hpp"

namespace quadedge::data {

/// Which pictures make a pair.
struct VideoPair {
  std::string left, right;  ///< two files; or `left` alone, with
  Split split = Split::none;
  double fps = 0;  ///< of the stamps; 0: times of the left video's pictures, by which both videos have to agree
};

/// A stream of the pairs. Its readers throw a DataError, which names the file, where one video ends before the other.
std::shared_ptr<const PairStream> make_video_stream(const VideoPair& videos);

}  // namespace quadedge::data
