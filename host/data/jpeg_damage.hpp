#pragma once
/// \file jpeg_damage.hpp  Is a JPEG whole? OpenCV's decoder fills what it cannot read with grey and goes on.

#include <string>
#include <string_view>

namespace quadedge::data {

/// What libjpeg finds wrong, warnings included, when it reads all of a JPEG; empty for an intact one and for bytes that
/// are no JPEG.
std::string jpeg_damage(std::string_view bytes);

}  // namespace quadedge::data
