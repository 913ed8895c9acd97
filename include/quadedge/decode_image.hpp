#pragma once
/// \file decode_image.hpp  Decodes images that are in memory, such as compressed messages.

#include <string>
#include <string_view>

#include "quadedge/image.hpp"

namespace quadedge {

/// Decodes a PNG, JPEG, PGM or PPM at its full bit depth, as read_grey_image() does; colour images are converted to
/// luminance. `name` identifies the image in error messages. \throws DataError for a truncated or undecodable image.
Image decode_grey_image(std::string_view bytes, const std::string& name);

}  // namespace quadedge
