#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "describing.hpp"
#include "reference/patches.hpp"

using namespace quadedge;
using reference::kEdgePatchFloats;
using reference::kPatchSamples;
using reference::SidePairing;

namespace {

constexpr float kPi = 3.14159265358979f;

Image noise_image(int width, int height, unsigned seed) {
  Image image(width, height);
  std::mt19937_64 random(seed);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(random() >> 56);
  return image;
}

std::vector<float> cut(const Image& image, float x, float y, float direction) {
  return reference::side_patches(image.view(), {x}, {y}, {direction}, PatchesConfig{});
}

/// Sample `k` = 7 i + j of the dark (0) or bright (1) patch.
std::size_t place(int side, int k) { return static_cast<std::size_t>(16 * (k / 7) + 8 * side + k % 7); }

/// The 49 samples of one side.
std::vector<float> side_of(const std::vector<float>& patches, int side) {
  std::vector<float> samples;
  for (int k = 0; k < kPatchSamples; ++k) samples.push_back(patches[place(side, k)]);
  return samples;
}

float norm(const std::vector<float>& patch) {
  float squares = 0;
  for (const float value : patch) squares += value * value;
  return std::sqrt(squares);
}

std::ptrdiff_t brightest(const std::vector<float>& patch) { return std::max_element(patch.begin(), patch.end()) - patch.begin(); }

}  // namespace

TEST_CASE("patches: a constant image gives zeros and no similarity", "[patches]") {
  Image image(40, 30);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{201});
  const auto patches = cut(image, 19.3f, 14.8f, 0.7f);
  for (float value : patches) CHECK(value == 0.0f);
  CHECK(reference::patch_ncc(patches.data(), patches.data()) == 0.0f);
}

TEST_CASE("patches: a linear ramp shows the sample layout", "[patches]") {
  // I = 2 x + 3 y. A step along the tangent (c, s) adds 2 c + 3 s, one along the bright normal (-s, c) adds -2 s + 3 c.
  Image image(40, 40);
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      image.pixels[static_cast<std::size_t>(y * 40 + x)] = static_cast<std::uint8_t>(2 * x + 3 * y);
    }
  }
  for (float direction : {0.0f, 0.4f, -1.9f, kPi}) {
    const auto patches = cut(image, 20.25f, 19.5f, direction);
    const double c = std::cos(direction), s = std::sin(direction);
    const double per_i = 2 * c + 3 * s, per_j = -2 * s + 3 * c;
    // Sum of (i - 3)^2 over a patch is 7 * 28.
    const double scale = 1 / std::sqrt(196.0 * (per_i * per_i + per_j * per_j));
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < 7; ++i) {
        for (int j = 0; j < 7; ++j) {
          const double expected = scale * ((i - 3) * per_i + (j - 3) * per_j);
          CHECK(patches[place(side, 7 * i + j)] == Approx(expected).margin(1e-5));
        }
      }
    }
  }
}

TEST_CASE("patches: the dark side lies 5 px along (sin, -cos) and comes first", "[patches]") {
  // One lit pixel: where it shows up in the patches tells where each patch lies.
  Image image(41, 41);
  image.pixels[20 * 41 + 25] = 255;
  // Tangent upwards (direction -90 degrees): dark side at (-1, 0), bright side at (1, 0).
  const auto patches = cut(image, 20, 20, -kPi / 2);
  CHECK(norm(side_of(patches, 0)) == 0.0f);
  CHECK(brightest(side_of(patches, 1)) == 24);  // the middle sample
  // The pixel one step along the tangent (0, -1) and two steps along the bright normal (1, 0): i = 4, j = 5.
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
  image.pixels[19 * 41 + 27] = 255;
  const auto moved = cut(image, 20, 20, -kPi / 2);
  CHECK(brightest(side_of(moved, 1)) == 7 * 4 + 5);
}

TEST_CASE("patches: turning image and edge by 90 degrees gives the same patches", "[patches]") {
  const Image image = noise_image(50, 40, 1);
  Image turned(40, 50);  // clockwise on screen: (x, y) goes to (39 - y, x)
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 50; ++x) turned.pixels[static_cast<std::size_t>(x * 40 + 39 - y)] = image.view().at(x, y);
  }
  const float x = 24.25f, y = 18.625f, direction = 0.3f;
  const auto before = cut(image, x, y, direction), after = cut(turned, 39 - y, x, direction + kPi / 2);
  for (std::size_t k = 0; k < before.size(); ++k) CHECK(after[k] == Approx(before[k]).margin(1e-5));
}

