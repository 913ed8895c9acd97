#include "data/png_codec.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <png.h>
#include <stdexcept>
#include <vector>
#include <zlib.h>

namespace quadedge::data {
namespace {

constexpr std::size_t kLongestReason = 160;
using Reason = char[kLongestReason];

/// libpng's errors end in a jump, since its C frames pass no exception.
[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  std::snprintf(static_cast<char*>(png_get_error_ptr(png)), kLongestReason, "%s", text);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void take_png_bytes(png_structp png, png_bytep target, std::size_t count) {
  auto& rest = *static_cast<std::string_view*>(png_get_io_ptr(png));
  if (count > rest.size()) png_error(png, "the file ends early");
  std::memcpy(target, rest.data(), count);
  rest.remove_prefix(count);
}

void put_bytes(png_structp png, png_bytep source, std::size_t count) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(source), count);
}

void flush_nothing(png_structp) {}

std::vector<png_bytep> rows_of(const cv::Mat& picture) {
  std::vector<png_bytep> rows;
  for (int y = 0; y < picture.rows; ++y) rows.push_back(const_cast<png_bytep>(picture.ptr(y)));
  return rows;
}

class PngDecoder {
 public:
  explicit PngDecoder(std::string_view bytes) : rest_(bytes) { png_set_read_fn(png_, &rest_, take_png_bytes); }
  ~PngDecoder() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;

  cv::Mat picture() {
    if (!read_header()) throw std::runtime_error(reason_);
    const int depth = png_get_bit_depth(png_, info_) == 16 ? CV_16U : CV_8U;
    cv::Mat result(static_cast<int>(png_get_image_height(png_, info_)),
                   static_cast<int>(png_get_image_width(png_, info_)),
                   CV_MAKETYPE(depth, png_get_channels(png_, info_)));
    std::vector<png_bytep> rows = rows_of(result);
    if (!read_rows(rows.data())) throw std::runtime_error(reason_);
    return result;
  }

 private:
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    const int colour = png_get_color_type(png_, info_);
    if (colour == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png_);
    if ((colour & PNG_COLOR_MASK_COLOR) == 0 && png_get_bit_depth(png_, info_) < 8)
      png_set_expand_gray_1_2_4_to_8(png_);
    png_set_strip_alpha(png_);
    png_set_swap(png_);  // samples of 16 bits are big-endian in the file
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool read_rows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  std::string_view rest_;
  Reason reason_{};
  png_structp png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, reason_, on_error, on_warning);
  png_infop info_ = png_create_info_struct(png_);
};

/// Settings for speed rather than size, those of cv::imencode().
bool encode(png_structp png, png_infop info, const cv::Mat& picture, png_bytepp rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, Z_BEST_SPEED);
  png_set_compression_strategy(png, Z_RLE);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.cols), static_cast<png_uint_32>(picture.rows),
               picture.depth() == CV_16U ? 16 : 8, picture.channels() == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  png_set_bgr(png);
  png_set_swap(png);
  png_write_image(png, rows);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

cv::Mat decode_png(std::string_view bytes) { return PngDecoder(bytes).picture(); }

std::string encode_png(const cv::Mat& picture) {
  std::string bytes;
  Reason reason{};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, reason, on_error, on_warning);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &bytes, put_bytes, flush_nothing);
  std::vector<png_bytep> rows = rows_of(picture);
  const bool done = encode(png, info, picture, rows.data());
  png_destroy_write_struct(&png, &info);
  if (!done) throw std::runtime_error(reason);
  return bytes;
}

}  // namespace quadedge::data
