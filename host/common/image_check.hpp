#pragma once
/// \file image_check.hpp  What every image that comes into the library has to fulfil.

#include <string>

#include "quadedge/error.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// \throws DataError, which calls the image `name`, for one without pixels and for a stride below a row's bytes.
inline void check_pixels(const ImageView& image, const std::string& name) {
  if (image.empty()) throw DataError(name + " is empty");
  const auto row_bytes = static_cast<std::ptrdiff_t>(bytes_per_pixel(image.max_value)) * image.width;
  if (image.stride >= row_bytes) return;
  throw DataError(name + " has a stride of " + std::to_string(image.stride) + " bytes, expected at least the " +
                  std::to_string(row_bytes) + " of a row");
}

}  // namespace quadedge
