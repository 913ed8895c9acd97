#pragma once
/// \file split_views.hpp  Pictures that hold both views of a stereo pair.

#include <string>
#include <utility>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// How a picture holds the left and the right view.
enum class Split { none, left_right, top_bottom };

/// "" (none), "left-right" or "top-bottom" (the left view above). \throws UsageError.
Split parse_split(const std::string& word);

/// The left and the right view. \throws DataError that names `picture` for a side that cannot be halved.
std::pair<Image, Image> split_views(const Image& both, Split split, const std::string& picture);

}  // namespace quadedge::data
