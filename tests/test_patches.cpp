#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "describing.hpp"
#include "kernel_programs.hpp"
#include "quadedge/camera.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;

namespace {

constexpr auto kHalfTurn = static_cast<float>(kPi);

Image noise_image(int width, int height, unsigned seed) {
  Image image(width, height);
  std::mt19937_64 random(seed);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(random() >> 56);
  return image;
}

std::vector<std::int8_t> cut(const Image& image, float x, float y, float direction) {
  return reference::side_patches(image.view(), {x}, {y}, {direction}, PatchesConfig{});
}

/// Sample `k` = 7 i + j of the dark (0) or bright (1) patch, five rows i of seven samples j.
std::size_t position(int side, int k) { return static_cast<std::size_t>(16 * (k / 7) + 8 * side + k % 7); }

/// The samples of one side.
std::vector<int> side_of(const std::vector<std::int8_t>& patches, int side) {
  std::vector<int> samples;
  for (int k = 0; k < kPatchSamples; ++k) samples.push_back(patches[position(side, k)]);
  return samples;
}

/// 1 / norm, stored behind the samples.
float stored_inverse(const std::vector<std::int8_t>& patches, int side) {
  float inverse;
  std::memcpy(&inverse, patches.data() + 80 + 4 * side, sizeof(float));
  return inverse;
}

std::ptrdiff_t brightest(const std::vector<int>& patch) {
  return std::max_element(patch.begin(), patch.end()) - patch.begin();
}

/// Equal except for one sample per edge that may round in the other direction.
void check_same_patches(const std::vector<std::int8_t>& a, const std::vector<std::int8_t>& b) {
  REQUIRE(a.size() == b.size());
  const auto apart = rounded_apart(a, b);
  CHECK(apart.largest <= 1);
  CHECK(apart.differing <= apart.samples / 70);
}

/// The largest difference between a sample and its exact value, computed in double precision and scaled to a maximum
/// of 127.
double farthest_from_exact(const Image& image, const EdgePositions& edges, const std::vector<std::int8_t>& patches) {
  double farthest = 0;
  for (std::size_t e = 0; e < edges.x.size(); ++e) {
    const double cosine = std::cos(static_cast<double>(edges.direction[e])),
                 sine = std::sin(static_cast<double>(edges.direction[e]));
    for (const int side : {0, 1}) {
      const auto frame =
          reference::patch_frame(edges.x[e], edges.y[e], cosine, sine, side == 0 ? 1 : -1, PatchesConfig{}.offset);
      const auto values = reference::cut_patch(image.view(), frame, 0, 0);
      double largest = 0;
      for (const double value : values) largest = std::max(largest, std::abs(value));
      const double scale = largest < kFlatPatchContrast ? 0 : 127 / largest;
      const auto samples = reference::stored_side(patches.data() + e * kEdgePatchBytes, side);
      for (std::size_t k = 0; k < values.size(); ++k)
        farthest = std::max(farthest, std::abs(samples[k] - scale * values[k]));
    }
  }
  return farthest;
}

}  // namespace

TEST_CASE("patches: a constant image gives zeros and no similarity", "[patches]") {
  Image image(40, 30);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{201});
  const auto patches = cut(image, 19.3f, 14.8f, 0.7f);
  for (const int byte : patches) CHECK(byte == 0);
  CHECK(reference::patch_ncc(patches.data(), patches.data()) == 0.0f);
}

TEST_CASE("patches: a linear ramp shows the sample layout", "[patches]") {
  // I = 2 x + 3 y. A step of 1.5 px along the tangent (c, s) adds 1.5 (2 c + 3 s), one along the bright normal (-s, c)
  // adds -2 s + 3 c.
  Image image(40, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      image.pixels[static_cast<std::size_t>(y * 40 + x)] = static_cast<std::uint8_t>(2 * x + 3 * y);
    }
  }
  for (float direction : {0.0f, 0.4f, -1.9f, kHalfTurn}) {
    const auto patches = cut(image, 20.25f, 19.5f, direction);
    const double c = std::cos(direction), s = std::sin(direction);
    const double per_i = 1.5 * (2 * c + 3 * s), per_j = -2 * s + 3 * c;
    const double scale = 127 / (2 * std::abs(per_i) + 3 * std::abs(per_j));  // the corners are the largest
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < 5; ++i) {
        for (int j = 0; j < 7; ++j) {
          const double expected = scale * ((i - 2) * per_i + (j - 3) * per_j);
          CHECK(patches[position(side, 7 * i + j)] == Approx(expected).margin(0.5 + 1e-4));
        }
      }
    }
  }
}

