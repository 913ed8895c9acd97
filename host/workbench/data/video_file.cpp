/// \file video_file.cpp  Runs ffmpeg and reads raw frames from one pipe, and from another what it says of each.
#include "data/video_file.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

constexpr std::size_t kBlock = 1 << 16;  // bytes read at once: a pipe holds as many

/// Starts the program with its output and error on two pipes. \returns what posix_spawnp returns
int spawn(const std::vector<std::string>& command, int output, int messages, pid_t& process) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, messages, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, pipe;
  sigemptyset(&none);
  sigemptyset(&pipe);
  sigaddset(&pipe, SIGPIPE);  // Python ignores it
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &pipe);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  const int problem = posix_spawnp(&process, words[0], &files, &attributes, words.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return problem;
}

/// A running program with an empty standard input. It is killed with this object; where this process dies without
/// destructors, it ends at its next output. A terminal's Ctrl-C does not reach it.
class ProgramOutput {
 public:
  /// Starts a program that is found as a shell finds it. \throws DataError if it is not installed
  explicit ProgramOutput(const std::vector<std::string>& command) {
    int ends[2][2] = {{-1, -1}, {-1, -1}};
    int problem = pipe2(ends[0], O_CLOEXEC) != 0 || pipe2(ends[1], O_CLOEXEC) != 0 ? errno : 0;
    if (problem == 0) problem = spawn(command, ends[0][1], ends[1][1], process_);
    for (int i = 0; i < 2; ++i) {
      pipes_[i] = ends[i][0];
      if (ends[i][1] >= 0) close(ends[i][1]);
    }
    if (problem == 0) return;
    close_pipes();
    throw DataError("reading a video needs the program " + command.front() + ", which cannot be started: " +
                    (problem == ENOENT ? "it is not installed" : std::strerror(problem)));
  }
  ~ProgramOutput() {
    kill(process_, SIGKILL);
    close_pipes();
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  ProgramOutput(const ProgramOutput&) = delete;
  ProgramOutput& operator=(const ProgramOutput&) = delete;

  /// Waits until something was appended to `output` or `messages`, or one of them ended. \returns false if both have
  bool wait() {
    pollfd waiting[2] = {{pipes_[0], POLLIN, 0}, {pipes_[1], POLLIN, 0}};
    if (poll(waiting, 2, -1) < 0) return errno == EINTR;
    for (int i = 0; i < 2; ++i) {
      if (pipes_[i] < 0 || waiting[i].revents == 0) continue;
      std::string& text = i == 0 ? output : messages;
      const std::size_t before = text.size();
      text.resize(before + kBlock);
      const ssize_t count = read(pipes_[i], text.data() + before, kBlock);
      text.resize(before + static_cast<std::size_t>(count > 0 ? count : 0));
      if (count > 0 || (count < 0 && errno == EINTR)) continue;
      close(pipes_[i]);
      pipes_[i] = -1;
    }
    return pipes_[0] >= 0 || pipes_[1] >= 0;
  }

  std::string output, messages;  ///< from standard output and standard error; taken out by whoever uses it

 private:
  void close_pipes() const {
    for (const int pipe : pipes_)
      if (pipe >= 0) close(pipe);
  }

  pid_t process_ = -1;
  int pipes_[2] = {-1, -1};  ///< of output and messages; -1 once ended
};

constexpr int kReadAhead = 8;             // packets that ffmpeg's demuxer may be ahead of its decoder
constexpr double kStampsPerSecond = 1e9;  // nanoseconds

/// The first error in what a program of FFmpeg says with `-loglevel level`; empty if there is none.
std::string first_error(const std::string& messages) {
  for (const char* level : {"[error] ", "[fatal] ", "[panic] "}) {
    const std::size_t at = messages.find(level);
    if (at != std::string::npos) return messages.substr(at + 8, messages.find('\n', at) - at - 8);
  }
  return {};
}

/// "20/1" as a number; 0 if unknown.
double rate_of(const nlohmann::json& stream, const char* key) {
  int frames = 0, seconds = 0;
  std::sscanf(stream.value(key, "").c_str(), "%d/%d", &frames, &seconds);
  return frames > 0 && seconds > 0 ? static_cast<double>(frames) / seconds : 0;
}

/// How ffmpeg makes grey from frames of a pixel format: luma and grey as they are, everything else by way of RGB.
void choose_grey(const nlohmann::json& format, const std::string& range, Video& video) {
  const nlohmann::json& flags = format["flags"];
  const std::string name = format["name"];
  const int bits = format["components"][0]["bit_depth"];
  const auto is = [&](const char* flag) { return flags.value(flag, 0) != 0; };
  if (is("rgb") || is("palette") || is("bitstream") || bits > 16 || name.rfind("bayer", 0) == 0) {
    video.grey = std::string("scale=flags=neighbor+accurate_rnd,format=") + (bits > 8 ? "rgb48be" : "rgb24");
  } else {
    video.grey = "extractplanes=y";
    video.broadcast = format["nb_components"] >= 3 && name.rfind("yuvj", 0) != 0 && range != "pc";
  }
}

/// What ffmpeg's filter `showinfo` says of a frame.
struct FrameFacts {
  bool has_time = false;
  std::int64_t time = 0;  ///< in units of the video
  int width = 0, height = 0;
  std::string format;  ///< gray, gray10le, rgb24 ...
};

std::string value_after(const std::string& line, const char* key) {
  const std::size_t at = line.find(key);
  if (at == std::string::npos) return {};
  const std::size_t first = std::min(line.find_first_not_of(' ', at + std::string_view(key).size()), line.size());
  return line.substr(first, line.find(' ', first) - first);
}

std::vector<std::string> command_for(const Video& video) {
  auto words = split(
      "ffmpeg -hide_banner -nostdin -nostats -loglevel repeat+level+info -threads 1 -err_detect crccheck+explode "
      "-noautorotate -copyts -i");
  words.push_back("file:" + video.file);
  for (const auto& word : split("-map 0:V:0 -fps_mode passthrough -autoscale 0 -f rawvideo -vf")) words.push_back(word);
  words.push_back(video.grey + ",showinfo=checksum=0");
  words.emplace_back("pipe:1");
  return words;
}

/// A running ffmpeg and its frames so far.
class Decoder {
 public:
  explicit Decoder(const Video& video) : video_(video), ffmpeg_(command_for(video)) {}