TEST_CASE("patches: the opposite direction swaps the sides and turns both patches by 180 degrees", "[patches]") {
  const Image image = noise_image(50, 40, 2);
  const auto before = cut(image, 25.5f, 20.125f, 0.9f), after = cut(image, 25.5f, 20.125f, 0.9f - kPi);
  for (int k = 0; k < kPatchSamples; ++k) {
    CHECK(after[place(1, 48 - k)] == Approx(before[place(0, k)]).margin(1e-5));
    CHECK(after[place(0, 48 - k)] == Approx(before[place(1, k)]).margin(1e-5));
  }
}

TEST_CASE("patches: unit norm, no mean, and neither gain nor offset matter", "[patches]") {
  Image image = noise_image(50, 40, 3), darker(50, 40);
  for (auto& pixel : image.pixels) pixel = static_cast<std::uint8_t>(pixel & 0xfe);
  for (std::size_t k = 0; k < image.pixels.size(); ++k) {
    darker.pixels[k] = static_cast<std::uint8_t>(image.pixels[k] / 2 + 20);
  }
  const auto a = cut(image, 25, 20, 2.2f), b = cut(darker, 25, 20, 2.2f);
  for (int side = 0; side < 2; ++side) {
    const auto samples = side_of(a, side);
    CHECK(norm(samples) == Approx(1).margin(1e-6));
    float sum = 0;
    for (const float value : samples) sum += value;
    CHECK(sum == Approx(0).margin(1e-5));
  }
  CHECK(reference::patch_ncc(a.data(), b.data()) == Approx(1).margin(1e-5));
  CHECK(reference::patch_ncc(a.data(), a.data()) == Approx(1).margin(1e-6));
}

TEST_CASE("patches: beyond the border the outermost pixels repeat", "[patches]") {
  Image image(20, 20), larger(40, 40);
  const Image texture = noise_image(20, 20, 4);
  image.pixels = texture.pixels;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int from_x = std::clamp(x - 10, 0, 19), from_y = std::clamp(y - 10, 0, 19);
      larger.pixels[static_cast<std::size_t>(y * 40 + x)] = texture.view().at(from_x, from_y);
    }
  }
  for (const auto& [x, y] : {std::pair{0.5f, 1.25f}, {18.75f, 18.5f}, {9.0f, 0.0f}}) {
    const auto near = cut(image, x, y, 0.6f), inside = cut(larger, x + 10, y + 10, 0.6f);
    for (std::size_t k = 0; k < near.size(); ++k) CHECK(near[k] == Approx(inside[k]).margin(1e-5));
  }
}

TEST_CASE("patches: the similarity is the best pairing of sides, the first one on a tie", "[patches]") {
  // Four patches without anything in common: unit vectors along different axes.
  const auto edge = [](int dark, int bright) {
    std::vector<float> patches(kEdgePatchFloats, 0.0f);
    patches[place(0, dark)] = 1;
    patches[place(1, bright)] = 1;
    return patches;
  };
  const auto pairing = [](const std::vector<float>& a, const std::vector<float>& b) {
    const auto best = reference::patch_similarity(a.data(), b.data());
    CHECK(best.ncc == 1.0f);
    return best.pairing;
  };
  CHECK(pairing(edge(0, 1), edge(0, 3)) == SidePairing::dark_dark);
  CHECK(pairing(edge(0, 48), edge(2, 48)) == SidePairing::bright_bright);
  CHECK(pairing(edge(7, 1), edge(2, 7)) == SidePairing::dark_bright);
  CHECK(pairing(edge(0, 17), edge(17, 3)) == SidePairing::bright_dark);
  CHECK(pairing(edge(5, 6), edge(5, 6)) == SidePairing::dark_dark);
  CHECK(pairing(edge(5, 6), edge(6, 5)) == SidePairing::dark_bright);
}

