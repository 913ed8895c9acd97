#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "describing.hpp"
#include "edge_images.hpp"
#include "kernel_programs.hpp"
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

}  // namespace

TEST_CASE("sift: a constant image gives zeros", "[sift]") {
  Image image(60, 50);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{77});
  const auto both = reference::sift_descriptors(image.view(), {30.2f}, {25.4f}, {0.5f});
  for (std::uint8_t value : both) CHECK(value == 0);
}

TEST_CASE("sift: a ramp fills only the angle bin of its gradient", "[sift]") {
  // I = 3 x: the gradient points along x. Relative to direction t it has the angle t, in bins of 45 degrees.
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
      // All weight is in 16 bins of equal angle: none reaches the clipping limit, so the norm stays 512.
      CHECK((k % 8 == bin ? descriptor[k] >= 40 : descriptor[k] <= 1));
    }
  }
}

TEST_CASE("sift: rotating image and edge by 90 degrees gives the same descriptors", "[sift]") {
  const Image image = textured_image(70, 60, 3);
  Image turned(60, 70);  // clockwise on screen: (x, y) goes to (59 - y, x)
  for (int y = 0; y < 60; ++y) {
    for (int x = 0; x < 70; ++x) turned.pixels[static_cast<std::size_t>(x * 60 + 59 - y)] = image.view().at(x, y);
  }
  const float x = 34.2f, y = 30.3f, direction = 0.35f;
  const auto before = reference::sift_descriptors(image.view(), {x}, {y}, {direction});
  const float turned_direction = direction + static_cast<float>(kPi / 2);
  const auto after = reference::sift_descriptors(turned.view(), {59 - y}, {x}, {turned_direction});
  for (int k = 0; k < kEdgeSiftBytes; ++k) CHECK(std::abs(before[k] - after[k]) <= 1);
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
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 61}}) {
    const Image image = textured_image(width, height, 5);
    const EdgePositions edges = random_edges(width, height, count, 6, 12);
    const auto expected = reference::sift_descriptors(image.view(), edges.x, edges.y, edges.direction);
    for (const auto& found : describe_everywhere("sift", image, edges)) {
      int worst = 0;
      std::size_t equal = 0;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const std::size_t edge = k / kEdgeSiftBytes;
        if (on_the_fence(edges.x[edge], edges.y[edge], edges.direction[edge])) continue;
        worst = std::max(worst, std::abs(found.sift[k] - expected[k]));
        equal += found.sift[k] == expected[k] ? 1 : 0;
      }
      CAPTURE(found.name, width, height);
      CHECK(worst <= 1);
      CHECK(equal > expected.size() * 99 / 100);
    }
  }
}

TEST_CASE("sift: all variants of a device give the same bytes", "[sift][device]") {
  const auto all = describe_everywhere("sift", textured_image(131, 77, 7), random_edges(131, 77, 1003, 8));
  const auto device_of = [](const TestDescriptions& found) { return found.name.substr(0, found.name.rfind(' ')); };
  for (std::size_t k = 1; k < all.size(); ++k) {
    CAPTURE(all[k - 1].name, all[k].name);
    if (device_of(all[k]) == device_of(all[k - 1])) CHECK(all[k].sift == all[k - 1].sift);
  }
}

TEST_CASE("sift: the kernels' distance equals the reference's", "[sift][device][oclgrind]") {
  std::vector<std::uint8_t> bytes(40 * kEdgeSiftBytes);
  std::mt19937_64 random(9);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random() >> 56);
  std::fill_n(bytes.begin(), kEdgeSiftBytes, std::uint8_t{0});  // the largest possible distance
  std::fill_n(bytes.begin() + kEdgeSiftBytes, kEdgeSiftBytes, std::uint8_t{255});
  std::copy_n(bytes.begin() + 2 * kEdgeSiftBytes, kSiftBytes, bytes.begin() + 3 * kEdgeSiftBytes + kSiftBytes);
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    auto& context = *device.context();
    const auto program =
        build_program(context, {"described_edges.cl", "similarity.cl"},
                      "kernel void distance2(global const uchar* sift, global int* distances) {\n"
                      "  const int a = (int)get_global_id(0), b = (int)get_global_id(1);\n"
                      "  distances[b * (int)get_global_size(0) + a] = sift_distance2(sift + a * 256, sift + b * 256);\n"
                      "}\n");
    const opencl::Kernel<void(const cl_uchar*, cl_int*)> distance2(context, program, "distance2");
    opencl::Buffer<cl_uchar> input;
    opencl::Buffer<cl_int> distances(context, 1600);
    input.write(context, bytes);
    distance2({40, 40, 1, 1}, input, distances);
    const auto found = distances.read(1600);
    CHECK(found[1] == 128 * 255 * 255);
    CHECK(found[2 * 40 + 3] == 0);
    for (std::size_t k = 0; k < 1600; ++k) {
      const std::uint8_t *a = bytes.data() + k % 40 * kEdgeSiftBytes, *b = bytes.data() + k / 40 * kEdgeSiftBytes;
      CHECK(found[k] == reference::sift_distance2(a, b));
    }
  }
}
