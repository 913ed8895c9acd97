#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "data/image_file.hpp"
#include "dataset_files.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using dataset_files::pattern;

namespace {

std::string encoded(const std::string& extension, const cv::Mat& picture, const std::vector<int>& options = {}) {
  std::vector<unsigned char> bytes;
  REQUIRE(cv::imencode(extension, picture, bytes, options));
  return {bytes.begin(), bytes.end()};
}

/// The grey image from OpenCV's decoder, an independent reader of the same formats.
cv::Mat decoded_by_opencv(const std::string& bytes) {
  const std::vector<unsigned char> copy(bytes.begin(), bytes.end());
  cv::Mat result = cv::imdecode(copy, cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION);
  if (result.channels() == 3) cv::cvtColor(result, result, cv::COLOR_BGR2GRAY);
  return result;
}

void check_same(const std::string& bytes) {
  const cv::Mat expected = decoded_by_opencv(bytes);
  const Image image = decode_grey_image(bytes, "image");
  REQUIRE(image.width == expected.cols);
  REQUIRE(image.height == expected.rows);
  REQUIRE(image.pixels.size() == expected.total() * expected.elemSize());
  CHECK(image.max_value == (expected.depth() == CV_16U ? 65535 : 255));
  CHECK(std::memcmp(image.pixels.data(), expected.data, image.pixels.size()) == 0);
}

/// A smooth image, which JPEG preserves.
cv::Mat smooth(int type) {
  cv::Mat picture = pattern(161, 119, type);
  cv::GaussianBlur(picture, picture, {9, 9}, 2);
  return picture;
}

}  // namespace

TEST_CASE("image codecs: pixels equal those of OpenCV's decoder, in every format and depth") {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    for (const char* extension : {".png", ".pgm", ".ppm"}) {
      const bool colour = type == CV_8UC3 || type == CV_16UC3;
      if (colour == (std::string(extension) == ".pgm")) continue;
      INFO(extension << " of type " << type);
      check_same(encoded(extension, pattern(33, 21, type)));
    }
  }
  check_same(encoded(".png", pattern(33, 21, CV_8UC4)));   // alpha is dropped
  check_same(encoded(".png", pattern(33, 21, CV_16UC4)));  // with 16 bits too
  const cv::Mat two_levels = pattern(33, 21) > 127;
  check_same(encoded(".png", two_levels, {cv::IMWRITE_PNG_BILEVEL, 1}));  // one bit per pixel
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const int progressive : {0, 1}) {
      INFO("JPEG of type " << type << ", progressive " << progressive);
      check_same(encoded(".jpg", smooth(type), {cv::IMWRITE_JPEG_PROGRESSIVE, progressive}));
    }
  }
}

TEST_CASE("image codecs: written files hold the given images, byte for byte like OpenCV's") {
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1, CV_16UC3}) {
    INFO(type);
    CHECK(data::encode_png(pattern(33, 21, type)) == encoded(".png", pattern(33, 21, type)));
  }
  for (const int type : {CV_8UC1, CV_8UC3})
    CHECK(data::encode_jpeg(smooth(type), 75) == encoded(".jpg", smooth(type), {cv::IMWRITE_JPEG_QUALITY, 75}));
  CHECK_THROWS_WITH(data::encode_png(cv::Mat()), Contains("IHDR"));
}

TEST_CASE("image codecs: a damaged image is refused with the library's reason") {
  std::string png = encoded(".png", pattern(320, 240));
  png[png.size() / 2] = static_cast<char>(png[png.size() / 2] ^ 0x55);
  CHECK_THROWS_AS(decode_grey_image(png, "bent.png"), DataError);
  CHECK_THROWS_WITH(decode_grey_image(png, "bent.png"),
                    Contains("bent.png") && Contains("a damaged PNG (") && Contains("an intact 320 x 240 image"));
}
