#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "common/point_index.hpp"
#include "matching.hpp"

using namespace quadedge;

TEST_CASE("point index: cells of 8 x 4 px in rows, then the number; what lies outside counts to the border",
          "[temporal][matching]") {
  //                             0     1      2      3      4    5     6
  const std::vector<float> xs = {17, 7.9f, 8.1f, 2.25f, 100, -30, 3}, ys = {2.1f, 3.9f, 4.2f, 0.2f, 9, -3, 4};
  PointIndex index;
  make_point_index(xs, ys, 20, 7, index);
  CHECK(index.columns == 3);
  CHECK(index.rows == 2);
  CHECK(index.order == std::vector<std::int32_t>{1, 3, 5, 0, 6, 2, 4});
  CHECK(index.cell_first == std::vector<std::int32_t>{0, 3, 3, 4, 5, 6, 7});
  make_point_index({}, {}, 9, 3, index);
  CHECK(index.order.empty());
  CHECK(index.cell_first == std::vector<std::int32_t>(3, 0));
}

TEST_CASE("point index: a square holds every point within its radius, also beyond the border", "[temporal][matching]") {
  matching::Random random(4);
  std::vector<float> xs, ys;
  for (int k = 0; k < 500; ++k) {
    xs.push_back(static_cast<float>(random(-5, 85)));
    ys.push_back(static_cast<float>(random(-5, 35)));
  }
  PointIndex index;
  make_point_index(xs, ys, 80, 30, index);
  auto sorted = index.order;
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::int32_t> all(500);
  std::iota(all.begin(), all.end(), 0);
  CHECK(sorted == all);
  for (int k = 0; k < 200; ++k) {
    const auto x = static_cast<float>(random(-20, 100)), y = static_cast<float>(random(-20, 50)),
               radius = static_cast<float>(random(0, 12));
    std::set<std::int32_t> visited;
    index.visit_square(x, y, radius, [&](std::int32_t number) { CHECK(visited.insert(number).second); });
    for (std::int32_t i = 0; i < 500; ++i) {
      const auto p = static_cast<std::size_t>(i);
      if (std::hypot(xs[p] - x, ys[p] - y) <= radius) CHECK(visited.count(i) == 1);
    }
  }
}
