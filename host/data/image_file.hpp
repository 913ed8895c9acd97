#pragma once
/// \file image_file.hpp  Checks image files for format and completeness.
/// Decoders fill truncated images with grey without an error, so that completeness is checked in the container.

#include <string>
#include <string_view>
#include <vector>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Columns and rows, and the largest pixel value.
struct ImageSize {
  int width = 0, height = 0;
  int max_value = kMaxValue8;
  bool operator==(const ImageSize& other) const { return width == other.width && height == other.height; }
  bool operator!=(const ImageSize& other) const { return !(*this == other); }
};

constexpr int kLargestImageSide = 1 << 16;  ///< px

/// "W x H", for messages.
std::string to_string(ImageSize size);

/// Checks a PNG (chunks up to IEND), JPEG (segments, end-of-image marker) or binary PGM/PPM (header against length).
/// \throws DataError that names `file` if it is none of these or incomplete
ImageSize check_complete(std::string_view bytes, const std::string& file);

/// check_complete() of a file. \throws DataError
ImageSize image_size(const std::string& file);

/// Whether the name has the extension of one of the formats above.
bool is_image_name(const std::string& name);

}  // namespace quadedge::data
