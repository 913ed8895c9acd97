#include "edge_images.hpp"
#include "edge_structure.hpp"
#include "reference/edge_detection.hpp"

using namespace quadedge;
using reference::ReferenceEdges;

namespace {

/// Blur of the rendered edges in the detector: its Gaussian and the box of the pixel's area.
double effective_sigma(const EdgesConfig& config) { return std::sqrt(config.sigma * config.sigma + 1.0 / 12.0); }

double angle_error(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); }

}  // namespace

TEST_CASE("edges: a straight edge of any direction is located to 0.004 px and 0.08 degrees (rms)") {
  const EdgesConfig config;
  const double truth_strength = 120.0 / (std::sqrt(2.0 * kPi) * effective_sigma(config));
  double squares = 0, square_distances = 0;
  std::size_t count = 0;
  for (int k = 0; k < 24; ++k) {
    const double angle = (15.0 * k + 3.7) * kDegree, px = 31.5 + 0.37 * std::sin(3.0 * k),
                 py = 32.1 + 0.41 * std::cos(5.0 * k);
    const Image image = render_half_plane(64, 64, px, py, angle);
    const ReferenceEdges edges = ::detect_edges(image.view(), config);
    check_structure(edges, 64, 64, config);
    INFO("angle " << angle / kDegree);
    REQUIRE(edges.size() > 40);
    count += edges.size();
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double distance = (edges.x[i] - px) * std::cos(angle) + (edges.y[i] - py) * std::sin(angle);
      REQUIRE(std::abs(distance) < 0.02);
      square_distances += distance * distance;
      // The tangent is the brightness gradient turned by -90 degrees.
      // Rounding to 8 bits costs most where the edge is nearly upright and whole columns are rounded the same.
      const double error = angle_error(edges.direction[i], angle - 0.5 * kPi);
      REQUIRE(error < 0.4 * kDegree);
      squares += error * error;
      // The parabola over the interpolated ring may miss the peak by about one percent.
      REQUIRE(edges.strength[i] == Approx(truth_strength).epsilon(0.015));
    }
  }
  CHECK(std::sqrt(square_distances / static_cast<double>(count)) < 0.004);
  CHECK(std::sqrt(squares / static_cast<double>(count)) < 0.08 * kDegree);
}

TEST_CASE("edges: a circle is found sigma^2 / 2r inside its true position, with tangents along it") {
  for (const double radius : {20.0, 30.0, 50.0}) {
    for (const bool bright_inside : {true, false}) {
      const double cx = 64.27, cy = 63.81;
      const Image image = render_shape(128, 128, bright_inside ? 80 : 200, bright_inside ? 200 : 80,
                                       [=](double x, double y) { return std::hypot(x - cx, y - cy) < radius; });
      const EdgesConfig config;
      const ReferenceEdges edges = ::detect_edges(image.view(), config);
      check_structure(edges, 128, 128, config);
      REQUIRE(static_cast<double>(edges.size()) > 2.0 * kPi * radius);
      double bias = 0;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        const double dx = edges.x[i] - cx, dy = edges.y[i] - cy;
        bias += std::hypot(dx, dy) - radius;
        const double towards_bright = std::atan2(dy, dx) + (bright_inside ? kPi : 0.0);
        REQUIRE(angle_error(edges.direction[i], towards_bright - 0.5 * kPi) < 0.5 * kDegree);
      }
      bias /= static_cast<double>(edges.size());
      const double sigma = effective_sigma(config);
      // Smoothing a curved edge moves its steepest position towards the centre of curvature, to first order by sigma^2
      // / 2r.
      CHECK(bias == Approx(-sigma * sigma / (2.0 * radius)).margin(0.003));
    }
  }
}

