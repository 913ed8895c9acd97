#pragma once
/// \file describing.hpp  Random edges and device runs shared by the tests of side patches and SIFT descriptors.

#include <random>
#include <string>
#include <vector>

#include "device/edge_descriptions.hpp"
#include "device/variants.hpp"
#include "devices.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "reference/edge_descriptions.hpp"

/// `count` positions in the image and up to `beyond` px outside it, with all directions.
inline quadedge::EdgePositions random_edges(int width, int height, int count, unsigned seed, double beyond = 0) {
  quadedge::EdgePositions edges;
  std::mt19937_64 random(seed);
  const auto uniform = [&random] { return static_cast<double>(random() >> 11) / 9007199254740992.0; };
  for (int k = 0; k < count; ++k) {
    edges.x.push_back(static_cast<float>(uniform() * (width - 1 + 2 * beyond) - beyond));
    edges.y.push_back(static_cast<float>(uniform() * (height - 1 + 2 * beyond) - beyond));
    edges.direction.push_back(static_cast<float>((2 * uniform() - 1) * quadedge::kPi));
  }
  return edges;
}

struct TestDescriptions {
  std::string name;  ///< device and variant
  std::vector<std::int8_t> patches;
  std::vector<std::uint8_t> sift;
};

/// Descriptions by every variant of `stage` ("patches" or "sift"; the other stage by its default) on every device, each
/// run twice on the same object: the second run must give the same bytes.
inline std::vector<TestDescriptions> describe_everywhere(const std::string& stage, const quadedge::Image& image,
                                                         const quadedge::EdgePositions& edges) {
  using namespace quadedge;
  std::vector<TestDescriptions> all;
  const std::size_t count = edges.x.size();
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    auto& context = *device.context();
    opencl::Buffer<cl_uchar> pixels;
    stages::DevicePositions device_edges;
    pixels.write(context, image.pixels);
    device_edges.write(context, {edges});
    const auto positions = device_edges.list();
    for (const auto& variant : opencl::all_variants()) {
      if (variant.stage != stage) continue;
      const std::map<std::string, std::string> chosen = {{stage, variant.name}};
      stages::Patches patch_stage(context, image.width, image.height, {}, chosen);
      stages::Sift sift_stage(context, image.width, image.height, chosen);
      TestDescriptions found[2];
      for (auto& run : found) {
        opencl::Buffer<cl_char> patches;
        opencl::Buffer<cl_uchar> sift;
        patch_stage.prepare(pixels);
        sift_stage.prepare(pixels);
        patch_stage.cut(positions, patches);
        sift_stage.describe(positions, sift);
        run = {device.info().name + " " + variant.name, patches.read(count * quadedge::kEdgePatchBytes),
               sift.read(count * quadedge::kEdgeSiftBytes)};
      }
      CHECK(found[0].patches == found[1].patches);
      CHECK(found[0].sift == found[1].sift);
      all.push_back(found[0]);
    }
  }
  return all;
}

/// Difference between the samples of two sets of side patches. A sample halfway between two integers may be rounded up
/// in one and down in the other if they are computed in different precision or from rotated coordinates.
struct RoundedApart {
  int largest = 0;  ///< difference between two samples
  std::size_t samples = 0, differing = 0;
};
inline RoundedApart rounded_apart(const std::vector<std::int8_t>& a, const std::vector<std::int8_t>& b) {
  using namespace quadedge::reference;
  RoundedApart result;
  for (std::size_t edge = 0; edge + quadedge::kEdgePatchBytes <= a.size(); edge += quadedge::kEdgePatchBytes) {
    for (const int side : {0, 1}) {
      const auto of_a = stored_side(a.data() + edge, side), of_b = stored_side(b.data() + edge, side);
      for (std::size_t k = 0; k < of_a.size(); ++k) {
        const int difference = std::abs(static_cast<int>(of_a[k]) - static_cast<int>(of_b[k]));
        result.largest = std::max(result.largest, difference);
        result.differing += difference > 0 ? 1 : 0;
        ++result.samples;
      }
    }
  }
  return result;
}
