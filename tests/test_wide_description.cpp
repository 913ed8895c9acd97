#include "describing.hpp"
#include "device/edge_descriptions.hpp"
#include "edge_images.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Waves of many lengths and directions: structure everywhere, including the descriptor's scale.
Image waves(int width, int height) {
  return image_of(width, height, [](double x, double y) {
    return 128 + 40 * std::sin(0.31 * x + 0.11 * y) + 35 * std::sin(0.07 * x - 0.23 * y + 1) +
           30 * std::sin(0.013 * x * y / 5 + 2);
  });
}

StereoEdges stereo_edges(const EdgePositions& positions) {
  StereoEdges edges;
  edges.left_x = positions.x;
  edges.left_y = positions.y;
  edges.left_direction = positions.direction;
  edges.left_index.assign(positions.x.size(), 0);
  return edges;
}

std::vector<std::uint8_t> describe_one(const Image& image, float x, float y, float direction) {
  return reference::wide_descriptions(reference::shrink(image.view()), stereo_edges({{x}, {y}, {direction}}), 1);
}

}  // namespace

TEST_CASE("wide description: a constant image gives zeros") {
  for (std::uint8_t value : describe_one(noisy_image(90, 80, 77, 0), 44.3f, 40.2f, 0.5f)) CHECK(value == 0);
}

TEST_CASE("wide description: a ramp contributes to the bins next to its gradient with the cube of the cosine") {
  // I = 2 x: relative to direction t the gradient has the angle -t.
  const Image image = image_of(120, 120, [](double x, double) { return 2 * x; });
  for (int turn = 0; turn < 8; ++turn) {
    const auto descriptor = describe_one(image, 60, 60, static_cast<float>(turn * kPi / 4));
    for (int k = 0; k < kWideBytes; ++k) {
      const int away = std::abs((k + turn + 4) % 8 - 4);  // distance in bins from the gradient's
      const int middle = descriptor[static_cast<std::size_t>(k / 8 * 8 + (8 - turn) % 8)];
      CAPTURE(turn, k, middle, int{descriptor[static_cast<std::size_t>(k)]});
      if (away == 0) CHECK(middle > 60);
      // A clipped middle bin is relatively too small.
      if (away == 1 && middle < 100)
        CHECK(std::abs(descriptor[static_cast<std::size_t>(k)] - middle * std::pow(0.5, 1.5)) < 2);
      if (away == 1) CHECK(descriptor[static_cast<std::size_t>(k)] > middle * std::pow(0.5, 1.5) - 2);
      if (away > 1) CHECK(descriptor[static_cast<std::size_t>(k)] <= 1);
    }
  }
}

TEST_CASE("wide description: rotating image and edge by 90 degrees gives the same descriptor") {
  const Image image = waves(120, 90);
  // Clockwise on screen: (x, y) goes to (89 - y, x).
  const Image turned = filled_image(90, 120, [&](int x, int y) { return image.view().value(y, 89 - x); });
  const auto before = describe_one(image, 60.4f, 41.7f, 0.35f),
             after = describe_one(turned, 89 - 41.7f, 60.4f, 0.35f + static_cast<float>(kPi / 2));
  CHECK(*std::max_element(before.begin(), before.end()) > 50);
  for (std::size_t k = 0; k < kWideBytes; ++k) CHECK(std::abs(before[k] - after[k]) <= 1);
}

TEST_CASE("wide description: every device and variant equals the reference exactly", "[device][oclgrind]") {
  // Sizes not divisible by any group or block; edges on the border and beyond it; every edge, or every third.
  for (const auto& [width, height, count, step] : {std::tuple{3, 4, 3, 1}, {17, 31, 20, 3}, {64, 47, 37, 1}}) {
    const Image image = waves(width, height);
    const auto edges = stereo_edges(random_edges(width, height, count, 6, 12));
    const auto expected = reference::wide_descriptions(reference::shrink(image.view()), edges, step);
    check_stage("wide_description", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      CAPTURE(width, height, step);
      stages::WideDescription stage(context, width, height, variants);
      opencl::Buffer<cl_uchar> pixels, descriptors;
      opencl::Buffer<cl_float> small;
      pixels.write(context, image.pixels);
      stage.prepare(pixels, small);
      stages::DeviceStereoEdges device_edges;
      device_edges.count = count;
      device_edges.stride = count + 3;
      const auto stride = static_cast<std::size_t>(device_edges.stride);
      std::vector<float> packed(6 * stride, 0.0f);
      std::copy(edges.left_x.begin(), edges.left_x.end(), packed.begin());
      std::copy(edges.left_y.begin(), edges.left_y.end(), packed.begin() + device_edges.stride);
      std::copy(edges.left_direction.begin(), edges.left_direction.end(), packed.begin() + 2 * device_edges.stride);
      device_edges.packed.write(context, packed);
      const int rows = stage.describe(small, device_edges, step, descriptors);
      REQUIRE(static_cast<std::size_t>(rows) * kWideBytes == expected.size());
      const auto found = descriptors.read(expected.size());
      return {{"descriptors", found, expected, {1}}, {"unequal", found, expected, {0, expected.size() / 50}}};
    });
  }
}
