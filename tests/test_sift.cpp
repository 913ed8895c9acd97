#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "describing.hpp"
#include "edge_images.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;

namespace {

/// Whether a key point of the edge lies so close to the middle between two pixels that rounding may choose either.
bool on_the_fence(float x, float y, float direction) {
  const auto near_half = [](double v) { return std::abs(v - std::floor(v) - 0.5) < 1e-4; };
  const double dx = 8 * std::sin(direction), dy = -8 * std::cos(direction);
  return near_half(x + dx) || near_half(y + dy) || near_half(x - dx) || near_half(y - dy);
}

/// Bytes may differ by 1, one of a hundred.
void check_sift(int width, int height, int count) {
  Image image = textured_image(width, height, 5);
  for (int y = 0; y < height / 3; ++y)  // a constant part, whose descriptors are zero
    for (int x = 0; x < width; ++x) image.set(x, y, 77);
  const EdgePositions edges = random_edges(width, height, count, 6, 12);
  const auto expected = reference::sift_descriptors(image.view(), edges.x, edges.y, edges.direction);
  check_stage("sift", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    const InputOfDescriptions input(context, image, edges);
    stages::Sift stage(context, width, height, variants);
    opencl::Buffer<cl_uchar> descriptors;
    stage.prepare(input.pixels);
    stage.describe(input.edges.list(), descriptors);
    const auto found = descriptors.read(expected.size());
    std::vector<int> apart(found.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      const std::size_t edge = k / kEdgeSiftBytes;
      if (!on_the_fence(edges.x[edge], edges.y[edge], edges.direction[edge])) apart[k] = found[k] - expected[k];
    }
    const std::vector<int> none(found.size());
    return {{"descriptors", found}, {"apart", apart, none, {1}}, {"unequal", apart, none, {0, found.size() / 100}}};
  });
}

/// Smoothed noise: structure at the scale of a recorded image.
Image smoothed_noise(int width, int height, unsigned seed) {
  cv::Mat noise(height, width, CV_8U);
  std::mt19937_64 random(seed);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) noise.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random() >> 56);
  }
  cv::GaussianBlur(noise, noise, {}, 1.5);
  cv::normalize(noise, noise, 0, 255, cv::NORM_MINMAX);
  Image image(width, height);
  std::copy(noise.begin<std::uint8_t>(), noise.end<std::uint8_t>(), image.pixels.begin());
  return image;
}

}  // namespace

TEST_CASE("sift: every device and variant equals the reference exactly", "[device][oclgrind]") {
  // Sizes not divisible by any group or vector; key points on the border and beyond it; a count that fills no group.
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 61}})
    check_sift(width, height, count);
}

TEST_CASE("sift: of many edges", "[device]") { check_sift(131, 77, 1003); }

TEST_CASE("sift: descriptors equal OpenCV's at the same key points") {
  const int width = 200, height = 140, count = 2000;
  const Image image = smoothed_noise(width, height, 1);
  const EdgePositions points = random_edges(width, height, count, 2);
  const auto map = reference::sift_gradients(image.view());
  std::vector<cv::KeyPoint> key_points;
  for (int k = 0; k < count; ++k) {
    const double degrees = points.direction[k] * 180 / kPi;
    const auto angle = static_cast<float>(degrees < 0 ? degrees + 360 : degrees);
    key_points.emplace_back(points.x[k], points.y[k], 1.0f, angle, 0.0f, 0);
  }
  cv::Mat expected;
  const cv::Mat pixels(height, width, CV_8U, const_cast<std::uint8_t*>(image.pixels.data()));
  cv::SIFT::create()->compute(pixels, key_points, expected);
  REQUIRE(expected.rows == count);
  REQUIRE(expected.cols == kSiftBytes);

  // OpenCV's arc tangent is accurate to 0.3 degrees. This moves up to 0.3 / 45 of a sample between neighbouring bins,
  // at most sqrt(2) * 0.3 / 45 * 512 = 4.8 of the descriptor's norm; rounding to bytes on both sides adds at most 1 per
  // byte and 128 * (1 / 6) to the mean square, 4.6 of the norm.
  double sum = 0, largest = 0;
  for (int k = 0; k < count; ++k) {
    std::uint8_t descriptor[kSiftBytes];
    reference::sift_descriptor(map, points.x[k], points.y[k], points.direction[k], descriptor);
    double squares = 0;
    for (int b = 0; b < kSiftBytes; ++b) squares += std::pow(descriptor[b] - expected.at<float>(k, b), 2);
    sum += std::sqrt(squares);
    largest = std::max(largest, std::sqrt(squares));
  }
  CAPTURE(sum / count, largest);
  CHECK(sum / count < 2.0);
  CHECK(largest < 9.4);
}
