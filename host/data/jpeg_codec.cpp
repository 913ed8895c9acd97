#include "data/jpeg_codec.hpp"

#include <csetjmp>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
// libjpeg's header needs what stands before it.
#include <jpeglib.h>

namespace quadedge::data {
namespace {

/// libjpeg's errors and warnings end in a jump, since its C frames pass no exception.
struct Complaint {
  jpeg_error_mgr manager;  ///< first: libjpeg hands out its address
  std::jmp_buf end;
  char text[JMSG_LENGTH_MAX];
};

[[noreturn]] void on_error(j_common_ptr state) {
  auto* complaint = reinterpret_cast<Complaint*>(state->err);
  complaint->manager.format_message(state, complaint->text);
  std::longjmp(complaint->end, 1);
}

/// Level -1 warns of damaged data, the others trace.
void on_message(j_common_ptr state, int level) {
  if (level < 0) on_error(state);
}

jpeg_error_mgr* errors_of(Complaint& complaint) {
  jpeg_error_mgr* manager = jpeg_std_error(&complaint.manager);
  manager->error_exit = on_error;
  manager->emit_message = on_message;
  return manager;
}

class Decoder {
 public:
  Decoder() { decoder_.err = errors_of(complaint_); }
  ~Decoder() { jpeg_destroy_decompress(&decoder_); }
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;

  cv::Mat picture(std::string_view bytes) {
    if (!read_header(bytes)) throw std::runtime_error(complaint_.text);
    cv::Mat result(static_cast<int>(decoder_.output_height), static_cast<int>(decoder_.output_width),
                   CV_8UC(decoder_.output_components));
    if (!read_rows(result)) throw std::runtime_error(complaint_.text);
    return result;
  }

 private:
  bool read_header(std::string_view bytes) {
    if (setjmp(complaint_.end) != 0) return false;
    jpeg_create_decompress(&decoder_);
    jpeg_mem_src(&decoder_, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
    jpeg_read_header(&decoder_, TRUE);
    decoder_.out_color_space = decoder_.num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_start_decompress(&decoder_);
    return true;
  }
  bool read_rows(cv::Mat& picture) {
    if (setjmp(complaint_.end) != 0) return false;
    while (decoder_.output_scanline < decoder_.output_height) {
      JSAMPROW row = picture.ptr(static_cast<int>(decoder_.output_scanline));
      jpeg_read_scanlines(&decoder_, &row, 1);
    }
    jpeg_finish_decompress(&decoder_);
    return true;
  }

  Complaint complaint_{};
  jpeg_decompress_struct decoder_{};
};

bool encode(jpeg_compress_struct& encoder, Complaint& complaint, const cv::Mat& picture, int quality,
            unsigned char** bytes, unsigned long* size) {
  if (setjmp(complaint.end) != 0) return false;
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

}  // namespace

cv::Mat decode_jpeg(std::string_view bytes) { return Decoder().picture(bytes); }

std::string encode_jpeg(const cv::Mat& picture, int quality) {
  cv::Mat rgb = picture;
  if (picture.channels() == 3) cv::cvtColor(picture, rgb, cv::COLOR_BGR2RGB);
  Complaint complaint{};
  jpeg_compress_struct encoder{};
  encoder.err = errors_of(complaint);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool done = encode(encoder, complaint, rgb, quality, &bytes, &size);
  jpeg_destroy_compress(&encoder);
  const std::string result = done ? std::string(reinterpret_cast<const char*>(bytes), size) : std::string();
  std::free(bytes);
  if (!done) throw std::runtime_error(complaint.text);
  return result;
}

}  // namespace quadedge::data
