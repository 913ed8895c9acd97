#include "device/temporal_matching.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/temporal_matching.hpp"

using namespace quadedge;
using namespace matching;
using reference::WideEdges;

namespace {

StereoEdges edges_at(const std::vector<std::pair<float, float>>& positions) {
  StereoEdges edges;
  for (const auto& [x, y] : positions) {
    edges.left_x.push_back(x);
    edges.left_y.push_back(y);
    edges.right_x.push_back(x - 5);
    edges.right_y.push_back(y);
    edges.left_index.push_back(static_cast<std::int32_t>(edges.left_index.size()));
  }
  return edges;
}

/// Descriptors that point along axis `first`, rotated by `degrees` towards axis `second`.
void add_descriptor(std::vector<std::uint8_t>& bytes, int first, int second, double degrees) {
  std::vector<std::uint8_t> one(kWideBytes, 0);
  // A norm of 512 needs more than one byte of at most 255: five equal bytes each.
  for (int k = 0; k < 5; ++k) {
    one[static_cast<std::size_t>(5 * first + k)] =
        static_cast<std::uint8_t>(std::lround(229 * std::cos(degrees * kDegree)));
    one[static_cast<std::size_t>(5 * second + k)] =
        static_cast<std::uint8_t>(std::lround(229 * std::sin(degrees * kDegree)));
  }
  bytes.insert(bytes.end(), one.begin(), one.end());
}

std::vector<std::uint8_t> random_descriptors(std::size_t rows, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::uint8_t> bytes(rows * kWideBytes);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(std::abs(random(-40, 40)) + std::abs(random(-40, 40)));
  return bytes;
}

stages::DeviceStereoEdges on_device(opencl::Context& context, const StereoEdges& edges) {
  stages::DeviceStereoEdges result;
  result.count = static_cast<int>(edges.size());
  result.stride = result.count + 7;
  std::vector<float> packed(6 * static_cast<std::size_t>(result.stride), 0.0f);
  std::copy(edges.left_x.begin(), edges.left_x.end(), packed.begin());
  std::copy(edges.left_y.begin(), edges.left_y.end(), packed.begin() + result.stride);
  result.packed.write(context, packed);
  return result;
}

/// The reference's matches, after checking that every device and variant finds the same.
TemporalMatches match_everywhere(const WideEdges& earlier, const WideEdges& current) {
  const auto expected = reference::find_global_matches(earlier, current);
  check_stage("global_matching", [&](opencl::Context& context, const Variants& variants) {
    const auto before = on_device(context, earlier.edges), now = on_device(context, current.edges);
    opencl::Buffer<cl_uchar> before_bytes, now_bytes;
    before_bytes.write(context, earlier.descriptors);
    now_bytes.write(context, current.descriptors);
    const auto rows = [](const WideEdges& set) { return static_cast<int>(set.descriptors.size() / kWideBytes); };
    stages::GlobalMatching stage(context, variants);
    const auto found = stage.run({before, earlier.step, rows(earlier), before_bytes},
                                 {now, current.step, rows(current), now_bytes}, current.edges);
    return arrays_of(found, expected);
  });
  return expected;
}

}  // namespace

TEST_CASE("wide matching: the step selects about the wanted number of edges") {
  CHECK(global_step(0, 3000) == 1);
  CHECK(global_step(5999, 3000) == 1);
  CHECK(global_step(6000, 3000) == 2);
  CHECK(global_step(30000, 3000) == 10);
}

TEST_CASE("wide matching: a good match elsewhere makes a match ambiguous, a good neighbour does not",
          "[device][oclgrind]") {
  // Row 0 finds column 0 in spite of its neighbour, column 1. Rows 1 and 2 have competing matches at a distance: the
  // descriptor distances at 20 and 24 degrees have a ratio of 0.84, at 20 and 40 degrees of 0.51.
  std::vector<std::uint8_t> rows, columns;
  for (int axis : {0, 2, 4}) add_descriptor(rows, axis, axis + 1, 0);
  add_descriptor(columns, 0, 1, 20);
  add_descriptor(columns, 0, 1, 21);
  add_descriptor(columns, 2, 3, 20);
  add_descriptor(columns, 2, 3, 24);
  add_descriptor(columns, 4, 5, 20);
  add_descriptor(columns, 4, 5, 40);
  const StereoEdges earlier = edges_at({{10, 10}, {50, 10}, {90, 10}});
  const StereoEdges current = edges_at({{10, 30}, {14, 30}, {60, 30}, {100, 30}, {140, 30}, {180, 30}});
  const auto matches = match_everywhere({earlier, 1, rows}, {current, 1, columns});
  CHECK(matches.previous == std::vector<std::int32_t>{0, 2});
  CHECK(matches.current == std::vector<std::int32_t>{0, 4});
  CHECK(matches.left_x == std::vector<float>{10, 140});
  CHECK(matches.right_x == std::vector<float>{5, 135});
  CHECK(std::abs(matches.ncc[0] - static_cast<float>(std::cos(20 * kDegree))) < 0.01f);
}

TEST_CASE("wide matching: an edge with equally good matches in different places has none", "[device][oclgrind]") {
  std::vector<std::uint8_t> rows, columns;
  for (double degrees : {10.0, 8.0, 8.0}) add_descriptor(rows, 0, 1, degrees);
  add_descriptor(columns, 0, 1, 0);
  const StereoEdges current = edges_at({{30, 30}});
  // The first row is worse than the others. The last two are equally good: neighbours share the column, distant rows
  // lose it.
  CHECK(match_everywhere({edges_at({{10, 10}, {50, 10}, {54, 10}}), 1, rows}, {current, 1, columns}).previous ==
        std::vector<std::int32_t>{1, 2});
  CHECK(match_everywhere({edges_at({{10, 10}, {50, 10}, {90, 10}}), 1, rows}, {current, 1, columns}).previous.empty());
}

TEST_CASE("wide matching: devices agree with the reference on random descriptors, odd counts and steps",
          "[device][oclgrind]") {
  Random random(5);
  const auto positions = [&](int count) {
    std::vector<std::pair<float, float>> result;
    for (int k = 0; k < count; ++k)
      result.emplace_back(static_cast<float>(random(0, 100)), static_cast<float>(random(0, 80)));
    return edges_at(result);
  };
  const StereoEdges earlier = positions(253), current = positions(401);
  auto rows = random_descriptors(85, 6), columns = random_descriptors(201, 7);
  // A third of the rows are repeated among the columns.
  for (std::size_t k = 0; k < 85; k += 3)
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(k * kWideBytes), kWideBytes,
                columns.begin() + static_cast<std::ptrdiff_t>(2 * k * kWideBytes));
  const auto matches = match_everywhere({earlier, 3, rows}, {current, 2, columns});
  CHECK(matches.size() >= 5);
  for (std::size_t m = 0; m < matches.size(); ++m) {
    CHECK(matches.previous[m] % 3 == 0);
    CHECK(matches.current[m] % 2 == 0);
  }
  CHECK(match_everywhere({positions(0), 1, {}}, {current, 2, columns}).size() == 0);
  CHECK(match_everywhere({earlier, 3, rows}, {positions(0), 1, {}}).size() == 0);
}