TEST_CASE("patches: the dark side lies 5 px along (sin, -cos) and comes first", "[patches]") {
  // One bright pixel: its position in the patches shows where each patch lies.
  Image image(41, 41);
  image.pixels[20 * 41 + 25] = 255;
  // Upward tangent (direction -90 degrees): dark side at (-1, 0), bright side at (1, 0).
  const auto patches = cut(image, 20, 20, -kHalfTurn / 2);
  for (const int sample : side_of(patches, 0)) CHECK(sample == 0);
  CHECK(stored_inverse(patches, 0) == 0.0f);
  CHECK(brightest(side_of(patches, 1)) == 17);  // the middle sample
  // The pixel two steps, 3 px, along the tangent (0, -1) and 2 px along the bright normal (1, 0): i = 4, j = 5.
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
  image.pixels[17 * 41 + 27] = 255;
  const auto moved = cut(image, 20, 20, -kHalfTurn / 2);
  CHECK(brightest(side_of(moved, 1)) == 7 * 4 + 5);
}

TEST_CASE("patches: rotating image and edge by 90 degrees gives the same patches", "[patches]") {
  const Image image = noise_image(50, 40, 1);
  Image turned(40, 50);  // clockwise on screen: (x, y) goes to (39 - y, x)
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x)
      turned.pixels[static_cast<std::size_t>(x * 40 + 39 - y)] = static_cast<std::uint8_t>(image.view().value(x, y));
  }
  const float x = 24.25f, y = 18.625f, direction = 0.3f;
  const auto before = cut(image, x, y, direction), after = cut(turned, 39 - y, x, direction + kHalfTurn / 2);
  check_same_patches(before, after);
}

TEST_CASE("patches: the opposite direction swaps the sides and rotates both patches by 180 degrees", "[patches]") {
  const Image image = noise_image(50, 40, 2);
  const auto before = cut(image, 25.5f, 20.125f, 0.9f), after = cut(image, 25.5f, 20.125f, 0.9f - kHalfTurn);
  auto back = after;
  for (const int side : {0, 1}) {
    for (int k = 0; k < kPatchSamples; ++k) back[position(side, k)] = after[position(1 - side, kPatchSamples - 1 - k)];
  }
  check_same_patches(before, back);
}

TEST_CASE("patches: largest sample 127, zero mean, 1 / norm, independent of gain and offset", "[patches]") {
  Image image = noise_image(50, 40, 3), darker(50, 40);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(pixel & 0xfe);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    darker.pixels[k] = static_cast<std::uint8_t>(image.pixels[k] / 2 + 20);
  }
  const auto a = cut(image, 25, 20, 2.2f), b = cut(darker, 25, 20, 2.2f);
  for (int side = 0; side < 2; ++side) {
    const auto samples = side_of(a, side);
    int sum = 0, squares = 0, largest = 0;
    for (const int sample : samples) {
      sum += sample;
      squares += sample * sample;
      largest = std::max(largest, std::abs(sample));
    }
    CHECK(largest == 127);
    CHECK(std::abs(sum) <= 0.5 * kPatchSamples);  // every sample may be rounded by up to 0.5
    CHECK(stored_inverse(a, side) == 1.0f / std::sqrt(static_cast<float>(squares)));
    CHECK(std::all_of(a.begin() + 88, a.end(), [](int byte) { return byte == 0; }));
  }
  CHECK(reference::patch_ncc(a.data(), b.data()) == Approx(1).margin(1e-5));
  CHECK(reference::patch_ncc(a.data(), a.data()) == Approx(1).margin(1e-6));
}