  std::optional<VideoPicture> next() {
    const auto facts = next_facts();
    if (!facts) return std::nullopt;
    if (decoded_ == 0) first_ = *facts;
    if (facts->width != first_.width || facts->height != first_.height) {
      refuse(picture() + " of " + to_string({facts->width, facts->height}) + " pixels",
             to_string({first_.width, first_.height}) + " as the first one");
    }
    VideoPicture result{stamp(*facts), image(*facts)};
    ++decoded_;
    return result;
  }

 private:
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    fail(video_.file, found, expected);
  }
  [[noreturn]] void refuse_damaged(const std::string& error) const {
    refuse("a damaged " + picture() + " (" + error + ")", "an intact video");
  }
  std::string picture() const { return "frame " + std::to_string(decoded_); }

  /// The next line that ffmpeg prints; nothing at its end.
  std::optional<std::string> next_line() {
    std::size_t end = 0;
    while ((end = ffmpeg_.messages.find('\n')) == std::string::npos)
      if (!ffmpeg_.wait()) return std::nullopt;
    std::string line = ffmpeg_.messages.substr(0, end);
    ffmpeg_.messages.erase(0, end + 1);
    return line;
  }

  bool is_of_demuxer(const std::string& line) const {
    return (!video_.demuxer.empty() && line.rfind("[" + video_.demuxer + " @", 0) == 0) || line.rfind("[in#", 0) == 0 ||
           line.rfind("[error] Truncating packet", 0) == 0;
  }

