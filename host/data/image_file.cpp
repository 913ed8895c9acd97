#include "data/image_file.hpp"

#include <cctype>
#include <cstdint>
#include <filesystem>

#include "data/text.hpp"

namespace quadedge::data {
namespace {

using namespace std::string_view_literals;
constexpr int kMaxValue16 = 65535;
constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n"sv;

std::uint32_t big_endian(std::string_view bytes, std::size_t at, int count) {
  std::uint32_t value = 0;
  for (int i = 0; i < count; ++i)
    value = value << 8 | static_cast<std::uint8_t>(bytes[at + static_cast<std::size_t>(i)]);
  return value;
}

[[noreturn]] void truncated(const std::string& file, std::string_view bytes, const char* kind, const char* end) {
  fail(file, std::string("a ") + kind + " that ends after " + std::to_string(bytes.size()) + " bytes", end);
}

ImageSize check_png(std::string_view bytes, const std::string& file) {
  ImageSize size;
  for (std::size_t at = kPngSignature.size();;) {
    if (at + 12 > bytes.size()) truncated(file, bytes, "PNG", "a complete one, closed by its IEND chunk");
    const std::size_t length = big_endian(bytes, at, 4);
    const std::string_view type = bytes.substr(at + 4, 4);
    if (length > bytes.size() - at - 12) truncated(file, bytes, "PNG", "a complete one, closed by its IEND chunk");
    if (type == "IHDR"sv && length >= 8) {
      size = {static_cast<int>(big_endian(bytes, at + 8, 4)), static_cast<int>(big_endian(bytes, at + 12, 4))};
      if (length > 8 && big_endian(bytes, at + 16, 1) == 16) size.max_value = kMaxValue16;
    }
    if (type == "IEND"sv) return size;
    at += 12 + length;
  }
}

/// Start-of-frame markers contain the size: C0 to CF except the three that denote tables.
bool is_start_of_frame(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

ImageSize check_jpeg(std::string_view bytes, const std::string& file) {
  constexpr const char* kComplete = "a complete one, closed by its end-of-image marker";
  ImageSize size;
  for (std::size_t at = 2;;) {
    if (at + 4 > bytes.size()) truncated(file, bytes, "JPEG", kComplete);
    if (big_endian(bytes, at, 1) != 0xFF) fail(file, "a JPEG with a damaged segment", kComplete);
    const std::uint32_t marker = big_endian(bytes, at + 1, 1);
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const std::size_t length = big_endian(bytes, at + 2, 2);
    if (length < 2 || length > bytes.size() - at - 2) truncated(file, bytes, "JPEG", kComplete);
    if (is_start_of_frame(marker) && length >= 7) {
      size = {static_cast<int>(big_endian(bytes, at + 7, 2)), static_cast<int>(big_endian(bytes, at + 5, 2))};
    }
    at += 2 + length;
    if (marker == 0xDA) {  // in the entropy-coded data, only the end marker can be FF D9
      if (bytes.find("\xFF\xD9"sv, at) == std::string_view::npos) truncated(file, bytes, "JPEG", kComplete);
      return size;
    }
  }
}

}  // namespace

PnmHeader read_pnm_header(std::string_view bytes, const std::string& file) {
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
    fail(file, "a PNM with the largest value " + std::to_string(largest), "1 to 65535");
  const PnmHeader header{{width, height, largest}, bytes[1] == '6' ? 3 : 1, at + 1};
  const std::size_t per_pixel = static_cast<std::size_t>(header.channels) * bytes_per_pixel(largest);
  const std::size_t needed = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * per_pixel;
  if (bytes.size() < header.pixels + needed) truncated(file, bytes, "PNM", "all pixels announced by its header");
  if (bytes.size() > header.pixels + needed) {  // a header of another form, whose end is not where it seems to be
    fail(file, "a PNM of " + std::to_string(bytes.size()) + " bytes",
         std::to_string(header.pixels + needed) + ", the header and " + to_string(header.size) + " pixels");
  }
  return header;
}

std::string to_string(ImageSize size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

ImageKind image_kind(std::string_view bytes, const std::string& file) {
  if (bytes.substr(0, kPngSignature.size()) == kPngSignature) return ImageKind::png;
  if (bytes.substr(0, 2) == "\xFF\xD8"sv) return ImageKind::jpeg;
  if (bytes.substr(0, 2) == "P5"sv || bytes.substr(0, 2) == "P6"sv) return ImageKind::pnm;
  fail(file, bytes.empty() ? "an empty file" : "bytes that start with " + in_quotes(bytes.substr(0, 8)),
       "a PNG, JPEG or binary PGM/PPM image");
}

ImageSize check_complete(std::string_view bytes, const std::string& file) {
  const ImageKind kind = image_kind(bytes, file);
  const ImageSize size = kind == ImageKind::png    ? check_png(bytes, file)
                         : kind == ImageKind::jpeg ? check_jpeg(bytes, file)
                                                   : read_pnm_header(bytes, file).size;
  if (size.width <= 0 || size.height <= 0 || size.width > kLargestImageSide || size.height > kLargestImageSide) {
    fail(file, "an image of " + to_string(size) + " pixels", "sides between 1 and 65536");
  }
  return size;
}

ImageSize image_size(const std::string& file) { return check_complete(read_bytes(file), file); }

bool is_image_name(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".pgm" ||
         extension == ".ppm";
}

}  // namespace quadedge::data
