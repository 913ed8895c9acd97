/// \file test_paper_matching.cpp  The paper's side patches, refinement, clusters, and closing of the loop.
#include "common/matching_constants.hpp"
#include "edge_images.hpp"
#include "paper/cascades.hpp"

using namespace quadedge;

namespace {

constexpr double kSideOffset = 5;

/// A smooth pattern, moved by (dx, dy) px.
Image wavy_image(int width, int height, double dx, double dy, bool inverted = false) {
  return filled_image(width, height, [=](int x, int y) {
    const double u = x - dx, v = y - dy;
    const double grey = 128 + 50 * std::sin(0.31 * u + 0.12 * v) + 40 * std::sin(0.23 * v - 0.17 * u + 1);
    return static_cast<int>(std::lround(inverted ? 255 - grey : grey));
  });
}

paper::Hypothesis hypothesis_at(double x, double y, double direction_deg, std::int32_t target) {
  return {{x, y}, static_cast<float>(direction_deg * kDegree), target};
}

}  // namespace

TEST_CASE("paper matching: the NCC of a pattern with itself is 1, and -1 where a patch is flat") {
  const Image image = wavy_image(61, 53, 0, 0);
  const paper::Picture picture(image.view());
  const paper::SidePatches patches = paper::cut_sides(picture, {30.3F, 25.7F, 0.6F}, kSideOffset);
  const paper::Pairing same = paper::best_pairing(patches, patches);
  CHECK(same.ncc == Approx(1).epsilon(1e-5));
  CHECK(same.first == same.second);
  // The same place seen as an edge of the opposite direction: the sides are exchanged, and each is turned.
  const paper::SidePatches opposite =
      paper::cut_sides(picture, {30.3F, 25.7F, 0.6F - static_cast<float>(kPi)}, kSideOffset);
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t i = 0; i < 7; ++i)
      for (std::size_t j = 0; j < 7; ++j)
        CHECK(opposite.sides[side][8 * i + j] == Approx(patches.sides[1 - side][8 * (6 - i) + 6 - j]).margin(0.02));
  const paper::SidePatches flat = paper::cut_sides(paper::Picture(Image(40, 40).view()), {20, 20, 0}, kSideOffset);
  CHECK(paper::best_pairing(flat, patches).ncc == -1);
}

TEST_CASE("paper matching: the refinement finds a move along a line and a free one") {
  const paper::Picture before(wavy_image(80, 70, 0, 0).view());
  const paper::RefinementSettings settings{20, 1e-3, false};
  for (const double direction : {0.3, 1.4, -2.2}) {
    const paper::Place edge{40.2F, 35.4F, static_cast<float>(direction)};
    const paper::SidePatches fixed = paper::cut_sides(before, edge, kPaperRefinementOffset);
    for (const std::vector<paper::Pairing>& sides :
         {std::vector<paper::Pairing>{{0, 0, 1}}, std::vector<paper::Pairing>{{1, 1, 1}}, paper::kBothSides}) {
      const paper::Picture right(wavy_image(80, 70, 1.3, 0).view());
      const Eigen::Vector2d line(1, 0);
      const paper::Refined along = paper::refine(fixed, sides, right, edge, line, settings);
      CHECK(along.position.x() == Approx(41.5).margin(0.03));
      CHECK(along.position.y() == Approx(35.4).margin(1e-4));
      CHECK(along.rms < 1);
      const paper::Picture later(wavy_image(80, 70, -0.8, 0.7).view());
      const paper::Refined free = paper::refine(fixed, sides, later, edge, Eigen::Matrix2d::Identity(), settings);
      // Bilinear interpolation errs by up to an eighth of the second derivative, 0.7 of 11 grey levels per pixel.
      CHECK(free.position.x() == Approx(39.4).margin(0.065));
      CHECK(free.position.y() == Approx(36.1).margin(0.065));
    }
  }
}

TEST_CASE("paper matching: a flat image moves nothing, and the border is no obstacle") {
  const paper::SidePatches fixed =
      paper::cut_sides(paper::Picture(wavy_image(60, 60, 0, 0).view()), {30, 30, 0}, kSideOffset);
  const paper::Picture flat(Image(31, 33).view());
  for (const paper::Place& start : {paper::Place{15, 15, 0}, paper::Place{0, 0, 1}, paper::Place{30, 32, 2}}) {
    const paper::Refined found =
        paper::refine(fixed, paper::kBothSides, flat, start, Eigen::Matrix2d::Identity(), {20, 1e-3, true});
    CHECK(found.position.x() == static_cast<double>(start.x));
    CHECK(found.position.y() == static_cast<double>(start.y));
  }
}

TEST_CASE("paper matching: members within a pixel and 20 degrees form a cluster with their centroid") {
  CHECK(paper::clusters_of({}).empty());
  const auto found =
      paper::clusters_of({hypothesis_at(10, 5, 175, 7), hypothesis_at(10.6, 5, -179, 8), hypothesis_at(11.2, 5, 179, 9),
                          hypothesis_at(13, 5, 178, 10), hypothesis_at(10.3, 5, 120, 11)});
  REQUIRE(found.size() == 3);
  CHECK(found[0].members.front() == 8);
  CHECK(std::is_permutation(found[0].members.begin(), found[0].members.end(), std::begin({7, 8, 9})));
  CHECK(found[0].centre.x == Approx(10.6F));
  CHECK(found[0].centre.y == Approx(5));
  CHECK(std::abs(static_cast<double>(found[0].centre.direction)) / kDegree == Approx(178.4).margin(0.3));
  CHECK(found[1].members == std::vector<std::int32_t>{10});
  CHECK(found[2].members == std::vector<std::int32_t>{11});
}

TEST_CASE("paper matching: a loop closes where both images hold the same edge") {
  const auto cluster = [](std::vector<std::int32_t> members) { return paper::Cluster{{}, std::move(members)}; };
  const std::vector<paper::Cluster> left = {cluster({4, 5}), cluster({9})},
                                    right = {cluster({9, 2}), cluster({5}), cluster({7})};
  const auto quads = paper::close_loop(left, right);
  REQUIRE(quads.size() == 2);
  CHECK((quads[0].left == 0 && quads[0].right == 1 && quads[0].edge == 5));
  CHECK((quads[1].left == 1 && quads[1].right == 0 && quads[1].edge == 9));
  CHECK(paper::close_loop({}, right).empty());
}