TEST_CASE("patches: the outermost pixels are repeated beyond the border", "[patches]") {
  Image image(20, 20), larger(40, 40);
  const Image texture = noise_image(20, 20, 4);
  image.pixels = texture.pixels;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int from_x = std::clamp(x - 10, 0, 19), from_y = std::clamp(y - 10, 0, 19);
      larger.pixels[static_cast<std::size_t>(y * 40 + x)] =
          static_cast<std::uint8_t>(texture.view().value(from_x, from_y));
    }
  }
  for (const auto& [x, y] : {std::pair{0.5f, 1.25f}, {18.75f, 18.5f}, {9.0f, 0.0f}}) {
    const auto near = cut(image, x, y, 0.6f), inside = cut(larger, x + 10, y + 10, 0.6f);
    check_same_patches(near, inside);
  }
}

TEST_CASE("patches: the similarity is the maximum over the pairings of sides", "[patches]") {
  // Four uncorrelated patches: unit vectors along different axes.
  const auto edge = [](int dark, int bright) {
    std::vector<std::int8_t> patches(kEdgePatchBytes, 0);
    for (const auto& [side, k] : {std::pair{0, dark}, {1, bright}}) {
      reference::PatchValues samples{};
      samples[static_cast<std::size_t>(k)] = 1;
      reference::store_side(samples, side, patches.data());
    }
    return patches;
  };
  const auto ncc = [&](int dark_a, int bright_a, int dark_b, int bright_b) {
    return reference::patch_ncc(edge(dark_a, bright_a).data(), edge(dark_b, bright_b).data());
  };
  CHECK(ncc(0, 1, 0, 3) == 1.0f);
  CHECK(ncc(0, 34, 2, 34) == 1.0f);
  CHECK(ncc(7, 1, 2, 7) == 1.0f);
  CHECK(ncc(0, 17, 17, 3) == 1.0f);
  CHECK(ncc(5, 6, 7, 8) == 0.0f);
}

TEST_CASE("patches: every device and variant equals the reference", "[patches][device][oclgrind]") {
  // Sizes not divisible by any group or vector; edges on the border and beyond it; a count that fills no group.
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 101}}) {
    const Image image = noise_image(width, height, 5);
    const EdgePositions edges = random_edges(width, height, count, 6, 4);
    const auto expected = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, PatchesConfig{});
    CHECK(farthest_from_exact(image, edges, expected) < 0.5 + 1e-9);
    for (const auto& found : describe_everywhere("patches", image, edges)) {
      CAPTURE(found.name, width, height);
      // Single precision: positions accurate to 1e-6 px, contrasts of up to 255 per px, 127 steps for a largest sample
      // of about 100. A sample that close to the middle of a step may be rounded unlike the reference's.
      CHECK(farthest_from_exact(image, edges, found.patches) < 0.5 + 1e-3);
      for (std::size_t edge = 0; edge < expected.size(); edge += kEdgePatchBytes) {
        // Zeros outside the samples, and the norm of the stored samples.
        std::vector<std::int8_t> again(kEdgePatchBytes, 0);
        for (const int side : {0, 1})
          reference::store_side(reference::stored_side(found.patches.data() + edge, side), side, again.data());
        CHECK(std::equal(again.begin(), again.begin() + 80, found.patches.begin() + static_cast<std::ptrdiff_t>(edge)));
        CHECK(std::equal(again.begin() + 88, again.end(),
                         found.patches.begin() + static_cast<std::ptrdiff_t>(edge) + 88));
        for (const int side : {0, 1}) {
          CHECK(reference::inverse_norm(found.patches.data() + edge, side) ==
                Approx(reference::inverse_norm(again.data(), side)).epsilon(1e-6));
        }
      }
    }
  }
}

TEST_CASE("patches: all variants give the same bits, and none writes beyond its edges", "[patches][device]") {
  const Image image = noise_image(131, 77, 7);
  const EdgePositions edges = random_edges(131, 77, 1003, 8);
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    auto& context = *device.context();
    opencl::Buffer<cl_uchar> pixels;
    stages::DevicePositions device_edges;
    pixels.write(context, image.pixels);
    device_edges.write(context, {edges});
    const auto positions = device_edges.list();
    std::vector<cl_char> first;
    for (const auto& variant : opencl::all_variants()) {
      if (variant.stage != "patches") continue;
      stages::Patches stage(context, 131, 77, {}, {{"patches", variant.name}});
      stage.prepare(pixels);
      opencl::Buffer<cl_char> patches(context, 1003 * kEdgePatchBytes + 64);
      patches.fill(7, 1003 * kEdgePatchBytes + 64);
      stage.cut(positions, patches);
      const auto found = patches.read(1003 * kEdgePatchBytes + 64);
      if (first.empty()) first = found;
      CAPTURE(device.info().name, variant.name);
      CHECK(found == first);
      for (std::size_t k = 1003 * kEdgePatchBytes; k < found.size(); ++k) CHECK(found[k] == 7);
    }
  }
}

