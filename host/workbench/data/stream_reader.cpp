/// \file stream_reader.cpp  Splits images with both views and sets stamps; polls the pipe, so that it can be stopped.
#include "data/stream_reader.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <exception>
#include <opencv2/core.hpp>
#include <poll.h>
#include <unistd.h>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

Image part_of(const Image& whole, const cv::Rect& place) {
  Image part(place.width, place.height, whole.max_value);
  matrix_of(whole)(place).copyTo(matrix_of(part));
  return part;
}

constexpr const char* kName = "the pipe";
constexpr int kPollInterval = 100;  // ms between checks for a request to stop

/// Thrown after stop().
struct Stopped : std::exception {};

class PipeReader : public StreamReader {
 public:
  PipeReader(int descriptor, const StreamOptions& options)
      : StreamReader(options), descriptor_(descriptor), buffer_(1 << 16) {}

 private:
  std::optional<StereoPair> read() override {
    try {
      return read_pair();
    } catch (const Stopped&) {
      return std::nullopt;
    }
  }

  std::optional<StereoPair> read_pair() {
    auto first = read_picture();
    if (!first) return std::nullopt;
    if (options_.split != Split::none) return halves(*first, kName);
    auto second = read_picture();
    if (!second) fail(kName, "the end after a left image", "a right image");
    return StereoPair{0, 0, std::move(*first), std::move(*second)};
  }

  /// Returns the next byte, or -1 at the end of the pipe.
  int next_byte() {
    if (at_ == filled_ && !fill()) return -1;
    return static_cast<unsigned char>(buffer_[at_++]);
  }

  /// Waits for more bytes; returns false at the end.
  bool fill() {
    for (;;) {
      if (stopped_) throw Stopped();
      pollfd waiting{descriptor_, POLLIN, 0};
      const int ready = poll(&waiting, 1, kPollInterval);
      if (ready == 0 || (ready < 0 && errno == EINTR)) continue;
      const ssize_t count = ::read(descriptor_, buffer_.data(), buffer_.size());
      if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (count < 0) fail(kName, std::string("a read error: ") + std::strerror(errno), "images");
      at_ = 0;
      filled_ = static_cast<std::size_t>(count);
      return count > 0;
    }
  }

  [[noreturn]] void refuse_header() const {
    fail(kName, picture() + " without a valid header", "binary PGM (P5) or PPM (P6) images in succession");
  }
  std::string picture() const { return "image " + std::to_string(pictures_); }

  int header_number() {
    int letter = next_byte();
    while (letter == '#' || std::isspace(letter)) {
      const bool is_comment = letter == '#';
      letter = next_byte();
      while (is_comment && letter != '\n' && letter >= 0) letter = next_byte();
    }
    int value = 0;
    if (!std::isdigit(letter)) refuse_header();
    for (; std::isdigit(letter); letter = next_byte()) {
      value = value * 10 + (letter - '0');
      if (value > kLargestImageSide) refuse_header();
    }
    if (!std::isspace(letter)) refuse_header();  // a single whitespace character ends the header
    return value;
  }

  std::optional<Image> read_picture() {
    const int mark = next_byte();
    if (mark < 0) return std::nullopt;
    const int kind = next_byte();
    if (mark != 'P' || (kind != '5' && kind != '6')) refuse_header();
    ImageSize size;
    size.width = header_number();
    size.height = header_number();
    size.max_value = header_number();
    if (size.width < 1 || size.height < 1 || size.max_value < 1 || size.max_value > 65535) refuse_header();
    const int views = options_.split == Split::none ? 2 : 1;
    if (pictures_ < views) first_.push_back(size);
    const ImageSize& first = first_[static_cast<std::size_t>(pictures_ % views)];
    const int max_value = first_.front().max_value;
    if (size != first || size.max_value != max_value) {
      fail(kName, picture() + " of " + to_string(size) + " pixels, values to " + std::to_string(size.max_value),
           to_string(first) + ", to " + std::to_string(max_value) + ", as the first one of its camera");
    }
    Image image = read_pixels(size, kind == '6' ? 3 : 1);
    ++pictures_;
    return image;
  }

