#include "describing.hpp"
#include "edge_images.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;

namespace {

Image noise_image(int width, int height, unsigned seed) {
  std::mt19937_64 random(seed);
  return filled_image(width, height, [&](int, int) { return static_cast<int>(random() >> 56); });
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

void check_patches(int width, int height, int count) {
  constexpr std::size_t kBeyond = 64;  // bytes behind the patches, which stay as they were
  const Image image = noise_image(width, height, 5);
  const EdgePositions edges = random_edges(width, height, count, 6, 4);
  const auto expected = reference::side_patches(image.view(), edges.x, edges.y, edges.direction, PatchesConfig{});
  CHECK(farthest_from_exact(image, edges, expected) < 0.5 + 1e-9);
  check_stage("patches", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    const InputOfDescriptions input(context, image, edges);
    stages::Patches stage(context, width, height, {}, variants);
    opencl::Buffer<cl_char> patches(context, expected.size() + kBeyond);
    patches.fill(7, expected.size() + kBeyond);
    stage.prepare(input.pixels);
    stage.cut(input.edges.list(), patches);
    const auto found = patches.read(expected.size());
    // Single precision: positions accurate to 1e-6 px, contrasts of up to 255 per px, 127 steps for a largest sample
    // of about 100. A sample that close to the middle of a step may be rounded unlike the reference's.
    CHECK(farthest_from_exact(image, edges, found) < 0.5 + 1e-3);
    // Zeros outside the samples, and the norm of the stored samples.
    std::vector<std::int8_t> again(expected.size());
    std::vector<float> norms;
    for (std::size_t edge = 0; edge < found.size(); edge += kEdgePatchBytes)
      for (const int side : {0, 1}) {
        reference::store_side(reference::stored_side(found.data() + edge, side), side, again.data() + edge);
        const float norm = reference::inverse_norm(found.data() + edge, side),
                    of_samples = reference::inverse_norm(again.data() + edge, side);
        norms.push_back(norm == of_samples ? 1 : norm / of_samples);  // both are 0 where the patch is flat
      }
    auto samples = found;
    for (auto* bytes : {&samples, &again})
      for (std::size_t edge = 0; edge < found.size(); edge += kEdgePatchBytes)
        std::fill_n(bytes->begin() + static_cast<std::ptrdiff_t>(edge) + 80, 8, std::int8_t{0});
    return {{"patches", found},
            {"samples", samples, again},
            {"norms over those of the samples", norms, std::vector<int>(norms.size(), 1), {1e-6}},
            {"behind", patches.read(kBeyond, expected.size()), std::vector<int>(kBeyond, 7)}};
  });
}

}  // namespace

TEST_CASE("patches: largest sample 127, zero mean, 1 / norm, independent of gain and offset") {
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

TEST_CASE("patches: the outermost pixels are repeated beyond the border") {
  const Image image = noise_image(20, 20, 4),
              larger = filled_image(40, 40, [&](int x, int y) {
                return image.view().value(std::clamp(x - 10, 0, 19), std::clamp(y - 10, 0, 19));
              });
  for (const auto& [x, y] : {std::pair{0.5f, 1.25f}, {18.75f, 18.5f}, {9.0f, 0.0f}}) {
    const auto near = cut(image, x, y, 0.6f), inside = cut(larger, x + 10, y + 10, 0.6f);
    check_same_patches(near, inside);
  }
}

TEST_CASE("patches: every device and variant equals the reference", "[device][oclgrind]") {
  // Sizes not divisible by any group or vector; edges on the border and beyond it; a count that fills no group.
  for (const auto& [width, height, count] : {std::tuple{1, 1, 3}, {5, 3, 7}, {17, 31, 37}, {64, 48, 101}})
    check_patches(width, height, count);
}

TEST_CASE("patches: of many edges", "[device]") { check_patches(131, 77, 1003); }

TEST_CASE("patches: those of edges that are not wanted stay as they were", "[device][oclgrind]") {
  constexpr std::size_t kCount = 101;
  const Image image = noise_image(64, 48, 7);
  const EdgePositions edges = random_edges(64, 48, kCount, 8);
  std::vector<cl_int> wanted(kCount);
  for (std::size_t k = 0; k < kCount; ++k)
    wanted[k] = k % 3 == 0 && (k < 20 || k > 60) ? static_cast<cl_int>(k) + 1 : 0;
  check_stage("patches", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    const InputOfDescriptions input(context, image, edges);
    opencl::Buffer<cl_int> wanted_on_device;
    wanted_on_device.write(context, wanted);
    stages::Patches stage(context, 64, 48, {}, variants);
    stage.prepare(input.pixels);
    opencl::Buffer<cl_char> all, some(context, kCount * kEdgePatchBytes);
    some.fill(7, kCount * kEdgePatchBytes);
    stage.cut(input.edges.list(), all);
    stage.cut(input.edges.list(), wanted_on_device, some);
    auto expected = all.read(kCount * kEdgePatchBytes);
    for (std::size_t byte = 0; byte < expected.size(); ++byte)
      if (wanted[byte / kEdgePatchBytes] == 0) expected[byte] = 7;
    return {{"patches", some.read(expected.size()), expected}};
  });
}
