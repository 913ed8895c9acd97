/// \file test_grid_edges.cpp  The paper's edges on devices, against host/workbench/paper/grid_edges.cpp.
#include "device/grid_edges.hpp"
#include "edge_images.hpp"
#include "frontends.hpp"
#include "matching.hpp"
#include "paper/grid_edges.hpp"

using namespace quadedge;

namespace {

constexpr float kGridEdgesThreshold = 2;

struct FoundGridEdges {
  EdgeSet edges;
  int dropped = 0;
};

EdgesConfig grid_config(int max_edges, int margin, double sigma = 2.0) {
  EdgesConfig config;
  config.max_edges = max_edges;
  config.margin = margin;
  config.sigma = sigma;
  return config;
}

FoundGridEdges find_grid_edges(opencl::Context& context, const Variants& variants, const Image& image,
                               const EdgesConfig& config, const PixelMask& mask = {}) {
  stages::GridEdges stage(context, image.width, image.height, config, mask, variants);
  stages::PaddedPlane plane(context, image.width, image.height, config.sigma, image.max_value);
  opencl::Buffer<cl_uchar> pixels;
  pixels.write(context, image.pixels);
  plane.prepare(pixels);
  opencl::Buffer<cl_float> threshold;
  threshold.write(context, {kGridEdgesThreshold});
  stages::DeviceEdges edges;
  stage.run(plane, threshold, edges);
  edges.read_count();
  return {edges.read(image.height), edges.host_dropped};
}

reference::ReferenceEdges expected_grid_edges(const Image& image, const EdgesConfig& config,
                                              const PixelMask& mask = {}) {
  return reference::outside_mask(paper::grid_edges(image.view(), config, static_cast<double>(kGridEdgesThreshold)),
                                 mask, config.margin);
}

/// Every edge of either set has one of the other within 1e-3 px, apart from one in a thousand, which rounding decides;
/// of these 99.9 % agree in direction and strength.
void check_grid_edges(const EdgeSet& found, const reference::ReferenceEdges& truth, int height) {
  REQUIRE(found.row_first.size() == truth.row_first.size());
  REQUIRE(found.row_first.front() == 0);
  REQUIRE(found.row_first.back() == static_cast<int>(found.size()));
  std::size_t matched = 0, apart = 0, disordered = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const int row = truth.row[i];
    const auto begin = static_cast<std::size_t>(found.row_first[static_cast<std::size_t>(std::max(row - 1, 0))]),
               end = static_cast<std::size_t>(found.row_first[static_cast<std::size_t>(std::min(row + 2, height))]);
    for (std::size_t j = begin; j < end; ++j) {
      const double x = static_cast<double>(found.x[j]), y = static_cast<double>(found.y[j]);
      if (std::hypot(x - truth.x[i], y - truth.y[i]) > 1e-3) continue;
      ++matched;
      const double turn = std::remainder(static_cast<double>(found.direction[j]) - truth.direction[i], 2 * kPi),
                   strength = static_cast<double>(found.strength[j]) / truth.strength[i] - 1;
      apart += std::abs(turn) > 1e-3 || std::abs(strength) > 1e-4 ? 1 : 0;
      break;
    }
  }
  for (int row = 0; row < height; ++row) {
    const auto end = static_cast<std::size_t>(found.row_first[static_cast<std::size_t>(row) + 1]);
    for (auto j = static_cast<std::size_t>(found.row_first[static_cast<std::size_t>(row)]); j < end; ++j) {
      REQUIRE(std::lround(found.y[j]) == row);
      REQUIRE(found.scale_shift[j] == 0);
      disordered += j + 1 < end && found.x[j] > found.x[j + 1] ? 1 : 0;
    }
  }
  CHECK(disordered == 0);
  const auto few = static_cast<std::size_t>(std::ceil(0.001 * static_cast<double>(truth.size())));
  CHECK(matched + few >= truth.size());
  CHECK(matched + few >= found.size());
  CHECK(apart <= few);
}

}  // namespace

TEST_CASE("grid edges: devices agree with the plain form at odd sizes, margins and scales, and are reproducible",
          "[device]") {
  const std::tuple<int, int, int, double> cases[] = {{143, 97, 10, 2.0}, {321, 243, 10, 2.0}, {64, 49, 3, 2.0},
                                                     {17, 31, 1, 2.0},   {97, 60, 7, 1.3},    {160, 121, 12, 3.1}};
  for (const auto& [width, height, margin, sigma] : cases) {
    const Image image = textured_image(width, height);
    const EdgesConfig config = grid_config(60000, margin, sigma);
    const auto truth = expected_grid_edges(image, config);
    check_stage("grid_edges", [&, w = width, h = height](opencl::Context& context, const Variants& variants) {
      INFO(w << "x" << h);
      const FoundGridEdges found = find_grid_edges(context, variants, image, config);
      CHECK(found.dropped == 0);
      check_grid_edges(found.edges, truth, h);
      CHECK(static_cast<int>(found.edges.size()) > w * h / 60);
      return arrays_of(found.edges);
    });
  }
}

TEST_CASE("grid edges: images within the margin have none, hidden pixels have none, a full list is cut in order",
          "[device][oclgrind]") {
  const Image image = textured_image(41, 37);
  PixelMask mask{41, 37, std::vector<std::uint8_t>(41 * 37)};
  for (int y = 0; y < 37; ++y)
    for (int x = 15; x < 22; ++x) mask.hidden[static_cast<std::size_t>(41 * y + x)] = 1;
  for_each_variant("grid_edges", [&](opencl::Context& context, const Variants& variants) {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(7, 60), std::pair(60, 5), std::pair(21, 21)})
      CHECK(find_grid_edges(context, variants, textured_image(width, height), grid_config(100, 10)).edges.size() == 0);
    EdgesConfig config = grid_config(3000, 2);
    const EdgeSet all = find_grid_edges(context, variants, image, config).edges;
    check_grid_edges(find_grid_edges(context, variants, image, config, mask).edges,
                     expected_grid_edges(image, config, mask), 37);
    config.max_edges = 60;
    REQUIRE(all.size() > 100);
    const FoundGridEdges cut = find_grid_edges(context, variants, image, config);
    CHECK(cut.dropped == static_cast<int>(all.size()) - 60);
    REQUIRE(cut.edges.size() == 60);
    for (std::size_t i = 0; i < 60; ++i) {
      REQUIRE(cut.edges.x[i] == all.x[i]);
      REQUIRE(cut.edges.direction[i] == all.direction[i]);
    }
    for (std::size_t row = 0; row < all.row_first.size(); ++row)
      REQUIRE(cut.edges.row_first[row] == std::min(all.row_first[row], 60));
  });
}