TEST_CASE("edges: the scale-space shift predicts where a larger scale finds the edges of a disc and of thin bars") {
  const double cx = 64.27, cy = 63.81;
  const auto disc = [=](double x, double y) { return std::hypot(x - cx, y - cy) < 20.0; };
  const auto bar = [=](double x, double y) { return std::abs(0.8 * (x - cx) + 0.6 * (y - cy)) < 1.5; };
  const auto thread = [=](double x, double y) { return std::abs(0.6 * (x - cx) - 0.8 * (y - cy)) < 0.6; };
  for (const std::function<bool(double, double)>& inside :
       {std::function<bool(double, double)>(disc), std::function<bool(double, double)>(bar),
        std::function<bool(double, double)>(thread)}) {
    const Image image = render_shape(128, 128, 20, 220, inside);
    EdgesConfig smaller, config, larger;
    smaller.sigma = 1.95;
    larger.sigma = 2.05;
    const auto across = [&](const ReferenceEdges& edges, std::size_t i, double x, double y) {
      return (edges.y[i] - y) * std::cos(edges.direction[i]) - (edges.x[i] - x) * std::sin(edges.direction[i]);
    };
    const ReferenceEdges edges = ::detect_edges(image.view(), config);
    const ReferenceEdges before = ::detect_edges(image.view(), smaller), after = ::detect_edges(image.view(), larger);
    // Distance from edge `i` across it to the nearest edge of another scale.
    const auto to = [&](const ReferenceEdges& others, std::size_t i) {
      std::size_t nearest = 0;
      const auto squared = [&](std::size_t k) {
        return std::pow(others.x[k] - edges.x[i], 2) + std::pow(others.y[k] - edges.y[i], 2);
      };
      for (std::size_t k = 0; k < others.size(); ++k)
        if (squared(k) < squared(nearest)) nearest = k;
      return across(others, nearest, edges.x[i], edges.y[i]);
    };
    double drift = 0, moved = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (std::abs(edges.x[i] - cx) > 30 || std::abs(edges.y[i] - cy) > 30) continue;  // ends of the bars
      drift += edges.scale_shift[i];
      moved += (to(after, i) - to(before, i)) / std::log(2.05 / 1.95);
      ++count;
    }
    REQUIRE(count > 60);
    drift /= static_cast<double>(count);
    moved /= static_cast<double>(count);
    REQUIRE(std::abs(moved) > 0.15);
    // Derivatives are taken at the peak of the parabola, which thin bars displace by a tenth of a pixel.
    CHECK(drift == Approx(moved).epsilon(0.2));
  }
}

TEST_CASE("edges: the Newton step onto F = 0 improves the position of straight edges") {
  EdgesConfig with, without;
  without.newton_max = 0;
  double squares_with = 0, squares_without = 0;
  for (int k = 0; k < 12; ++k) {
    const double angle = (30.0 * k + 11.0) * kDegree;
    const Image image = render_half_plane(64, 64, 31.6, 32.3, angle);
    const auto squares = [&](const EdgesConfig& config) {
      const ReferenceEdges edges = ::detect_edges(image.view(), config);
      double sum = 0;
      for (std::size_t i = 0; i < edges.size(); ++i) {
        sum += std::pow((edges.x[i] - 31.6) * std::cos(angle) + (edges.y[i] - 32.3) * std::sin(angle), 2);
      }
      return sum / static_cast<double>(edges.size());
    };
    squares_with += squares(with);
    squares_without += squares(without);
  }
  CHECK(squares_with < 0.25 * squares_without);
}

TEST_CASE("edges: a threshold of 2 accepts a contrast of 11 grey levels and rejects one of 9") {
  // Peak gradient of a step of height D: D / (sqrt(2 pi) sigma) = 0.2 D within a percent.
  const auto count = [](double contrast) {
    return ::detect_edges(render_half_plane(64, 64, 31.5, 31.5, 0.0, 100, 100 + contrast).view(), {}).size();
  };
  CHECK(count(9) == 0);
  CHECK(count(11) > 25);
}

TEST_CASE("edges: other scales detect the same straight edge with the expected strength") {
  for (const double sigma : {1.0, 1.5, 3.0}) {
    EdgesConfig config;
    config.sigma = sigma;
    config.margin = 14;
    const Image image = render_half_plane(64, 64, 31.7, 31.2, 25.0 * kDegree);
    const ReferenceEdges edges = ::detect_edges(image.view(), config);
    REQUIRE(edges.size() > 30);
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double distance =
          (edges.x[i] - 31.7) * std::cos(25.0 * kDegree) + (edges.y[i] - 31.2) * std::sin(25.0 * kDegree);
      REQUIRE(std::abs(distance) < 0.02);
      REQUIRE(edges.strength[i] == Approx(120.0 / (std::sqrt(2.0 * kPi) * effective_sigma(config))).epsilon(0.05));
    }
  }
}

TEST_CASE("edges: on straight edges, directions at the pixel agree with those at the sub-pixel point") {
  const Image image = render_half_plane(64, 64, 31.4, 32.2, 37.0 * kDegree);
  EdgesConfig at_pixel;
  at_pixel.direction_at = "pixel";
  const ReferenceEdges edges = ::detect_edges(image.view(), at_pixel);
  REQUIRE(edges.size() > 40);
  for (const double direction : edges.direction)
    REQUIRE(angle_error(direction, (37.0 - 90.0) * kDegree) < 0.2 * kDegree);
  // Published edge maps use the peak of the parabola, without the Newton step.
  EdgesConfig parabola;
  parabola.newton_max = 0;
  CHECK(edges.x == ::detect_edges(image.view(), parabola).x);
}
