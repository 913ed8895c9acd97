#pragma once
/// \file jpeg_damage.hpp  Detects damaged JPEGs, which OpenCV's decoder completes with grey.

#include <string>
#include <string_view>

namespace quadedge::data {

/// First error or warning of libjpeg when decoding the whole JPEG; empty for an intact one and for other formats.
std::string jpeg_damage(std::string_view bytes);

}  // namespace quadedge::data
