#include "data/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "data/image_codecs.hpp"
#include "data/text.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace data {
namespace {

using namespace std::string_view_literals;
constexpr int kMaxValue16 = 65535;
constexpr double kMostPixels = 1 << 30;
constexpr std::string_view kPngStart = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"sv;  // the signature and its first chunk's head

enum class ImageKind { png, jpeg, pnm };

struct ImageHeader {
  ImageKind kind;
  ImageSize size;
  int channels = 0;        ///< PNM: 1, or 3 for R, G, B
  std::size_t pixels = 0;  ///< PNM: position of the first sample; 16-bit samples are big-endian
};

/// The header of a binary PGM or PPM, which has to be as long as the header says.
ImageHeader pnm_header(std::string_view bytes, const std::string& name) {
  std::size_t at = 2;
  const auto next_number = [&] {
    while (at < bytes.size() && (std::isspace(static_cast<unsigned char>(bytes[at])) || bytes[at] == '#')) {
      at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
    }
    int value = 0;
    for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) && value < 100'000; ++at) {
      value = value * 10 + (bytes[at] - '0');
    }
    return value;
  };
  const int width = next_number(), height = next_number(), largest = next_number();
  if (largest < 1 || largest > kMaxValue16)
    fail(name, "a PNM with the largest value " + std::to_string(largest), "1 to 65535");
  const ImageHeader header{ImageKind::pnm, {width, height, largest}, bytes[1] == '6' ? 3 : 1, at + 1};
  const std::size_t length = header.pixels + static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                                                 static_cast<std::size_t>(header.channels) * bytes_per_pixel(largest);
  if (bytes.size() != length)
    fail(name, "a PNM of " + std::to_string(bytes.size()) + " bytes",
         std::to_string(length) + ", the header and " + to_string(header.size) + " pixels");
  return header;
}

ImageHeader read_header(std::string_view bytes, const std::string& name) {
  if (bytes.substr(0, 2) == "P5"sv || bytes.substr(0, 2) == "P6"sv) return pnm_header(bytes, name);
  if (bytes.substr(0, 2) == "\xFF\xD8"sv) return {ImageKind::jpeg, jpeg_size(bytes)};
  if (bytes.substr(0, 8) == kPngStart.substr(0, 8)) {
    const auto* number = reinterpret_cast<const std::uint8_t*>(bytes.data()) + kPngStart.size();
    if (bytes.size() < kPngStart.size() + 9 || bytes.substr(0, kPngStart.size()) != kPngStart)
      throw std::runtime_error("no header");
    const auto side = [](const std::uint8_t* at) {
      return static_cast<int>(static_cast<std::uint32_t>(at[0]) << 24 | at[1] << 16 | at[2] << 8 | at[3]);
    };
    return {ImageKind::png, {side(number), side(number + 4), number[8] == 16 ? kMaxValue16 : kMaxValue8}};
  }
  const bool is_tiff = bytes.substr(0, 4) == "II*\0"sv || bytes.substr(0, 4) == "MM\0*"sv;
  if (is_tiff || bytes.substr(0, 2) == "BM"sv) fail(name, is_tiff ? "a TIFF image" : "a BMP image", kConverted);
  fail(name, bytes.empty() ? "an empty file" : "bytes that start with " + in_quotes(bytes.substr(0, 8)),
       "a PNG, JPEG or binary PGM/PPM image");
}

/// \throws DataError also for images that are too large
ImageHeader checked_header(std::string_view bytes, const std::string& name) {
  try {
    const ImageHeader header = read_header(bytes, name);
    const ImageSize& size = header.size;
    if (size.width > 0 && size.height > 0 && size.width <= kLargestImageSide && size.height <= kLargestImageSide)
      return header;
    fail(name, "an image of " + to_string(size) + " pixels", "sides between 1 and 65536");
  } catch (const Error&) {
    throw;
  } catch (const std::runtime_error& problem) {
    fail(name, std::string("a damaged image (") + problem.what() + ")", "an intact one");
  }
}

cv::Mat decode(const ImageHeader& header, std::string_view bytes) {
  if (header.kind == ImageKind::png) return decode_png(bytes);
  if (header.kind == ImageKind::jpeg) return decode_jpeg(bytes);
  const int depth = header.size.max_value > kMaxValue8 ? CV_16U : CV_8U;
  cv::Mat samples(header.size.height, header.size.width, CV_MAKETYPE(depth, header.channels));
  std::memcpy(samples.data, bytes.data() + header.pixels, samples.total() * samples.elemSize());
  from_big_endian(samples);
  return samples;
}

}  // namespace

std::string to_string(ImageSize size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

ImageSize image_size(const std::string& file) { return checked_header(read_bytes(file), file).size; }

namespace {

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

}  // namespace

bool is_other_image_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".tif" || extension == ".tiff" || extension == ".bmp";
}

bool is_image_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".pgm" ||
         extension == ".ppm";
}

}  // namespace data

Image read_grey_image(const std::string& path) { return decode_grey_image(data::read_bytes(path), path); }

Image decode_grey_image(std::string_view bytes, const std::string& name) {
  const data::ImageHeader header = data::checked_header(bytes, name);
  const data::ImageSize& size = header.size;
  const std::string intact = "an intact " + data::to_string(size) + " image";
  if (static_cast<double>(size.width) * size.height > data::kMostPixels)
    data::fail(name, "an image of " + data::to_string(size) + " pixels", "2^30 pixels at most");
  try {
    const cv::Mat samples = data::decode(header, bytes);
    if (samples.cols == size.width && samples.rows == size.height) return data::grey_image(samples, size.max_value);
  } catch (const cv::Exception& problem) {
    data::fail(name, "an image that cannot be decoded (" + problem.err + ")", intact);
  } catch (const std::runtime_error& problem) {
    const char* kind = header.kind == data::ImageKind::png ? "PNG" : "JPEG";
    data::fail(name, std::string("a damaged ") + kind + " (" + problem.what() + ")", intact);
  }
  data::fail(name, "an image of another size than its header says", intact);
}

}  // namespace quadedge
