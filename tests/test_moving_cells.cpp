#include "generated_quads.hpp"
#include "motion/motion_evidence.hpp"
#include "motion/moving_cells.hpp"

using namespace quadedge::odometry;

namespace {

constexpr double kSide = 32;

/// A view of 20 x 10 cells in each of which 12 of 20 edges follow the motion.
ExplainedCells view() {
  quadedge::PinholeCamera camera{400, 400, 320, 160, 639, 319};
  ExplainedCells cells;
  cells.start(camera, kSide);
  REQUIRE(cells.all().size() == 20 * 10);
  for (ExplainedCell& cell : cells.all()) cell = {20, 14, 12};
  return cells;
}

ExplainedCell& at(ExplainedCells& cells, int column, int row) {
  return cells.all()[static_cast<std::size_t>(row * 20 + column)];
}

}  // namespace

TEST_CASE("moving cells: the box is that of the largest group of adjacent cells") {
  ExplainedCells cells = view();
  for (int column = 5; column < 8; ++column) at(cells, column, 4) = {20, 10, 1};
  at(cells, 8, 5) = {20, 10, 1};  // touches the group at a corner
  at(cells, 17, 1) = {20, 10, 1};
  const MovingCells moving = find_moving_cells(cells);
  CHECK(moving.count == 5);
  CHECK(moving.largest.min() == Eigen::Vector2d(5 * kSide, 4 * kSide));
  CHECK(moving.largest.max() == Eigen::Vector2d(9 * kSide, 6 * kSide));
  CHECK(find_moving_cells(view()).largest.isEmpty());
}
