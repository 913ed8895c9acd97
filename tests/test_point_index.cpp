#include <catch2/catch.hpp>
#include <numeric>

#include "matching.hpp"
#include "stages/point_index.hpp"

using namespace quadedge;

TEST_CASE("point index: rows of half a pixel, then x, then the number", "[temporal][matching]") {
  //                            0     1     2      3     4      5
  const std::vector<float> xs = {7, 3.5f, 3.5f, 20.25f, 1, 0}, ys = {2.1f, 1.9f, 2.2f, 0.2f, 9, -3};
  const auto index = stages::make_point_index(xs, ys, 4);
  // round(2 y) = 4, 4, 4, 0, 18 -> 7 (last row), -6 -> 0.
  CHECK(index.order == std::vector<std::int32_t>{5, 3, 1, 2, 0, 4});
  CHECK(index.row_first == std::vector<std::int32_t>{0, 2, 2, 2, 2, 5, 5, 5, 6});
}

TEST_CASE("point index: no points make empty rows", "[temporal][matching]") {
  const auto index = stages::make_point_index({}, {}, 3);
  CHECK(index.order.empty());
  CHECK(index.row_first == std::vector<std::int32_t>(7, 0));
}

TEST_CASE("point index: every point once, in its row, ascending in x", "[temporal][matching]") {
  matching::Random random(4);
  std::vector<float> xs, ys;
  for (int k = 0; k < 500; ++k) {
    xs.push_back(static_cast<float>(random(0, 80)));
    ys.push_back(static_cast<float>(random(0, 30)));
  }
  const auto index = stages::make_point_index(xs, ys, 31);
  auto sorted = index.order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> all(500);
  std::iota(all.begin(), all.end(), 0);
  CHECK(sorted == all);
  REQUIRE(index.row_first.size() == 63);
  for (std::size_t row = 0; row < 62; ++row) {
    for (auto k = static_cast<std::size_t>(index.row_first[row]); k < static_cast<std::size_t>(index.row_first[row + 1]); ++k) {
      const auto point = static_cast<std::size_t>(index.order[k]);
      CHECK(std::abs(2 * ys[point] - static_cast<float>(row)) <= 0.5f);
      if (k > static_cast<std::size_t>(index.row_first[row])) CHECK(xs[static_cast<std::size_t>(index.order[k - 1])] <= xs[point]);
    }
  }
}
