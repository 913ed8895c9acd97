#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "describing.hpp"
#include "edge_images.hpp"
#include "quadedge/camera.hpp"
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
  const Image image = textured_image(width, height, 5);
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

}  // namespace

TEST_CASE("sift: a constant image gives zeros", "[sift]") {
  Image image(60, 50);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{77});
  const auto both = reference::sift_descriptors(image.view(), {30.2f}, {25.4f}, {0.5f});
  for (std::uint8_t value : both) CHECK(value == 0);
}

TEST_CASE("sift: the dark side's descriptor comes first, 8 px along (sin, -cos)", "[sift]") {
  const Image image = textured_image(70, 60, 4);
  const auto map = reference::sift_gradients(image.view());
  const float direction = static_cast<float>(-kPi / 2);  // dark side at (-1, 0)
  const auto both = reference::sift_descriptors(image.view(), {35.0f}, {30.0f}, {direction});
  std::uint8_t dark[kSiftBytes], bright[kSiftBytes];
  reference::sift_descriptor(map, 27, 30, direction, dark);
  reference::sift_descriptor(map, 43, 30, direction, bright);
  CHECK(std::equal(dark, dark + kSiftBytes, both.begin()));
  CHECK(std::equal(bright, bright + kSiftBytes, both.begin() + kSiftBytes));
}

TEST_CASE("sift: the distance of two edges is the smallest of the four pairings", "[sift]") {
  const auto edge = [](int dark, int bright) {
    std::vector<std::uint8_t> bytes(kEdgeSiftBytes, 0);
    bytes[static_cast<std::size_t>(dark)] = 255;
    bytes[static_cast<std::size_t>(kSiftBytes + bright)] = 200;
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

TEST_CASE("sift: every device and variant equals the reference exactly", "[sift][device][oclgrind]") {
  // Sizes not divisible by any group or vector; key points on the border and beyond it; a count that fills no group.
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 61}})
    check_sift(width, height, count);
}

TEST_CASE("sift: of many edges", "[sift][device]") { check_sift(131, 77, 1003); }
