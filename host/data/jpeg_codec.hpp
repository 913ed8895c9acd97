#pragma once
/// \file jpeg_codec.hpp  JPEG images in memory, by libjpeg.

#include <opencv2/core.hpp>
#include <string>
#include <string_view>

namespace quadedge::data {

/// height x width samples of 8 bits: one channel for grey images, three (R, G, B) for colour, on the recorded pixel
/// grid whatever EXIF says. Most decoders fill what they cannot read with grey and go on; here libjpeg's warnings are
/// errors. \throws std::runtime_error with libjpeg's reason.
cv::Mat decode_jpeg(std::string_view bytes);

/// Encodes a picture of 8 bits, grey or B, G, R; `quality` is libjpeg's, 0 to 100. \throws std::runtime_error with
/// libjpeg's reason.
std::string encode_jpeg(const cv::Mat& picture, int quality);

}  // namespace quadedge::data
