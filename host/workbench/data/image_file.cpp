/// \file image_file.cpp  Own parser of headers and PNM; libpng and libjpeg, whose errors return by longjmp().
#include "data/image_file.hpp"

#include <algorithm>
#include <cctype>
#include <csetjmp>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

#include "data/text.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

// libjpeg's header needs what stands before it.
#include <jpeglib.h>
#include <png.h>
#include <zlib.h>

// Errors of both libraries end in a jump, since their C frames pass no exception. The functions that are jumped back to
// have no variables with destructors.
namespace quadedge::data {
namespace {

using namespace std::string_view_literals;

struct JpegErrors {
  jpeg_error_mgr manager;  ///< first: libjpeg hands out its address
  std::jmp_buf end;
  char reason[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_jpeg_error(j_common_ptr state) {
  auto* errors = reinterpret_cast<JpegErrors*>(state->err);
  errors->manager.format_message(state, errors->reason);
  std::longjmp(errors->end, 1);
}

/// Level -1 warns of damaged data, the others trace.
void on_jpeg_message(j_common_ptr state, int level) {
  if (level < 0) on_jpeg_error(state);
}

jpeg_error_mgr* managed(JpegErrors& errors) {
  jpeg_error_mgr* manager = jpeg_std_error(&errors.manager);
  manager->error_exit = on_jpeg_error;
  manager->emit_message = on_jpeg_message;
  return manager;
}

/// Reads the header, and the samples into `picture` unless it is null.
bool read_jpeg(jpeg_decompress_struct& decoder, JpegErrors& errors, std::string_view bytes, cv::Mat* picture) {
  if (setjmp(errors.end) != 0) return false;
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder, TRUE);
  if (picture == nullptr) return true;
  decoder.out_color_space = decoder.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_start_decompress(&decoder);
  picture->create(static_cast<int>(decoder.output_height), static_cast<int>(decoder.output_width),
                  CV_8UC(decoder.output_components));
  while (decoder.output_scanline < decoder.output_height) {
    JSAMPROW row = picture->ptr(static_cast<int>(decoder.output_scanline));
    jpeg_read_scanlines(&decoder, &row, 1);
  }
  jpeg_finish_decompress(&decoder);
  return true;
}

/// Columns, rows and largest value by the header of a JPEG; its samples in `picture` unless that is null. On the
/// recorded pixel grid whatever EXIF says. Most decoders fill what they cannot read with grey and go on; here libjpeg's
/// warnings are errors. \throws std::runtime_error with libjpeg's reason
ImageSize open_jpeg(std::string_view bytes, cv::Mat* picture) {
  JpegErrors errors{};
  jpeg_decompress_struct decoder{};
  decoder.err = managed(errors);
  const bool done = read_jpeg(decoder, errors, bytes, picture);
  const ImageSize size{static_cast<int>(decoder.image_width), static_cast<int>(decoder.image_height)};
  jpeg_destroy_decompress(&decoder);
  if (!done) throw std::runtime_error(errors.reason);
  return size;
}

bool write_jpeg(jpeg_compress_struct& encoder, JpegErrors& errors, const cv::Mat& picture, int quality,
                unsigned char** bytes, unsigned long* size) {
  if (setjmp(errors.end) != 0) return false;
  jpeg_create_compress(&encoder);
  jpeg_mem_dest(&encoder, bytes, size);
  encoder.image_width = static_cast<JDIMENSION>(picture.cols);
  encoder.image_height = static_cast<JDIMENSION>(picture.rows);
  encoder.input_components = picture.channels();
  encoder.in_color_space = picture.channels() == 3 ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&encoder);
  jpeg_set_quality(&encoder, quality, TRUE);
  jpeg_start_compress(&encoder, TRUE);
  while (encoder.next_scanline < encoder.image_height) {
    JSAMPROW row = const_cast<JSAMPROW>(picture.ptr(static_cast<int>(encoder.next_scanline)));
    jpeg_write_scanlines(&encoder, &row, 1);
  }
  jpeg_finish_compress(&encoder);
  return true;
}

constexpr std::size_t kLongestReason = 160;
using PngReason = char[kLongestReason];

[[noreturn]] void on_png_error(png_structp png, png_const_charp text) {
  std::snprintf(static_cast<char*>(png_get_error_ptr(png)), kLongestReason, "%s", text);
  png_longjmp(png, 1);
}

void on_png_warning(png_structp, png_const_charp) {}

void take_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto& rest = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > rest.size()) png_error(png, "the file ends early");
  std::memcpy(target, rest.data(), count);
  rest.remove_prefix(count);
}

void put_bytes(png_structp png, png_bytep source, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(source), count);
}

void flush_nothing(png_structp) {}

bool read_png(png_structp png, png_infop info, int transforms, cv::Mat* picture) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  // Samples of 16 bits are big-endian in the file.
  png_read_png(png, info, PNG_TRANSFORM_EXPAND | PNG_TRANSFORM_SWAP_ENDIAN | transforms, nullptr);
  const auto width = png_get_image_width(png, info), height = png_get_image_height(png, info);
  const int depth = png_get_bit_depth(png, info) == 16 ? CV_16U : CV_8U;
  picture->create(static_cast<int>(height), static_cast<int>(width), CV_MAKETYPE(depth, png_get_channels(png, info)));
  for (png_uint_32 y = 0; y < height; ++y)
    std::memcpy(picture->ptr(static_cast<int>(y)), png_get_rows(png, info)[y], png_get_rowbytes(png, info));
  return true;
}

