#pragma once
/// \file describing.hpp  Random edges and images on devices, shared by the tests of side patches and SIFT descriptors.

#include "device/edge_descriptions.hpp"
#include "reference/edge_descriptions.hpp"
#include "stage_rows.hpp"

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

/// An image and positions in it on a device.
struct InputOfDescriptions {
  quadedge::opencl::Buffer<cl_uchar> pixels;
  quadedge::stages::DevicePositions edges;

  InputOfDescriptions(quadedge::opencl::Context& context, const quadedge::Image& image,
                      const quadedge::EdgePositions& positions) {
    pixels.write(context, image.pixels);
    edges.write(context, {positions});
  }
};

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
