#include "data/jpeg_damage.hpp"

#include <csetjmp>
#include <cstddef>
#include <cstdio>
// libjpeg's header depends on the headers above.
#include <jpeglib.h>

namespace quadedge::data {
namespace {

/// Errors and warnings of libjpeg end the reading with a jump, because exceptions cannot pass its C frames.
struct Complaint {
  jpeg_error_mgr manager;  ///< first member, because libjpeg passes its address
  std::jmp_buf end;
  char text[JMSG_LENGTH_MAX];
};

[[noreturn]] void end_reading(j_common_ptr state) {
  auto* complaint = reinterpret_cast<Complaint*>(state->err);
  complaint->manager.format_message(state, complaint->text);
  std::longjmp(complaint->end, 1);
}

/// Level -1 is a warning of damaged data; the others are traces.
void on_message(j_common_ptr state, int level) {
  if (level < 0) end_reading(state);
}

/// Reads all entropy-coded data up to the first error, decoded at an eighth of the size.
void read_all(jpeg_decompress_struct& decoder, Complaint& complaint, std::string_view bytes) {
  if (setjmp(complaint.end) != 0) return;
  jpeg_create_decompress(&decoder);
  jpeg_mem_src(&decoder, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&decoder, TRUE);
  decoder.scale_num = 1;
  decoder.scale_denom = 8;
  jpeg_start_decompress(&decoder);
  JSAMPARRAY row =
      decoder.mem->alloc_sarray(reinterpret_cast<j_common_ptr>(&decoder), JPOOL_IMAGE,
                                decoder.output_width * static_cast<JDIMENSION>(decoder.output_components), 1);
  while (decoder.output_scanline < decoder.output_height) jpeg_read_scanlines(&decoder, row, 1);
  jpeg_finish_decompress(&decoder);
}

}  // namespace

std::string jpeg_damage(std::string_view bytes) {
  if (bytes.substr(0, 2) != "\xFF\xD8") return {};
  Complaint complaint{};
  jpeg_decompress_struct decoder{};
  decoder.err = jpeg_std_error(&complaint.manager);
  complaint.manager.error_exit = end_reading;
  complaint.manager.emit_message = on_message;
  read_all(decoder, complaint, bytes);
  jpeg_destroy_decompress(&decoder);
  return complaint.text;
}

}  // namespace quadedge::data