TEST_CASE("patches: those of edges that are not wanted stay as they were", "[patches][device][oclgrind]") {
  constexpr std::size_t kCount = 101;
  const Image image = noise_image(64, 48, 7);
  const EdgePositions edges = random_edges(64, 48, kCount, 8);
  std::vector<cl_int> wanted(kCount);
  for (std::size_t k = 0; k < kCount; ++k)
    wanted[k] = k % 3 == 0 && (k < 20 || k > 60) ? static_cast<cl_int>(k) + 1 : 0;
  for_each_variant("patches", [&](opencl::Context& context, const Variants& variants) {
    opencl::Buffer<cl_uchar> pixels;
    opencl::Buffer<cl_int> wanted_on_device;
    stages::DevicePositions device_edges;
    pixels.write(context, image.pixels);
    wanted_on_device.write(context, wanted);
    device_edges.write(context, {edges});
    stages::Patches stage(context, 64, 48, {}, variants);
    stage.prepare(pixels);
    opencl::Buffer<cl_char> all, some(context, kCount * kEdgePatchBytes);
    some.fill(7, kCount * kEdgePatchBytes);
    stage.cut(device_edges.list(), all);
    stage.cut(device_edges.list(), wanted_on_device, some);
    const auto described = all.read(kCount * kEdgePatchBytes), found = some.read(kCount * kEdgePatchBytes);
    for (std::size_t byte = 0; byte < found.size(); ++byte)
      REQUIRE(found[byte] == (wanted[byte / kEdgePatchBytes] != 0 ? described[byte] : 7));
  });
}

TEST_CASE("patches: the kernels' similarity equals the reference's bit for bit", "[patches][device][oclgrind]") {
  const Image image = noise_image(90, 70, 9);
  const EdgePositions edges = random_edges(90, 70, 60, 10);
  auto patches = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, PatchesConfig{});
  std::fill_n(patches.begin(), kEdgePatchBytes, std::int8_t{0});  // a flat edge
  for (const int side : {0, 1}) {  // a tie: both sides of edge 2 are the dark side of edge 1
    reference::store_side(reference::stored_side(patches.data() + kEdgePatchBytes, 0), side,
                          patches.data() + 2 * kEdgePatchBytes);
    reference::PatchValues extremes;  // the largest possible products
    for (std::size_t k = 0; k < extremes.size(); ++k) extremes[k] = (k < 18) == (side == 0) ? 1 : -1;
    reference::store_side(extremes, side, patches.data() + 3 * kEdgePatchBytes);
  }
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    auto& context = *device.context();
    const auto program = build_program(
        context, {"described_edges.cl", "similarity.cl"},
        "kernel void score(global const char* patches, global float* scores) {\n"
        "  const int a = (int)get_global_id(0), b = (int)get_global_id(1), k = b * (int)get_global_size(0) + a;\n"
        "  scores[k] = patch_ncc(patches + a * kEdgePatchBytes, patches + b * kEdgePatchBytes);\n"
        "}\n");
    const opencl::Kernel<void(const cl_char*, cl_float*)> score(context, program, "score");
    opencl::Buffer<cl_char> input;
    opencl::Buffer<cl_float> scores(context, 3600);
    input.write(context, patches);
    score({60, 60, 1, 1}, input, scores);
    const auto found = scores.read(3600);
    for (std::size_t k = 0; k < 3600; ++k) {
      CHECK(found[k] ==
            reference::patch_ncc(patches.data() + k % 60 * kEdgePatchBytes, patches.data() + k / 60 * kEdgePatchBytes));
    }
  }
}
