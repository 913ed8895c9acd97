#include "data/video_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace quadedge::data {
namespace {

constexpr double kStampsPerSecond = 1e9;  // nanoseconds

/// Last message of the libraries in this thread; the only sign of damage that they conceal.
thread_local std::string complaint;

void note_complaint(void*, int level, const char* format, va_list arguments) {
  if (level > AV_LOG_ERROR) return;
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  complaint = text;
  while (!complaint.empty() && static_cast<unsigned char>(complaint.back()) <= ' ') complaint.pop_back();
}

std::string reason(int error) {
  char text[AV_ERROR_MAX_STRING_SIZE];
  return av_make_error_string(text, sizeof text, error);
}

struct Closer {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};
template <class T>
using Owned = std::unique_ptr<T, Closer>;

/// Samples of the frame's first plane, which is grey or luma, stretched to the full range.
Image first_plane(const AVFrame& frame, const AVPixFmtDescriptor& format, bool broadcast) {
  const int bits = format.comp[0].depth, max_value = (1 << bits) - 1;
  Image image(frame.width, frame.height, max_value);
  // 16 to 235 for 8 bits, and the same shifted for more bits.
  const double black = broadcast ? std::ldexp(16, bits - 8) : 0;
  const double scale = broadcast ? max_value / std::ldexp(219, bits - 8) : 1;
  std::vector<int> value(static_cast<std::size_t>(max_value) + 1);
  for (int i = 0; i <= max_value; ++i)
    value[static_cast<std::size_t>(i)] = std::clamp(static_cast<int>(std::lround((i - black) * scale)), 0, max_value);
  for (int y = 0; y < frame.height; ++y) {
    const std::uint8_t* row = frame.data[0] + static_cast<std::ptrdiff_t>(y) * frame.linesize[0];
    for (int x = 0; x < frame.width; ++x) {
      const std::uint8_t* sample = row + x * format.comp[0].step + format.comp[0].offset;
      int word = *sample;
      if (bits > 8)
        word = (format.flags & AV_PIX_FMT_FLAG_BE) ? sample[0] << 8 | sample[1] : sample[1] << 8 | sample[0];
      image.set(x, y, value[static_cast<std::size_t>((word >> format.comp[0].shift) & max_value)]);
    }
  }
  return image;
}

}  // namespace

class VideoFile::Implementation {
 public:
  explicit Implementation(const std::string& path);
  std::optional<Picture> next();
  int promised() const { return promised_; }
  double fps() const { return fps_; }

 private:
  bool decode();
  void feed();
  std::int64_t stamp() const;
  Image grey();
  Image by_colour(AVPixelFormat format, bool deep);
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    fail(path_, found, expected);
  }
  std::string picture() const { return "frame " + std::to_string(decoded_); }

  std::string path_;
  Owned<AVFormatContext> file_;
  Owned<AVCodecContext> decoder_;
  Owned<AVPacket> packet_{av_packet_alloc()};
  Owned<AVFrame> frame_{av_frame_alloc()};
  Owned<SwsContext> to_bgr_;
  AVRational time_base_{0, 1};
  std::int64_t first_time_ = AV_NOPTS_VALUE;
  double fps_ = 0;
  int stream_ = 0, promised_ = 0;
  int decoded_ = 0;     ///< number of frames so far
  bool ended_ = false;  ///< whether all packets have been passed to the decoder
  int width_ = 0, height_ = 0;
};

