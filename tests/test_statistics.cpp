#include <catch2/catch.hpp>
#include <cmath>

#include "report/matching_json.hpp"
#include "report/statistics.hpp"

using namespace quadedge;
using namespace quadedge::report;

TEST_CASE("Rank correlation", "[report]") {
  CHECK(rank_correlation({1, 2, 3, 4}, {10, 20, 25, 1000}) == Approx(1));
  CHECK(rank_correlation({1, 2, 3, 4}, {9, 7, 5, -100}) == Approx(-1));
  // Ranks 1, 2.5, 2.5, 4, 5 and 3, 1.5, 4, 1.5, 5; minus the mean of 3: products 0 + 0.75 - 0.5 - 1.5 + 4, squares 9.5
  // and 9.5.
  CHECK(rank_correlation({1, 2, 2, 5, 7}, {3, 1, 4, 1, 5}) == Approx(2.75 / 9.5));
  CHECK(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3})));
  CHECK(std::isnan(rank_correlation({1, 2}, {1, 2})));
}

TEST_CASE("A precision that rises as the error falls has a rank correlation of minus one", "[report]") {
  evaluation::MatchingResult result;
  result.frames.resize(6);
  for (int f = 1; f < 6; ++f) {
    auto& pairs = result.frames[static_cast<std::size_t>(f)].temporal.emplace().pairs;
    for (std::size_t order = 0; order < evaluation::kConstraintNames.size(); ++order) {
      pairs.table[order] = {1000, 500 + 10 * f};
      pairs.accuracy[order] = {1.0 / f, 0.01 / f};
    }
  }
  const auto correlation = motion_correlation({result});
  CHECK(correlation.points == 5 * 7);
  CHECK(correlation.rotation == Approx(-1));
  CHECK(correlation.translation == Approx(-1));
  CHECK(motion_correlation({}).points == 0);
}
