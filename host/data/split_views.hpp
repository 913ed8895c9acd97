#pragma once
/// \file split_views.hpp  Splits images that contain both views of a stereo pair.

#include <string>
#include <utility>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Arrangement of the left and the right view in an image.
enum class Split { none, left_right, top_bottom };

/// Parses "" (none), "left-right" or "top-bottom" (the left view on top). \throws UsageError
Split parse_split(const std::string& word);

/// The left and the right view. \throws DataError that names `picture`, if a side cannot be halved
std::pair<Image, Image> split_views(const Image& both, Split split, const std::string& picture);

}  // namespace quadedge::data
