#pragma once
/// \file video_stream.hpp  Stereo pairs from one video with both views, or from two videos.

#include <memory>
#include <optional>

#include "data/split_views.hpp"
#include "data/video_file.hpp"
#include "quadedge/pair_stream.hpp"

namespace quadedge::data {

/// The videos that contain the pairs.
struct VideoPair {
  Video left;
  std::optional<Video> right;  ///< none if `left` contains both views, with `split`
  Split split = Split::none;
  double fps = 0;  ///< for timestamps; 0: those of the left video's frames, which the right video has to match
};

/// A stream of the pairs. Its readers throw DataError that names the file, if one video ends before the other.
std::shared_ptr<const PairStream> make_video_stream(const VideoPair& videos);

}  // namespace quadedge::data