VideoFile::Implementation::Implementation(const std::string& path) : path_(path) {
  constexpr const char* kVideo = "a video file";
  if (const std::string kind = irregular_kind(path); !kind.empty()) refuse(kind, kVideo);
  av_log_set_callback(note_complaint);
  complaint.clear();
  AVFormatContext* file = nullptr;
  int error = avformat_open_input(&file, ("file:" + path).c_str(), nullptr, nullptr);
  if (error < 0) refuse(error == AVERROR(ENOENT) ? "no such file" : "no video (" + reason(error) + ")", kVideo);
  file_.reset(file);
  error = avformat_find_stream_info(file, nullptr);
  const AVCodec* codec = nullptr;
  if (error >= 0) error = stream_ = av_find_best_stream(file, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
  if (error < 0) refuse("no video in it (" + reason(error) + ")", kVideo);
  const AVStream& stream = *file->streams[stream_];
  decoder_.reset(avcodec_alloc_context3(codec));
  error = avcodec_parameters_to_context(decoder_.get(), stream.codecpar);
  decoder_->err_recognition |= AV_EF_CRCCHECK | AV_EF_EXPLODE;
  decoder_->thread_count = 1;  // messages must come from this thread
  if (error >= 0) error = avcodec_open2(decoder_.get(), codec, nullptr);
  if (error < 0) refuse("a video that cannot be decoded (" + reason(error) + ")", kVideo);
  time_base_ = stream.time_base;
  const AVRational rate = stream.avg_frame_rate.num > 0 ? stream.avg_frame_rate : stream.r_frame_rate;
  if (rate.num > 0 && rate.den > 0) fps_ = av_q2d(rate);
  const std::int64_t duration = file->duration;
  if (stream.nb_frames > 0) {
    promised_ = static_cast<int>(stream.nb_frames);
  } else if (duration > 0 && file->duration_estimation_method != AVFMT_DURATION_FROM_BITRATE && fps_ > 0) {
    promised_ = static_cast<int>(std::lround(static_cast<double>(duration) / AV_TIME_BASE * fps_));
  }
}

/// Passes the next packet of the video to the decoder, or the end of the video.
void VideoFile::Implementation::feed() {
  int error = 0;
  do {
    av_packet_unref(packet_.get());
    error = av_read_frame(file_.get(), packet_.get());
  } while (error >= 0 && packet_->stream_index != stream_);
  if (error < 0 && error != AVERROR_EOF)
    refuse(picture() + " that cannot be read (" + reason(error) + ")", "an intact video");
  ended_ = error == AVERROR_EOF;
  error = avcodec_send_packet(decoder_.get(), ended_ ? nullptr : packet_.get());
  if (error < 0) refuse("a damaged " + picture() + " (" + reason(error) + ")", "an intact video");
}

/// Decodes the next frame into frame_; returns false after the last one.
bool VideoFile::Implementation::decode() {
  for (;;) {
    const int error = avcodec_receive_frame(decoder_.get(), frame_.get());
    if (error == AVERROR_EOF) return false;
    if (error == 0) return true;
    if (error != AVERROR(EAGAIN)) refuse("a damaged " + picture() + " (" + reason(error) + ")", "an intact video");
    feed();
  }
}

/// A video may round its timestamps; frames without timestamps follow the frame rate.
std::int64_t VideoFile::Implementation::stamp() const {
  if (frame_->best_effort_timestamp == AV_NOPTS_VALUE || first_time_ == AV_NOPTS_VALUE)
    return fps_ > 0 ? std::llround(decoded_ / fps_ * kStampsPerSecond) : decoded_;
  return std::llround(static_cast<double>(frame_->best_effort_timestamp - first_time_) * av_q2d(time_base_) *
                      kStampsPerSecond);
}

/// Converts to BGR, then to grey as for an image file.
Image VideoFile::Implementation::by_colour(AVPixelFormat format, bool deep) {
  const AVPixelFormat target = deep ? AV_PIX_FMT_BGR48LE : AV_PIX_FMT_BGR24;
  cv::Mat bgr(frame_->height, frame_->width, deep ? CV_16UC3 : CV_8UC3), result;
  to_bgr_.reset(sws_getCachedContext(to_bgr_.release(), frame_->width, frame_->height, format, frame_->width,
                                     frame_->height, target, SWS_POINT | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
  if (!to_bgr_) refuse("frames of the format " + std::string(av_get_pix_fmt_name(format)), "grey or colour");
  std::uint8_t* const rows[] = {bgr.data};
  const int strides[] = {static_cast<int>(bgr.step)};
  sws_scale(to_bgr_.get(), frame_->data, frame_->linesize, 0, frame_->height, rows, strides);
  cv::cvtColor(bgr, result, cv::COLOR_BGR2GRAY);
  Image image(frame_->width, frame_->height, deep ? 65535 : kMaxValue8);
  result.copyTo(cv::Mat(image.height, image.width, deep ? CV_16UC1 : CV_8UC1, image.pixels.data()));
  return image;
}

Image VideoFile::Implementation::grey() {
  const auto format = static_cast<AVPixelFormat>(frame_->format);
  const AVPixFmtDescriptor& about = *av_pix_fmt_desc_get(format);
  const bool deep = about.comp[0].depth > 8;
  constexpr std::uint64_t kOther = AV_PIX_FMT_FLAG_RGB | AV_PIX_FMT_FLAG_PAL | AV_PIX_FMT_FLAG_BITSTREAM |
                                   AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT;
  if ((about.flags & kOther) != 0 || about.comp[0].depth > 16) return by_colour(format, deep);
  const bool has_colour = about.nb_components >= 3;
  const bool is_jpeg = format == AV_PIX_FMT_YUVJ420P || format == AV_PIX_FMT_YUVJ422P ||
                       format == AV_PIX_FMT_YUVJ444P || format == AV_PIX_FMT_YUVJ440P;
  return first_plane(*frame_, about, has_colour && !is_jpeg && frame_->color_range != AVCOL_RANGE_JPEG);
}

std::optional<VideoFile::Picture> VideoFile::Implementation::next() {
  complaint.clear();
  if (!decode()) {
    // The duration may refer to the start or the end of the last frame.
    if (decoded_ + 1 < promised_)
      refuse("the end after " + counted(decoded_, "frame"),
             "the " + std::to_string(promised_) + " announced by its header");
    return std::nullopt;
  }
  if (!complaint.empty() && !ended_) refuse("a damaged " + picture() + " (" + complaint + ")", "an intact video");
  if (decoded_ == 0) {
    width_ = frame_->width, height_ = frame_->height;
    first_time_ = frame_->best_effort_timestamp;
  }
  if (frame_->width != width_ || frame_->height != height_) {
    refuse(picture() + " of " + to_string({frame_->width, frame_->height}) + " pixels",
           to_string({width_, height_}) + " as the first one");
  }
  Picture result{stamp(), grey()};
  ++decoded_;
  return result;
}

VideoFile::VideoFile(const std::string& path) : implementation_(std::make_unique<Implementation>(path)) {}
VideoFile::~VideoFile() = default;
std::optional<VideoFile::Picture> VideoFile::next() { return implementation_->next(); }
int VideoFile::promised() const { return implementation_->promised(); }
double VideoFile::fps() const { return implementation_->fps(); }

}  // namespace quadedge::data
