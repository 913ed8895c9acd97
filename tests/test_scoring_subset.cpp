#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "motion/sampling_order.hpp"

using namespace quadedge::pose;

namespace {

/// Quads, of which `counts[c]` lie in the c-th cell of 32 px in a row.
ScoringArrays in_cells(const std::vector<int>& counts) {
  ScoringArrays quads;
  for (std::size_t c = 0; c < counts.size(); ++c)
    for (int i = 0; i < counts[c]; ++i) {
      quads.left_x.push_back(32.0f * static_cast<float>(c) + 1 + 0.1f * static_cast<float>(i));
      quads.left_y.push_back(5);
    }
  quads.ray_x.resize(quads.left_x.size());
  return quads;
}

}  // namespace

TEST_CASE("A balanced subset takes at most the median number of quads from each cell", "[pose][scoring_subset]") {
  const auto quads = in_cells({200, 10, 3, 12, 0, 150});
  std::mt19937_64 random(1);
  SubsetWorkspace workspace;
  std::vector<std::int32_t> rows;
  balanced_subset(random, quads, 32, 4096, workspace, rows);
  CHECK(std::set<std::int32_t>(rows.begin(), rows.end()).size() == rows.size());
  std::vector<int> found(6);
  for (std::int32_t row : rows) ++found[static_cast<std::size_t>(quads.left_x[static_cast<std::size_t>(row)] / 32)];
  CHECK(found == std::vector<int>{12, 10, 3, 12, 0, 12});
  balanced_subset(random, quads, 32, 20, workspace, rows);
  CHECK(rows.size() == 20);
  balanced_subset(random, {}, 32, 20, workspace, rows);
  CHECK(rows.empty());
}

TEST_CASE("A random subset holds distinct rows, or all rows if there are no more", "[pose][scoring_subset]") {
  std::mt19937_64 random(2);
  std::vector<std::int32_t> rows;
  random_subset(random, 1000, 100, rows);
  CHECK(rows.size() == 100);
  CHECK(std::set<std::int32_t>(rows.begin(), rows.end()).size() == 100);
  CHECK(*std::max_element(rows.begin(), rows.end()) > 900);
  random_subset(random, 5, 100, rows);
  std::sort(rows.begin(), rows.end());
  CHECK(rows == std::vector<std::int32_t>{0, 1, 2, 3, 4});
}
