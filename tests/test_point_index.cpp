#include "device/temporal_matching.hpp"
#include "matching.hpp"
#include "reference/temporal_matching.hpp"

using namespace quadedge;

namespace {

/// Random edges, many of which share a cell and some of which lie outside a width x height image.
EdgePositions crowded_edges(int count, int width, int height, std::uint64_t seed) {
  matching::Random random(seed);
  EdgePositions edges;
  for (int k = 0; k < count; ++k) {
    const double part = k % 3 == 0 ? 0.2 : 1.1;  // of the image
    edges.x.push_back(static_cast<float>(random(-3, part * width)));
    edges.y.push_back(static_cast<float>(random(-3, part * height)));
    edges.direction.push_back(static_cast<float>(random(-3, 3)));
  }
  return edges;
}

void add_index(const EdgePositions& edges, int width, int height, const stages::DevicePointIndex& index,
               StageArrays& arrays) {
  reference::PointIndex expected;
  reference::make_point_index(edges.x, edges.y, width, height, expected);
  const std::size_t count = edges.size(), starts = expected.cell_first.size();
  std::vector<float> points;
  for (const auto* values : {&edges.x, &edges.y, &edges.direction})
    for (const auto number : expected.order) points.push_back((*values)[static_cast<std::size_t>(number)]);
  arrays.emplace_back("layout", std::vector{index.layout().columns, index.layout().rows},
                      std::vector{expected.columns, expected.rows});
  arrays.emplace_back("cells", index.cells.read(starts), expected.cell_first);
  arrays.emplace_back("order", index.cells.read(count, starts), expected.order);
  arrays.emplace_back("points", index.points.read(3 * count), points);
}

}  // namespace

TEST_CASE("point index: devices sort the edges of both sides like the reference", "[device][oclgrind]") {
  check_stage("point_index", [&](opencl::Context& context, const Variants& variants) {
    StageArrays arrays;
    stages::PointIndex stage(context, variants);
    stages::DevicePointIndex left_index(83, 31), right_index(90, 29);
    for (const auto& [left_count, right_count] : {std::pair(700, 513), {0, 3}, {1, 0}, {401, 800}}) {
      const auto left = crowded_edges(left_count, 83, 31, 5), right = crowded_edges(right_count, 90, 29, 6);
      stages::DevicePositions edges;
      edges.write(context, {left, right});
      stage.run(edges.list(0), edges.list(1), left_index, right_index);
      add_index(left, 83, 31, left_index, arrays);
      add_index(right, 90, 29, right_index, arrays);
    }
    return arrays;
  });
}
