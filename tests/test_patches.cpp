#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

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

float norm(const float* patch) {
  float squares = 0;
  for (int k = 0; k < kPatchSamples; ++k) squares += patch[k] * patch[k];
  return std::sqrt(squares);
}

}  // namespace

TEST_CASE("patches: a constant image gives zeros and no similarity", "[patches]") {
  Image image(40, 30);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{201});
  const auto patches = cut(image, 19.3f, 14.8f, 0.7f);
  for (float value : patches) CHECK(value == 0.0f);
  CHECK(reference::patch_ncc(patches.data(), patches.data()) == 0.0f);
}

TEST_CASE("patches: a linear ramp shows the sample layout", "[patches]") {
  // I = 2 x + 3 y. A step along the tangent (c, s) adds 2 c + 3 s, one along the dark normal (-s, c) adds -2 s + 3 c.
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
          CHECK(patches[static_cast<std::size_t>(side * 49 + 7 * i + j)] == Approx(expected).margin(1e-5));
        }
      }
    }
  }
}

TEST_CASE("patches: the bright side lies 5 px along (sin, -cos) and comes first", "[patches]") {
  // One lit pixel: where it shows up in the patches tells where each patch lies.
  Image image(41, 41);
  image.pixels[20 * 41 + 25] = 255;
  // Tangent upwards (direction -90 degrees): bright side at (-1, 0), dark side at (1, 0).
  const auto patches = cut(image, 20, 20, -kPi / 2);
  CHECK(norm(patches.data()) == 0.0f);
  const float* dark = patches.data() + kPatchSamples;
  CHECK(std::max_element(dark, dark + kPatchSamples) - dark == 24);  // the middle sample
  // The pixel one step along the tangent (0, -1) and two steps along the dark normal (1, 0): i = 4, j = 5.
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{0});
  image.pixels[19 * 41 + 27] = 255;
  const auto moved = cut(image, 20, 20, -kPi / 2);
  dark = moved.data() + kPatchSamples;
  CHECK(std::max_element(dark, dark + kPatchSamples) - dark == 7 * 4 + 5);
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
  for (std::size_t k = 0; k < kPatchSamples; ++k) {
    CHECK(after[kPatchSamples + 48 - k] == Approx(before[k]).margin(1e-5));
    CHECK(after[48 - k] == Approx(before[kPatchSamples + k]).margin(1e-5));
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
    CHECK(norm(a.data() + side * kPatchSamples) == Approx(1).margin(1e-6));
    float sum = 0;
    for (int k = 0; k < kPatchSamples; ++k) sum += a[static_cast<std::size_t>(side * kPatchSamples + k)];
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
  const auto edge = [](int bright, int dark) {
    std::vector<float> patches(kEdgePatchFloats, 0.0f);
    patches[static_cast<std::size_t>(bright)] = 1;
    patches[static_cast<std::size_t>(kPatchSamples + dark)] = 1;
    return patches;
  };
  const auto pairing = [](const std::vector<float>& a, const std::vector<float>& b) {
    const auto best = reference::patch_similarity(a.data(), b.data());
    CHECK(best.ncc == 1.0f);
    return best.pairing;
  };
  CHECK(pairing(edge(0, 1), edge(0, 3)) == SidePairing::bright_bright);
  CHECK(pairing(edge(0, 48), edge(2, 48)) == SidePairing::dark_dark);
  CHECK(pairing(edge(7, 1), edge(2, 7)) == SidePairing::bright_dark);
  CHECK(pairing(edge(0, 17), edge(17, 3)) == SidePairing::dark_bright);
  CHECK(pairing(edge(5, 6), edge(5, 6)) == SidePairing::bright_bright);
  CHECK(pairing(edge(5, 6), edge(6, 5)) == SidePairing::bright_dark);
}
