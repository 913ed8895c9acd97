#pragma once
/// \file image_file.hpp  Sizes of images from their files' headers; PNG and JPEG in memory, by libpng and libjpeg;
/// samples of images.

#include <opencv2/core.hpp>
#include <string>
#include <string_view>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge::data {

/// Columns and rows, and the largest pixel value.
struct ImageSize {
  int width = 0, height = 0;
  int max_value = kMaxValue8;
  bool operator==(const ImageSize& other) const { return width == other.width && height == other.height; }
  bool operator!=(const ImageSize& other) const { return !(*this == other); }
};

inline ImageSize size_of(const PinholeCamera& camera) { return {camera.width, camera.height}; }
inline ImageSize size_of(const Image& image) { return {image.width, image.height, image.max_value}; }
inline void set_size(PinholeCamera& camera, ImageSize size) {
  camera.width = size.width;
  camera.height = size.height;
}

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

/// A mask: a grey image. \throws DataError for one with transparent pixels, of which nobody knows what they mean
Image read_mask(const std::string& file);

/// Encodes a picture of 8 bits, grey or B, G, R; `quality` is libjpeg's, 0 to 100. \throws std::runtime_error
std::string encode_jpeg(const cv::Mat& picture, int quality);

/// Encodes a picture of 8 or 16 bits, grey or B, G, R. \throws std::runtime_error with libpng's reason
std::string encode_png(const cv::Mat& picture);

/// The pixels of an image for OpenCV, which shares them.
cv::Mat matrix_of(const Image& image);

/// Brings 16-bit samples as PNM files have them into the machine's byte order; leaves 8-bit samples as they are.
void from_big_endian(cv::Mat& samples);

/// Grey image of samples of 8 bits (`max_value` up to 255) or 16 bits, one channel or R, G, B, which become luminance.
/// Samples above `max_value` are limited to it: pixels may exceed the largest value of the header.
Image grey_image(const cv::Mat& samples, int max_value);

}  // namespace quadedge::data