  /// What ffmpeg prints of the next frame. Errors of the decoder are damage, as nothing else shows it. Those of the
  /// demuxer are damage where more frames follow than may be underway; else the video only ends there.
  std::optional<FrameFacts> next_facts() {
    std::string damage;
    while (const auto line = next_line()) {
      if (const std::string error = first_error(*line); !error.empty()) {
        if (!is_of_demuxer(*line)) {
          if (damage.empty()) damage = error;
        } else if (demuxer_error_.empty()) {
          demuxer_error_ = error;
          last_frame_ = decoded_ + video_.delay + kReadAhead;
        }
      }
      if (line->find("] Stream mapping:") != std::string::npos) damage.clear();  // the search for streams has ended
      if (line->rfind("[Parsed_showinfo", 0) != 0) continue;
      std::sscanf(value_after(*line, "config in time_base:").c_str(), "%d/%d", &unit_[0], &unit_[1]);
      FrameFacts facts;
      facts.format = value_after(*line, " fmt:");
      if (facts.format.empty()) continue;
      std::sscanf(value_after(*line, " s:").c_str(), "%dx%d", &facts.width, &facts.height);
      const std::string time = value_after(*line, " pts:");
      char* end = nullptr;
      facts.time = std::strtoll(time.c_str(), &end, 10);
      facts.has_time = end != time.c_str();
      if (!demuxer_error_.empty() && decoded_ > last_frame_) damage = demuxer_error_;
      if (!damage.empty()) refuse_damaged(damage);
      return facts;
    }
    if (!damage.empty()) refuse_damaged(damage);
    // The duration may refer to the start or the end of the last frame.
    if (decoded_ + 1 < video_.promised)
      refuse("the end after " + counted(decoded_, "frame"),
             "the " + std::to_string(video_.promised) + " announced by its header");
    return std::nullopt;
  }

  /// A video may round its timestamps; frames without timestamps follow the frame rate.
  std::int64_t stamp(const FrameFacts& facts) const {
    if (!video_.has_times || !facts.has_time || !first_.has_time)
      return video_.fps > 0 ? std::llround(decoded_ / video_.fps * kStampsPerSecond) : decoded_;
    return std::llround(static_cast<double>(facts.time - first_.time) * unit_[0] / unit_[1] * kStampsPerSecond);
  }

  Image image(const FrameFacts& facts) {
    const bool colour = facts.format.rfind("rgb", 0) == 0;
    int bits = 8;
    std::sscanf(facts.format.c_str(), "gray%d", &bits);
    if (facts.format == "rgb48be") bits = 16;
    cv::Mat samples(facts.height, facts.width, CV_MAKETYPE(bits > 8 ? CV_16U : CV_8U, colour ? 3 : 1));
    const std::size_t size = samples.total() * samples.elemSize();
    while (ffmpeg_.output.size() < size)
      if (!ffmpeg_.wait()) refuse_damaged("ffmpeg ended early");
    std::copy_n(ffmpeg_.output.data(), size, samples.data);
    ffmpeg_.output.erase(0, size);
    if (facts.format.substr(facts.format.size() - 2) == "be") from_big_endian(samples);
    Image image = grey_image(samples, (1 << bits) - 1);
    if (video_.broadcast) stretch(image, bits);
    return image;
  }

  /// From 16 to 235 for 8 bits, and the same shifted for more bits, to the full range.
  static void stretch(Image& image, int bits) {
    const double black = std::ldexp(16, bits - 8), scale = image.max_value / std::ldexp(219, bits - 8);
    std::vector<int> full(static_cast<std::size_t>(image.max_value) + 1);
    for (int i = 0; i <= image.max_value; ++i)
      full[static_cast<std::size_t>(i)] =
          std::clamp(static_cast<int>(std::lround((i - black) * scale)), 0, image.max_value);
    const ImageView view = image.view();
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) image.set(x, y, full[static_cast<std::size_t>(view.value(x, y))]);
  }

  const Video video_;
  ProgramOutput ffmpeg_;
  FrameFacts first_;
  int unit_[2] = {0, 1};       ///< of times: numerator and denominator of the seconds
  int decoded_ = 0;            ///< number of frames so far
  std::string demuxer_error_;  ///< the first one
  int last_frame_ = 0;         ///< that may follow the demuxer's error in a video that only ends early
};

class VideoReader : public StreamReader {
 public:
  VideoReader(const Video& left, const std::optional<Video>& right, const StreamOptions& options)
      : StreamReader(options), about_left_(left), next_left_(decode_video(left)) {
    if (!right) return;
    about_right_ = *right;
    next_right_ = decode_video(*right);
  }

