#pragma once
/// \file image_file.hpp  Checks image files for format and completeness.
/// Decoders fill truncated images with grey without an error, so that completeness is checked in the container.

#include <string>
#include <string_view>
#include <vector>

#include "quadedge/image.hpp"

namespace quadedge::data {

/// Columns and rows, and the largest pixel value.
struct ImageSize {
  int width = 0, height = 0;
  int max_value = kMaxValue8;
  bool operator==(const ImageSize& other) const { return width == other.width && height == other.height; }
  bool operator!=(const ImageSize& other) const { return !(*this == other); }
};

constexpr int kLargestImageSide = 1 << 16;  ///< px

/// "W x H", for messages.
std::string to_string(ImageSize size);

enum class ImageKind { png, jpeg, pnm };

/// The format, by the first bytes. \throws DataError that names `file` if it is none of these
ImageKind image_kind(std::string_view bytes, const std::string& file);

/// Header of a binary PGM (one channel) or PPM (three: R, G, B).
struct PnmHeader {
  ImageSize size;
  int channels = 1;
  std::size_t pixels = 0;  ///< position of the first sample; 16-bit samples are big-endian
};

/// \throws DataError that names `file` if the header is damaged or announces more pixels than there are
PnmHeader read_pnm_header(std::string_view bytes, const std::string& file);

/// Checks a PNG (chunks up to IEND), JPEG (segments, end-of-image marker) or binary PGM/PPM (header against length).
/// \throws DataError that names `file` if it is none of these or incomplete
ImageSize check_complete(std::string_view bytes, const std::string& file);

/// check_complete() of a file. \throws DataError
ImageSize image_size(const std::string& file);

/// Whether the name has the extension of one of the formats above.
bool is_image_name(const std::string& name);

}  // namespace quadedge::data
