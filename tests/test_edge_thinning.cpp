#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "devices.hpp"
#include "edge_images.hpp"
#include "edge_structure.hpp"
#include "quadedge/pi.hpp"
#include "reference/edge_detection.hpp"
#include "reference/edge_thinning.hpp"
#include "stages/edge_detection.hpp"

using namespace quadedge;
using reference::ReferenceEdges;

namespace {

struct Detection {
  EdgeSet edges;
  int dropped = 0;
};

Detection detect(Device& device, const Image& image, const EdgesConfig& config) {
  stages::EdgeDetection stage(*device.context(), image.width, image.height, config, {});
  stages::PaddedPlane plane(*device.context(), image.width, image.height, config.sigma);
  opencl::Buffer<cl_uchar> pixels;
  pixels.write(*device.context(), image.pixels);
  plane.prepare(pixels);
  opencl::Buffer<cl_float> threshold;
  threshold.write(*device.context(), {static_cast<cl_float>(threshold_of(config))});
  stages::DeviceEdges edges;
  stage.run(plane, threshold, edges);
  edges.read_count();
  return {edges.read(image.height), edges.host_dropped};
}

}  // namespace

TEST_CASE("edge thinning: the strongest of a pixel survives, directions 45 degrees apart do not meet", "[edges]") {
  EdgeSet edges;
  const auto add = [&](float x, float y, double direction_deg, float strength) {
    edges.x.push_back(x);
    edges.y.push_back(y);
    edges.direction.push_back(static_cast<float>(direction_deg * kDegree));
    edges.strength.push_back(strength);
    edges.scale_drift.push_back(0);
  };
  add(5.2F, 7.4F, 10, 3);     // 0: weaker neighbour of 1
  add(4.6F, 6.6F, 50, 4);     // 1: strongest of pixel (5, 7)
  add(5.0F, 7.0F, 96, 3.5F);  // 2: more than 45 degrees from 1
  add(5.6F, 7.0F, 10, 1);     // 3: alone in pixel (6, 7)
  add(9.1F, 7.0F, 175, 2);    // 4: equal to 5, comes first
  add(8.9F, 7.0F, -175, 2);   // 5: 10 degrees from 4 across the wrap
  add(8.8F, 7.0F, -5, 1);     // 6: opposite contrast
  CHECK(reference::kept_by_thinning(edges) == std::vector<std::uint8_t>{0, 1, 1, 1, 1, 0, 1});
}

TEST_CASE("edge thinning: along a curve every pixel keeps one edge and none is left without", "[edges]") {
  const Image image = render_half_plane(64, 64, 31.4, 32.2, 41.0 * kDegree);
  EdgesConfig thin;
  thin.thinning = true;
  const ReferenceEdges all = ::detect_edges(image.view(), {}), thinned = ::detect_edges(image.view(), thin);
  check_structure(thinned, 64, 64, thin);
  const auto pixels = [](const ReferenceEdges& edges) {
    std::vector<std::pair<int, int>> found;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      found.emplace_back(static_cast<int>(std::floor(edges.x[i] + 0.5)),
                         static_cast<int>(std::floor(edges.y[i] + 0.5)));
    }
    std::sort(found.begin(), found.end());
    return found;
  };
  auto occupied = pixels(all);
  occupied.erase(std::unique(occupied.begin(), occupied.end()), occupied.end());
  CHECK(all.size() > thinned.size());
  CHECK(pixels(thinned) == occupied);
}

TEST_CASE("edge thinning: devices keep exactly the edges that the reference rule keeps", "[edges][device][oclgrind]") {
  const Image image = textured_image(30, 26);
  for (const auto& index : all_devices()) {
    Device device(index);
    INFO(device.info().name);
    EdgesConfig config;
    config.margin = 2;
    config.max_edges = 500;
    const EdgeSet all = detect(device, image, config).edges;
    const std::vector<std::uint8_t> kept = reference::kept_by_thinning(all);
    EdgeSet expected;
    for (std::size_t row = 0; row + 1 < all.row_first.size(); ++row) {
      expected.row_first.push_back(static_cast<std::int32_t>(expected.size()));
      for (auto i = static_cast<std::size_t>(all.row_first[row]); i < static_cast<std::size_t>(all.row_first[row + 1]);
           ++i) {
        if (!kept[i]) continue;
        expected.x.push_back(all.x[i]);
        expected.y.push_back(all.y[i]);
        expected.direction.push_back(all.direction[i]);
        expected.strength.push_back(all.strength[i]);
      }
    }
    expected.row_first.push_back(static_cast<std::int32_t>(expected.size()));
    REQUIRE(expected.size() < all.size());
    config.thinning = true;
    const EdgeSet thinned = detect(device, image, config).edges;
    CHECK(thinned.x == expected.x);
    CHECK(thinned.y == expected.y);
    CHECK(thinned.direction == expected.direction);
    CHECK(thinned.strength == expected.strength);
    CHECK(thinned.row_first == expected.row_first);
    // What the capacity cuts off before the thinning is still counted.
    config.max_edges = 40;
    const Detection cut = detect(device, image, config);
    CHECK(cut.dropped == static_cast<int>(all.size()) - 40);
    CHECK(cut.edges.size() <= 40);
  }
}
