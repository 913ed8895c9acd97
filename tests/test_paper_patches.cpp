/// \file test_paper_patches.cpp  Side patches of the paper's method on every device, against the plain form.
#include "describing.hpp"
#include "device/paper_matching.hpp"
#include "edge_images.hpp"
#include "matching.hpp"
#include "paper/side_patches.hpp"

using namespace quadedge;

namespace {

/// Cuts the patches of the edges on every device and compares them with the plain form.
void compare_patches(const Image& image, const EdgePositions& edges, double offset) {
  INFO(image.width << " x " << image.height << ", values to " << image.max_value << ", offset " << offset);
  const auto truth = paper::cut_sides(paper::Picture(image.view()), edges, offset);
  check_stage("paper_patches", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::PaperPatches stage(context, image.width, image.height, variants, image.max_value);
    opencl::Buffer<cl_uchar> pixels;
    pixels.write(context, image.pixels);
    stages::DevicePositions positions;
    positions.write(context, {edges});
    opencl::Buffer<cl_float> patches;
    stage.prepare(pixels);
    stage.cut(positions.list(), offset, patches);
    const auto found = patches.read(truth.size() * kPaperPatchFloats);
    double largest = 0, norms = 0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const float* patch = found.data() + i * kPaperPatchFloats;
      for (std::size_t side = 0; side < 2; ++side) {
        for (std::size_t k = 0; k < 56; ++k)
          largest = std::max(
              largest, std::abs(static_cast<double>(patch[16 * (k / 8) + 8 * side + k % 8] - truth[i].sides[side][k])));
        // Where the picture is flat, the norm is that of the rounding.
        const auto norm = static_cast<double>(truth[i].inverse_norm[side]);
        if (norm < 1e2)
          norms = std::max(norms, std::abs(static_cast<double>(patch[kPaperInverseNorms + side]) - norm) / (1 + norm));
      }
      for (std::size_t k = kPaperInverseNorms + 2; k < kPaperPatchFloats; ++k) CHECK(patch[k] == 0);
    }
    CHECK(largest < 2e-3);
    CHECK(norms < 1e-3);
    return {{"patches", found}};
  });
}

}  // namespace

TEST_CASE("paper patches: every device cuts those of the plain form, at the border too", "[device][oclgrind]") {
  compare_patches(textured_image(61, 53), random_edges(61, 53, 301, 1, 40), 5);
  compare_patches(textured_image(17, 9), random_edges(17, 9, 40, 2, 3), 4.5);
  compare_patches(textured_image(1, 1), random_edges(1, 1, 5, 3, 3), 9.25);
}

TEST_CASE("paper patches: images of more than 8 bits, and flat ones", "[device]") {
  compare_patches(noisy_image(47, 39, 120, 30, 65535), random_edges(47, 39, 103, 4, 12), 5);
  compare_patches(noisy_image(40, 31, 120, 30, 4095), random_edges(40, 31, 50, 5, 2), 5);
  compare_patches(noisy_image(40, 30, 113, 0), random_edges(40, 30, 30, 6, 5), 5);
  compare_patches(noisy_image(40, 30, 113, 0), {}, 5);
}
