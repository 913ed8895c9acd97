#pragma once
/// \file decode_image.hpp  Images that do not come from a file of their own: compressed messages, for example.

#include <string>
#include <string_view>

#include "quadedge/image.hpp"

namespace quadedge {

/// Decodes a PNG, JPEG, PGM or PPM as read_grey_image() does, at its full depth; colour becomes luminance. `name`
/// stands for it in complaints. \throws DataError for a truncated or undecodable image.
Image decode_grey_image(std::string_view bytes, const std::string& name);

}  // namespace quadedge
