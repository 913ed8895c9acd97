#include "generated_quads.hpp"
#include "motion/motion_evidence.hpp"
#include "motion/moving_cells.hpp"
#include "motion/odometry_constants.hpp"

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

/// Every second edge of the whole view flickers: weak ones, in cells of few edges, are not found again.
ExplainedCells flickering() {
  ExplainedCells cells = view();
  for (int column = 0; column < 20; column += 2)
    for (int row = 0; row < 10; row += 2) at(cells, column, row) = {static_cast<double>(1 + column % 6), 0, 0};
  return cells;
}

}  // namespace

TEST_CASE("moving cells: weak edges that flicker on all sides do not move") {
  const ExplainedCells cells = flickering();
  CHECK(cells.count(false) == 50);  // a quarter of the image does not follow
  CHECK(find_moving_cells(cells).count == 0);
}

TEST_CASE("moving cells: strong edges that are not where the motion has them move") {
  ExplainedCells cells = flickering();
  // A frame of the scene around a board that is fixed to the camera.
  for (int column = 0; column < 20; ++column)
    for (const int row : {0, 9}) at(cells, column, row) = {18, 9, 2};
  const MovingCells moving = find_moving_cells(cells);
  CHECK(moving.count == 40);
  CHECK(moving.spread > kSurroundingSpread * cells.spread());
}

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

TEST_CASE("moving cells: what counts as motion is measured by the rest of the frame") {
  // 1 of 10 edges agrees: much less than 9 of 10 elsewhere, but not much less than 3 of 10.
  for (const double agreeing : {18.0, 6.0}) {
    ExplainedCells cells = view();
    for (ExplainedCell& cell : cells.all()) cell = {20, agreeing, agreeing};
    at(cells, 3, 3) = {10, 10, 1};
    CHECK(find_moving_cells(cells).count == (agreeing == 18 ? 1 : 0));
  }
  ExplainedCells exact = view();
  for (ExplainedCell& cell : exact.all()) cell = {20, 20, 20};
  at(exact, 3, 3) = {10, 10, 1};
  CHECK(find_moving_cells(exact).count == 1);
  CHECK(find_moving_cells(ExplainedCells()).count == 0);
}