/// Settings for speed rather than size, those of cv::imencode().
bool write_png(png_structp png, png_infop info, const cv::Mat& picture, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, Z_BEST_SPEED);
  png_set_compression_strategy(png, Z_RLE);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.cols), static_cast<png_uint_32>(picture.rows),
               picture.depth() == CV_16U ? 16 : 8, picture.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_rows(png, info, rows);
  png_write_png(png, info, PNG_TRANSFORM_BGR | PNG_TRANSFORM_SWAP_ENDIAN, nullptr);
  return true;
}

/// height x width samples of 8 or 16 bits: one channel for grey images, three (R, G, B) for colour and palettes; alpha
/// is dropped, or a further channel. Fewer than 8 bits become 8. \throws std::runtime_error with libpng's reason
cv::Mat decode_png(std::string_view bytes, bool keeps_alpha = false) {
  PngReason reason{};
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, reason, on_png_error, on_png_warning);
  png_infop info = png_create_info_struct(png);
  png_set_read_fn(png, &bytes, take_bytes);
  cv::Mat picture;
  const bool done = read_png(png, info, keeps_alpha ? 0 : PNG_TRANSFORM_STRIP_ALPHA, &picture);
  png_destroy_read_struct(&png, &info, nullptr);
  if (!done) throw std::runtime_error(reason);
  return picture;
}

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
  if (bytes.substr(0, 2) == "\xFF\xD8"sv) return {ImageKind::jpeg, open_jpeg(bytes, nullptr)};
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
  cv::Mat samples;
  if (header.kind == ImageKind::jpeg) {
    open_jpeg(bytes, &samples);
    return samples;
  }
  const int depth = header.size.max_value > kMaxValue8 ? CV_16U : CV_8U;
  samples.create(header.size.height, header.size.width, CV_MAKETYPE(depth, header.channels));
  std::memcpy(samples.data, bytes.data() + header.pixels, samples.total() * samples.elemSize());
  from_big_endian(samples);
  return samples;
}

std::string extension_of(const std::string& name) {
  std::string extension = std::filesystem::path(name).extension().string();
  for (char& letter : extension) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  return extension;
}

}  // namespace

std::string to_string(ImageSize size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

ImageSize image_size(const std::string& file) { return checked_header(read_bytes(file), file).size; }

bool is_other_image_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".tif" || extension == ".tiff" || extension == ".bmp";
}

bool is_image_name(const std::string& name) {
  const std::string extension = extension_of(name);
  return extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".pgm" ||
         extension == ".ppm";
}

std::string encode_jpeg(const cv::Mat& picture, int quality) {
  cv::Mat rgb = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, rgb, cv::COLOR_BGR2RGB);
  JpegErrors errors{};
  jpeg_compress_struct encoder{};
  encoder.err = managed(errors);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool done = write_jpeg(encoder, errors, rgb, quality, &bytes, &size);
  jpeg_destroy_compress(&encoder);
  const std::string result = done ? std::string(reinterpret_cast<const char*>(bytes), size) : std::string();
  std::free(bytes);
  if (!done) throw std::runtime_error(errors.reason);
  return result;
}

Image read_mask(const std::string& file) {
  const std::string bytes = read_bytes(file);
  Image mask = decode_grey_image(bytes, file);
  if (read_header(std::string_view(bytes), file).kind != ImageKind::png) return mask;
  const cv::Mat samples = decode_png(bytes, true);
  if (samples.channels() % 2 == 1) return mask;  // no alpha
  cv::Mat alpha;
  cv::extractChannel(samples, alpha, samples.channels() - 1);
  double least = 0;
  cv::minMaxLoc(alpha, &least);
  if (least < (alpha.depth() == CV_16U ? kMaxValue16 : kMaxValue8))
    fail(file, "a mask with transparent pixels", "an opaque one: black where no edges are wanted, white elsewhere");
  return mask;
}

std::string encode_png(const cv::Mat& picture) {
  std::string bytes;
  PngReason reason{};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, reason, on_png_error, on_png_warning);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, put_bytes, flush_nothing);
  std::vector<png_bytep> rows;
  for (int y = 0; y < picture.rows; ++y) rows.push_back(const_cast<png_bytep>(picture.ptr(y)));
  const bool done = write_png(png, info, picture, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!done) throw std::runtime_error(reason);
  return bytes;
}

cv::Mat matrix_of(const Image& image) {
  const int type = image.max_value > kMaxValue8 ? CV_16UC1 : CV_8UC1;
  return {image.height, image.width, type, const_cast<std::uint8_t*>(image.pixels.data())};
}

void from_big_endian(cv::Mat& samples) {
  if (samples.depth() != CV_16U) return;
  for (int y = 0; y < samples.rows; ++y) {
    auto* words = samples.ptr<std::uint16_t>(y);
    const std::uint8_t* bytes = samples.ptr(y);
    for (int i = 0; i < samples.cols * samples.channels(); ++i)
      words[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  }
}

Image grey_image(const cv::Mat& samples, int max_value) {
  cv::Mat grey = samples;
  if (samples.channels() == 3) cv::cvtColor(samples, grey, cv::COLOR_RGB2GRAY);
  Image image(samples.cols, samples.rows, max_value);
  cv::min(grey, max_value, matrix_of(image));
  return image;
}

}  // namespace quadedge::data

namespace quadedge {

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
