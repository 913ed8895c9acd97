#pragma once
/// \file image_check.hpp  Checks of every image passed to the library.

#include <string>

#include "quadedge/error.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// \throws DataError for an empty image and for a stride smaller than a row; `name` identifies the image.
inline void check_pixels(const ImageView& image, const std::string& name) {
  if (image.empty()) throw DataError(name + " is empty");
  const auto row_bytes = static_cast<std::ptrdiff_t>(bytes_per_pixel(image.max_value)) * image.width;
  if (image.stride >= row_bytes) return;
  throw DataError(name + " has a stride of " + std::to_string(image.stride) + " bytes, expected at least the " +
                  std::to_string(row_bytes) + " of a row");
}

}  // namespace quadedge
