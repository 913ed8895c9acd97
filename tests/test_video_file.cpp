#include <cerrno>

#include "data/video_file.hpp"
#include "edge_images.hpp"
#include "own_camera.hpp"

using Catch::Matchers::Contains;
using namespace quadedge;
using data::decode_video;
using data::describe_video;
namespace fs = std::filesystem;

namespace {

/// Images that differ from one another in every pixel, at any bit depth.
Image picture(int number, int width = 48, int height = 32, int max_value = 255) {
  return filled_image(width, height, max_value,
                      [=](int x, int y) { return (37 * number + 5 * x + 11 * y + x * y) % (max_value + 1); });
}

std::string stream(int first, int count, int width = 48, int height = 32, int max_value = 255) {
  std::string text;
  for (int i = first; i < first + count; ++i) text += own_camera::pgm(picture(i, width, height, max_value));
  return text;
}

std::string video(const TemporaryFolder& folder, const std::string& pictures, const std::string& options,
                  const std::string& name) {
  write_text(folder / "pictures.pgm", pictures);
  own_camera::encode(folder / "pictures.pgm", options, folder / name);
  return folder / name;
}

/// Reads to the end. \returns the error message, if any
std::string read_all(const std::string& file, int& pictures) {
  pictures = 0;
  return message_of([&] {
    const auto next = decode_video(describe_video(file));
    while (next()) ++pictures;
  });
}

}  // namespace

TEST_CASE("video: lossless grey images are read byte for byte, at their bit depth") {
  const TemporaryFolder folder;
  for (const auto& [max_value, format] : {std::pair<int, const char*>{255, "gray"}, {65535, "gray16le"}}) {
    const std::string file = video(folder, stream(0, 5, 48, 32, max_value), std::string("-c:v ffv1 -pix_fmt ") + format,
                                   std::string(format) + ".mkv");
    const data::Video about = describe_video(file);
    CHECK(about.promised == 5);
    CHECK(about.fps == Approx(20));
    const auto read = decode_video(about);
    for (int i = 0; i < 5; ++i) {
      const auto next = read();
      REQUIRE(next);
      CHECK(next->image.max_value == max_value);
      CHECK(next->image.pixels == picture(i, 48, 32, max_value).pixels);
      CHECK(next->stamp_ns == i * 50'000'000);
    }
    CHECK_FALSE(read());
  }
}

TEST_CASE("video: colour becomes full-range luma, and RGB becomes grey as in image files") {
  const TemporaryFolder folder;
  const std::string pictures = stream(0, 2);
  for (const char* options : {"-c:v ffv1 -pix_fmt yuv420p", "-c:v ffv1 -pix_fmt yuvj420p", "-c:v ffv1 -pix_fmt bgr0",
                              "-c:v ffv1 -pix_fmt yuv422p10le", "-c:v ffv1 -pix_fmt gbrp12le",
                              "-c:v rawvideo -pix_fmt uyvy422", "-c:v rawvideo -pix_fmt nv12"}) {
    INFO(options);
    const auto read = decode_video(describe_video(video(folder, pictures, options, "colour.mkv")));
    const auto next = read();
    REQUIRE(next);
    const Image expected = picture(0);
    double largest = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 48; ++x)
        largest = std::max(largest, std::abs(static_cast<double>(next->image.view().at(x, y)) -
                                             static_cast<double>(expected.view().at(x, y))));
    CHECK(largest <= 1.0);  // 220 values of the limited range represent 256
  }
}

TEST_CASE("video: an image of another size and a damaged one are reported by number") {
  const TemporaryFolder folder;
  const std::string small = read_text(video(folder, stream(0, 1, 32, 32), "-c:v mjpeg", "small.mjpeg"));
  const std::string usual = read_text(video(folder, stream(0, 3), "-c:v mjpeg", "usual.mjpeg"));
  write_text(folder / "odd.mjpeg", usual + small + usual);
  int pictures = 0;
  CHECK_THAT(read_all(folder / "odd.mjpeg", pictures),
             Contains("odd.mjpeg") && Contains("frame 3 of 32 x 32") && Contains("48 x 32"));
  CHECK(pictures == 3);

  const std::string file =
      video(folder, stream(0, 20, 160, 120), "-c:v ffv1 -level 3 -slicecrc 1 -pix_fmt gray -g 1", "damaged.mkv");
  std::string bytes = read_text(file);
  for (std::size_t i = bytes.size() / 2; i < bytes.size() / 2 + 40; ++i) bytes[i] = static_cast<char>(bytes[i] ^ 0x55);
  write_text(file, bytes);
  CHECK_THAT(read_all(file, pictures), Contains(file) && Contains("damaged frame"));
  CHECK((pictures > 5 && pictures < 15));
}

TEST_CASE("video: other files are refused") {
  const TemporaryFolder folder;
  int pictures = 0;
  write_text(folder / "text.mkv", "this is no video");
  CHECK_THAT(read_all(folder / "text.mkv", pictures), Contains("text.mkv") && Contains("no video"));
  CHECK_THAT(read_all(folder / "absent.mkv", pictures), Contains("no such file"));
  CHECK_THAT(read_all(folder.path(), pictures), Contains("a folder"));
  CHECK_THAT(read_all("/dev/zero", pictures), Contains("a device"));
}

TEST_CASE("video: a name may look like an option, a protocol or a pattern") {
  const TemporaryFolder folder;
  const std::string file = video(folder, stream(0, 2), "-c:v ffv1 -pix_fmt gray", "plain.mkv");
  for (const char* name : {"-i it's.mkv", "pipe:0", "%03d [1].mkv"}) {
    fs::copy(file, folder / name);
    int pictures = 0;
    CHECK(read_all(folder / name, pictures).empty());
    CHECK(pictures == 2);
  }
}

TEST_CASE("video: no process stays behind a video that is not read to its end") {
  const TemporaryFolder folder;
  const std::string file = video(folder, stream(0, 40, 640, 480), "-c:v ffv1 -pix_fmt gray", "long.mkv");
  {
    const auto read = decode_video(describe_video(file));
    REQUIRE(read());
    CHECK(waitpid(-1, nullptr, WNOHANG) == 0);  // ffmpeg runs
  }
  CHECK((waitpid(-1, nullptr, WNOHANG) == -1 && errno == ECHILD));
}

TEST_CASE("video: a missing program is named") {
  const TemporaryFolder folder;
  const std::string file = video(folder, stream(0, 2), "-c:v ffv1 -pix_fmt gray", "plain.mkv");
  const std::string before = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  int pictures = 0;
  CHECK_THAT(read_all(file, pictures), Contains("ffprobe") && Contains("not installed"));
  setenv("PATH", before.c_str(), 1);
}