  Image read_pixels(ImageSize size, int channels) {
    const bool deep = size.max_value > kMaxValue8;
    const std::size_t needed = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) *
                               static_cast<std::size_t>(channels) * (deep ? 2 : 1);
    pixels_.clear();  // grows with what arrives, not with what a header claims
    while (pixels_.size() < needed) {
      if (at_ == filled_ && !fill())
        fail(kName,
             picture() + " that ends after " + std::to_string(pixels_.size()) + " of " + std::to_string(needed) +
                 " bytes",
             "a complete one");
      const std::size_t part = std::min(needed - pixels_.size(), filled_ - at_);
      pixels_.insert(pixels_.end(), buffer_.data() + at_, buffer_.data() + at_ + part);
      at_ += part;
    }
    cv::Mat samples(size.height, size.width, CV_MAKETYPE(deep ? CV_16U : CV_8U, channels), pixels_.data());
    from_big_endian(samples);
    return grey_image(samples, size.max_value);
  }

  int descriptor_;
  std::vector<char> buffer_, pixels_;
  std::size_t at_ = 0, filled_ = 0;
  std::vector<ImageSize> first_;  ///< of the first image of each camera, or of both views in one
  int pictures_ = 0;
};

}  // namespace

Split parse_split(const std::string& word) {
  if (word.empty()) return Split::none;
  if (word == "left-right") return Split::left_right;
  if (word == "top-bottom") return Split::top_bottom;
  throw UsageError("--split " + word + ": expected left-right or top-bottom");
}

std::optional<StereoPair> StreamReader::next() {
  const std::size_t stamps = options_.stamps_ns.size();
  while (options_.last < 0 || number_ < options_.last) {
    auto pair = first_ ? std::exchange(first_, std::nullopt) : read();
    const auto number = static_cast<std::size_t>(number_);
    if (stamps > 0 && !stopped_ && (pair ? number >= stamps : number < stamps))
      fail(options_.stamps_from, counted(stamps, "time"),
           pair ? "one for every pair" : std::to_string(number) + ", one for every pair");
    if (!pair) break;
    if (options_.fps > 0) pair->stamp_ns = std::llround(number_ / options_.fps * 1e9);
    if (stamps > 0) pair->stamp_ns = options_.stamps_ns[number];
    pair->number = number_++ - options_.first;
    if (pair->number >= 0) return pair;
  }
  return std::nullopt;
}

StereoPair StreamReader::halves(const Image& both, const std::string& picture) const {
  const bool beside = options_.split == Split::left_right;
  if ((beside ? both.width : both.height) % 2 != 0)
    fail(picture, to_string({both.width, both.height}) + " pixels",
         beside ? "an even width to halve" : "an even height to halve");
  const int width = beside ? both.width / 2 : both.width, height = beside ? both.height : both.height / 2;
  return {0, 0, part_of(both, {0, 0, width, height}),
          part_of(both, {both.width - width, both.height - height, width, height})};
}

StereoPair StreamOfReaders::look(const std::string& stream) {
  begun_ = make_();
  const auto& first = begun_->look();
  if (!first) fail(stream, "no image", "stereo pairs");
  return *first;
}

std::shared_ptr<StreamOfReaders> make_picture_pipe(int descriptor, const StreamOptions& options) {
  const auto make = [descriptor, options, opened = std::make_shared<std::atomic<bool>>(false)] {
    if (opened->exchange(true)) throw UsageError(std::string(kName) + ": can be read once only");
    return std::make_unique<PipeReader>(descriptor, options);
  };
  return std::make_shared<StreamOfReaders>(make, options.queue);
}

}  // namespace quadedge::data
