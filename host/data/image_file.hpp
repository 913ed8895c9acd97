#pragma once
/// \file image_file.hpp  Sizes of images, from their files' headers.

#include <string>

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

/// Size by the header of a PNG, JPEG or binary PGM/PPM. \throws DataError if the file is none of these, or the header
/// is damaged
ImageSize image_size(const std::string& file);

/// Whether the name has the extension of one of the formats above.
bool is_image_name(const std::string& name);

/// Whether the name has the extension of TIFF or BMP, which are not read.
bool is_other_image_name(const std::string& name);

/// What is expected in place of TIFF and BMP.
inline constexpr const char* kConverted =
    "PNG, JPEG, PGM or PPM; `mogrify -format png *` of ImageMagick converts others, at their full depth";

}  // namespace quadedge::data