TEST_CASE("patches: every device and variant equals the reference", "[patches][device][oclgrind]") {
  // Sizes that no group or vector divides; edges on the border and beyond it; a count that fills no group.
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 101}}) {
    const Image image = noise_image(width, height, 5);
    const TestEdges edges = random_edges(width, height, count, 6, 4);
    const auto expected = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, PatchesConfig{});
    for (const auto& found : describe_everywhere("patches", image, edges)) {
      double worst = 0;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        worst = std::max(worst, std::abs(static_cast<double>(found.patches[k]) - expected[k]));
      }
      CAPTURE(found.name, width, height);
      // Single precision: places good to 1e-6 px, contrasts of up to 255 per px against norms above 100.
      CHECK(worst < 1e-5);
    }
  }
}

TEST_CASE("patches: all variants give the same bits, and none writes beyond its edges", "[patches][device]") {
  const Image image = noise_image(131, 77, 7);
  const TestEdges edges = random_edges(131, 77, 1003, 8);
  for (const auto& index : all_devices()) {
    Device device(index);
    auto& context = *device.context();
    opencl::Buffer<cl_uchar> pixels;
    opencl::Buffer<cl_float> x, y, direction;
    pixels.write(context, image.pixels);
    x.write(context, edges.x);
    y.write(context, edges.y);
    direction.write(context, edges.direction);
    std::vector<float> first;
    for (const auto& variant : opencl::all_variants()) {
      if (variant.stage != "patches") continue;
      stages::EdgeDescription describer(context, 131, 77, {}, {}, {{"patches", variant.name}});
      describer.prepare(pixels);
      opencl::Buffer<cl_float> patches(context, 1003 * kEdgePatchFloats + 64);
      patches.fill(7.0f, 1003 * kEdgePatchFloats + 64);
      describer.cut_patches(x, y, direction, 1003, patches);
      const auto found = patches.read(1003 * kEdgePatchFloats + 64);
      if (first.empty()) first = found;
      CAPTURE(device.info().name, variant.name);
      CHECK(found == first);
      for (std::size_t k = 1003 * kEdgePatchFloats; k < found.size(); ++k) CHECK(found[k] == 7.0f);
    }
  }
}

TEST_CASE("patches: the kernels' similarity equals the reference's bit by bit", "[patches][device][oclgrind]") {
  const Image image = noise_image(90, 70, 9);
  const TestEdges edges = random_edges(90, 70, 60, 10);
  auto patches = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, PatchesConfig{});
  std::fill_n(patches.begin(), kEdgePatchFloats, 0.0f);                          // a flat edge
  for (int k = 0; k < kPatchSamples; ++k) {                                      // a tie: both sides of edge 2 are the
    const float dark = patches[kEdgePatchFloats + place(0, k)];                  // dark side of edge 1
    for (const int side : {0, 1}) patches[2 * kEdgePatchFloats + place(side, k)] = dark;
  }
  for (const auto& index : all_devices()) {
    Device device(index);
    auto& context = *device.context();
    const auto program = build_with_similarity(
        context,
        "kernel void score(global const float* patches, global float* scores, global int* pairings) {\n"
        "  const int a = (int)get_global_id(0), b = (int)get_global_id(1), k = b * (int)get_global_size(0) + a;\n"
        "  int pairing;\n"
        "  scores[k] = patch_ncc_pairing(patches + a * 112, patches + b * 112, &pairing);\n"
        "  pairings[k] = pairing;\n"
        "}\n");
    const opencl::Kernel<opencl::In<cl_float>, opencl::Out<cl_float>, opencl::Out<cl_int>> score(context, program, "score");
    opencl::Buffer<cl_float> input, scores(context, 3600);
    opencl::Buffer<cl_int> pairings(context, 3600);
    input.write(context, patches);
    score({60, 60, 1, 1}, input, scores, pairings);
    const auto found = scores.read(3600);
    const auto which = pairings.read(3600);
    for (std::size_t k = 0; k < 3600; ++k) {
      const auto expected = reference::patch_similarity(patches.data() + k % 60 * kEdgePatchFloats,
                                                        patches.data() + k / 60 * kEdgePatchFloats);
      CHECK(found[k] == expected.ncc);
      CHECK(which[k] == static_cast<int>(expected.pairing));
    }
  }
}
