#pragma once
/// \file png_codec.hpp  PNG images in memory, by libpng.

#include <opencv2/core.hpp>
#include <string>
#include <string_view>

namespace quadedge::data {

/// height x width samples of 8 or 16 bits: one channel for grey images, three (R, G, B) for colour and palettes. Alpha
/// is dropped, fewer than 8 bits become 8. \throws std::runtime_error with libpng's reason.
cv::Mat decode_png(std::string_view bytes);

/// Encodes a picture of 8 or 16 bits, grey or B, G, R. \throws std::runtime_error with libpng's reason.
std::string encode_png(const cv::Mat& picture);

}  // namespace quadedge::data
