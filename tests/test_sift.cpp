#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>

#include "reference/sift.hpp"

using namespace quadedge;
using reference::kEdgeSiftBytes;
using reference::kSiftBytes;

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Smoothed noise: structure at the scale that a recorded image has.
Image textured_image(int width, int height, unsigned seed) {
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

struct Points {
  std::vector<float> x, y, direction;
};

/// Random places in the image, also at its very border, with all directions.
Points random_points(int width, int height, int count, unsigned seed) {
  Points points;
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) / 9007199254740992.0; };
  for (int k = 0; k < count; ++k) {
    points.x.push_back(static_cast<float>(uniform() * (width - 1)));
    points.y.push_back(static_cast<float>(uniform() * (height - 1)));
    points.direction.push_back(static_cast<float>((2 * uniform() - 1) * kPi));
  }
  return points;
}

}  // namespace

TEST_CASE("sift: descriptors equal OpenCV's at the same key points", "[sift]") {
  const int width = 200, height = 140, count = 2000;
  const Image image = textured_image(width, height, 1);
  const Points points = random_points(width, height, count, 2);
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

  // OpenCV's arc tangent is good to 0.3 degrees. That moves up to 0.3 / 45 of a sample between neighbouring bins, at most
  // sqrt(2) * 0.3 / 45 * 512 = 4.8 of the descriptor's norm; rounding to bytes on both sides adds at most 1 per byte and
  // 128 * (1 / 6) in the mean of the square, 4.6 of the norm.
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

TEST_CASE("sift: a constant image gives zeros", "[sift]") {
  Image image(60, 50);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{77});
  for (std::uint8_t value : reference::sift_descriptors(image.view(), {30.2f}, {25.4f}, {0.5f}, SiftConfig{})) CHECK(value == 0);
}

TEST_CASE("sift: a ramp fills the angle bin of its gradient only", "[sift]") {
  // I = 3 x: the gradient points along x. Seen from direction t it lies at angle t, counted in bins of 45 degrees.
  Image image(80, 60);
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 80; ++x) image.pixels[static_cast<std::size_t>(y * 80 + x)] = static_cast<std::uint8_t>(3 * x);
  }
  const auto map = reference::sift_gradients(image.view());
  for (int bin = 0; bin < 8; ++bin) {
    std::uint8_t descriptor[kSiftBytes];
    reference::sift_descriptor(map, 40, 30, static_cast<float>(bin * kPi / 4), descriptor);
    for (int k = 0; k < kSiftBytes; ++k) {
      CAPTURE(bin, k, int{descriptor[k]});
      // All weight is in 16 equal-angle bins: none can reach the clip, so the norm stays 512.
      CHECK((k % 8 == bin ? descriptor[k] >= 40 : descriptor[k] <= 1));
    }
  }
}

TEST_CASE("sift: turning image and edge by 90 degrees gives the same descriptors", "[sift]") {
  const Image image = textured_image(70, 60, 3);
  Image turned(60, 70);  // clockwise on screen: (x, y) goes to (59 - y, x)
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 70; ++x) turned.pixels[static_cast<std::size_t>(x * 60 + 59 - y)] = image.view().at(x, y);
  }
  const float x = 34.2f, y = 30.3f, direction = 0.35f;
  const auto before = reference::sift_descriptors(image.view(), {x}, {y}, {direction}, SiftConfig{});
  const float turned_direction = direction + static_cast<float>(kPi / 2);
  const auto after = reference::sift_descriptors(turned.view(), {59 - y}, {x}, {turned_direction}, SiftConfig{});
  for (int k = 0; k < kEdgeSiftBytes; ++k) CHECK(std::abs(before[k] - after[k]) <= 1);
}

TEST_CASE("sift: the bright side's descriptor comes first, 8 px along (sin, -cos)", "[sift]") {
  const Image image = textured_image(70, 60, 4);
  const auto map = reference::sift_gradients(image.view());
  const float direction = static_cast<float>(-kPi / 2);  // bright side at (-1, 0)
  const auto both = reference::sift_descriptors(image.view(), {35.0f}, {30.0f}, {direction}, SiftConfig{});
  std::uint8_t bright[kSiftBytes], dark[kSiftBytes];
  reference::sift_descriptor(map, 27, 30, direction, bright);
  reference::sift_descriptor(map, 43, 30, direction, dark);
  CHECK(std::equal(bright, bright + kSiftBytes, both.begin()));
  CHECK(std::equal(dark, dark + kSiftBytes, both.begin() + kSiftBytes));
}

TEST_CASE("sift: the distance of two edges is the smallest of the four pairings", "[sift]") {
  const auto edge = [](int bright, int dark) {
    std::vector<std::uint8_t> bytes(kEdgeSiftBytes, 0);
    bytes[static_cast<std::size_t>(bright)] = 255;
    bytes[static_cast<std::size_t>(kSiftBytes + dark)] = 200;
    return bytes;
  };
  const auto distance2 = [](const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    return reference::sift_distance2(a.data(), b.data());
  };
  CHECK(distance2(edge(3, 4), edge(3, 90)) == 0);
  CHECK(distance2(edge(3, 127), edge(4, 127)) == 0);
  CHECK(distance2(edge(3, 5), edge(6, 3)) == 55 * 55);
  CHECK(distance2(edge(6, 3), edge(3, 5)) == 55 * 55);
  CHECK(distance2(edge(3, 5), edge(6, 7)) == 2 * 200 * 200);
}