 private:
  std::optional<StereoPair> read() override {
    auto left = next_left_();
    StereoPair pair;
    if (next_right_) {
      auto right = next_right_();
      if (left && !right) end_early(about_right_, about_left_);
      if (right && !left) end_early(about_left_, about_right_);
      if (!left) return std::nullopt;
      check_times(left->stamp_ns, right->stamp_ns);
      pair.left = std::move(left->image);
      pair.right = std::move(right->image);
    } else {
      if (!left) return std::nullopt;
      pair = halves(left->image, about_left_.file);
    }
    pair.stamp_ns = left->stamp_ns;
    return pair;
  }
  [[noreturn]] void end_early(const Video& shorter, const Video& other) const {
    fail(shorter.file, "the end after " + counted(number_, "frame"), "as many as in " + other.file);
  }
  /// Checks that the frames of a pair differ by less than half a period in time.
  void check_times(std::int64_t left, std::int64_t right) const {
    const double fps = about_left_.fps, apart = static_cast<double>(right - left) / kStampsPerSecond;
    if (options_.fps > 0 || !(fps > 0) || std::abs(apart) * fps < 0.5) return;
    fail(about_right_.file, "frame " + std::to_string(number_) + " at " + format_seconds(right) + " s",
         format_seconds(left) + " s as in " + about_left_.file);
  }

  const Video about_left_;
  Video about_right_;
  std::function<std::optional<VideoPicture>()> next_left_, next_right_;
};

}  // namespace

Video describe_video(const std::string& file) {
  constexpr const char* kVideo = "a video file";
  if (const std::string kind = irregular_kind(file); !kind.empty()) fail(file, kind, kVideo);
  if (std::FILE* exists = std::fopen(file.c_str(), "rb")) {
    std::fclose(exists);
  } else {
    fail(file, "no such file", kVideo);
  }
  ProgramOutput probe({"ffprobe", "-loglevel", "repeat+level+warning", "-select_streams", "V:0", "-show_streams",
                       "-show_format", "-show_pixel_formats", "-of", "json", "file:" + file});
  while (probe.wait()) {
  }
  const nlohmann::json about = nlohmann::json::parse(probe.output, nullptr, false);
  if (!about.is_object() || !about.contains("format")) {
    const std::string error = first_error(probe.messages), name = "file:" + file + ": ";
    fail(file, "no video (" + (error.rfind(name, 0) == 0 ? error.substr(name.size()) : error) + ")", kVideo);
  }
  if (about["streams"].empty()) fail(file, "no video in it", kVideo);
  const nlohmann::json &stream = about["streams"][0], &container = about["format"];
  Video video;
  video.file = file;
  video.demuxer = container.value("format_name", "");
  if (video.demuxer == stream.value("codec_name", "")) video.demuxer.clear();
  video.has_times = stream.contains("start_pts");
  video.delay = stream.value("has_b_frames", 0);
  video.fps = rate_of(stream, "avg_frame_rate");
  if (!(video.fps > 0)) video.fps = rate_of(stream, "r_frame_rate");
  video.promised = std::atoi(stream.value("nb_frames", "").c_str());
  const bool is_guess = probe.messages.find("Estimating duration from bitrate") != std::string::npos;
  const std::string duration = container.value("duration", "");
  double seconds = 0;
  std::from_chars(duration.data(), duration.data() + duration.size(), seconds);
  if (video.promised == 0 && !is_guess) video.promised = static_cast<int>(std::lround(seconds * video.fps));
  const std::string format = stream.value("pix_fmt", "");
  for (const nlohmann::json& known : about["pixel_formats"])
    if (known["name"] == format) choose_grey(known, stream.value("color_range", ""), video);
  if (video.grey.empty()) fail(file, "a video that cannot be decoded (" + first_error(probe.messages) + ")", kVideo);
  return video;
}

std::function<std::optional<VideoPicture>()> decode_video(const Video& video) {
  return [decoder = std::make_shared<Decoder>(video)] { return decoder->next(); };
}

std::shared_ptr<StreamOfReaders> make_video_stream(const Video& left, const std::optional<Video>& right,
                                                   const StreamOptions& options) {
  return std::make_shared<StreamOfReaders>([=] { return std::make_unique<VideoReader>(left, right, options); },
                                           options.queue);
}

}  // namespace quadedge::data
