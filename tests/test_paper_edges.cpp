/// \file test_paper_edges.cpp  Edges on the published grid of two samples per pixel and axis.
#include "edge_images.hpp"
#include "paper/grid_edges.hpp"

using namespace quadedge;

namespace {

constexpr double kGridThreshold = 2;

double edge_turn(double a, double b) { return std::abs(std::remainder(a - b, 2 * kPi)); }

/// Normal noise of two grey levels.
void add_grey_noise(Image& image, unsigned seed) {
  std::mt19937 random(seed);
  for (auto& pixel : image.pixels) {
    double noise = 0;
    for (int k = 0; k < 12; ++k) noise += static_cast<double>(random()) / 4294967296.0 - 0.5;
    pixel = static_cast<std::uint8_t>(std::clamp(std::lround(pixel + 2 * noise), 0L, 255L));
  }
}

}  // namespace

TEST_CASE("paper edges: a step of any direction is located to 0.02 px with noise, about two edges per pixel") {
  double squares = 0, turns = 0;
  std::size_t count = 0, pixels = 0;
  for (int k = 0; k < 12; ++k) {
    const double angle = (30.0 * k + 3.7) * kDegree, px = 40.5 + 0.37 * std::sin(3.0 * k), py = 40.1;
    Image image = render_half_plane(80, 80, px, py, angle);
    add_grey_noise(image, static_cast<unsigned>(k));
    const reference::ReferenceEdges edges = paper::grid_edges(image.view(), {}, kGridThreshold);
    std::set<std::pair<int, int>> occupied;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double distance = (edges.x[i] - px) * std::cos(angle) + (edges.y[i] - py) * std::sin(angle);
      if (std::abs(distance) > 2) continue;  // noise
      squares += distance * distance;
      turns += std::pow(edge_turn(edges.direction[i], angle - kPi / 2), 2);
      occupied.emplace(edges.column[i], edges.row[i]);
      ++count;
    }
    pixels += occupied.size();
  }
  CHECK(std::sqrt(squares / static_cast<double>(count)) < 0.02);
  CHECK(std::sqrt(turns / static_cast<double>(count)) < 1 * kDegree);
  const double per_pixel = static_cast<double>(count) / static_cast<double>(pixels);
  CHECK(per_pixel > 1.7);
  CHECK(per_pixel < 2.2);
}

TEST_CASE("paper edges: they hold what the detector of every pixel finds, in the order of their pixels") {
  const Image image = textured_image(143, 97);
  EdgesConfig config;
  config.newton_max = 0;
  const reference::ReferenceEdges coarse = reference::detect_edges(image.view(), config, kGridThreshold),
                                  fine = paper::grid_edges(image.view(), config, kGridThreshold);
  CHECK(static_cast<double>(fine.size()) > 1.6 * static_cast<double>(coarse.size()));
  CHECK(static_cast<double>(fine.size()) < 2.4 * static_cast<double>(coarse.size()));
  std::size_t found = 0;
  for (std::size_t i = 0; i < coarse.size(); ++i) {
    for (std::size_t j = 0; j < fine.size(); ++j) {
      const bool near = std::hypot(coarse.x[i] - fine.x[j], coarse.y[i] - fine.y[j]) < 0.5 &&
                        edge_turn(coarse.direction[i], fine.direction[j]) < 10 * kDegree;
      if (!near) continue;
      ++found;
      break;
    }
  }
  CHECK(static_cast<double>(found) > 0.98 * static_cast<double>(coarse.size()));
  REQUIRE(fine.row_first.size() == 98);
  for (int row = 0; row < 97; ++row) {
    for (auto i = fine.row_first[static_cast<std::size_t>(row)]; i < fine.row_first[static_cast<std::size_t>(row) + 1];
         ++i) {
      const auto k = static_cast<std::size_t>(i);
      REQUIRE(std::abs(fine.y[k] - row) <= 0.5);
      REQUIRE((i == fine.row_first[static_cast<std::size_t>(row)] || fine.x[k] >= fine.x[k - 1]));
      REQUIRE((fine.x[k] > config.margin && fine.x[k] < 142 - config.margin));
      REQUIRE((fine.y[k] > config.margin && fine.y[k] < 96 - config.margin));
    }
  }
  CHECK(fine.row_first.back() == static_cast<std::int32_t>(fine.size()));
}
