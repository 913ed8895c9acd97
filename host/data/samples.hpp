#pragma once
/// \file samples.hpp  From decoded samples to a grey image.

#include <opencv2/core.hpp>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Brings 16-bit samples as PNM files have them into the machine's byte order; leaves 8-bit samples as they are.
void from_big_endian(cv::Mat& samples);

/// Grey image of samples of 8 bits (`max_value` up to 255) or 16 bits, one channel or R, G, B, which become luminance.
/// Samples above `max_value` are limited to it: pixels may exceed the largest value of the header.
Image grey_image(const cv::Mat& samples, int max_value);

}  // namespace quadedge::data
