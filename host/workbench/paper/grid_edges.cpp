/// \file grid_edges.cpp  Derivatives at half pixels by filters of two phases; parabolas through gradient maxima.
#include "paper/grid_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tbb/parallel_for.h>
#include <tuple>

#include "common/numeric.hpp"
#include "quadedge/error.hpp"

namespace quadedge::paper {
namespace {

using Taps = std::array<double, 5>;  // of one pixel, by the order of the derivative

/// The image with a replicated border, and the filters of the two phases of the grid. Cell X of either axis lies at X /
/// 2 px; half-pixel phases come from shifted kernels, not from interpolated images.
class Grid {
 public:
  Grid(const ImageView& image, double sigma)
      : width_(image.width), height_(image.height), border_(kernel_radius(sigma) + 1), stride_(width_ + 2 * border_) {
    for (int half = 0; half < 2; ++half)
      for (int k = -kernel_radius(sigma); k <= kernel_radius(sigma) + half; ++k)
        taps_[static_cast<std::size_t>(half)].push_back(gaussian_derivatives(0.5 * half - k, sigma));
    pixels_.reserve(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(height_ + 2 * border_));
    for (int y = -border_; y < height_ + border_; ++y)
      for (int x = -border_; x < width_ + border_; ++x)
        pixels_.push_back(static_cast<double>(image.at(std::clamp(x, 0, width_ - 1), std::clamp(y, 0, height_ - 1))));
  }

  reference::GradientField gradient() const {
    reference::GradientField field;
    field.width = 2 * width_;
    field.height = 2 * height_;
    field.ix.resize(static_cast<std::size_t>(field.width) * static_cast<std::size_t>(field.height));
    field.iy.resize(field.ix.size());
    tbb::parallel_for(0, field.height, [&](int row) {
      const std::vector<Taps>& down = taps_of(row);
      std::vector<double> smoothed(static_cast<std::size_t>(stride_), 0.0), sloped(smoothed);
      for (std::size_t k = 0; k < down.size(); ++k) {
        const double* line = pixel(-border_, row / 2 - radius() + static_cast<int>(k));
        for (std::size_t x = 0; x < smoothed.size(); ++x) {
          smoothed[x] += down[k][0] * line[x];
          sloped[x] += down[k][1] * line[x];
        }
      }
      for (int column = 0; column < field.width; ++column) {
        const std::vector<Taps>& along = taps_of(column);
        const auto first = static_cast<std::size_t>(column / 2 - radius() + border_);
        double ix = 0, iy = 0;
        for (std::size_t k = 0; k < along.size(); ++k) {
          ix += along[k][1] * smoothed[first + k];
          iy += along[k][0] * sloped[first + k];
        }
        field.ix[field.index(column, row)] = ix;
        field.iy[field.index(column, row)] = iy;
      }
    });
    return field;
  }

  /// First to third derivatives at a cell; the fourth are not computed.
  reference::Derivatives derivatives(int column, int row) const {
    const std::vector<Taps>&down = taps_of(row), &along = taps_of(column);
    reference::Derivatives d{};
    for (std::size_t i = 0; i < down.size(); ++i) {
      const double* line = pixel(column / 2 - radius(), row / 2 - radius() + static_cast<int>(i));
      std::array<double, 4> sums{};
      for (std::size_t k = 0; k < along.size(); ++k)
        for (std::size_t order = 0; order < sums.size(); ++order) sums[order] += along[k][order] * line[k];
      const Taps& g = down[i];
      d.ix += g[0] * sums[1];
      d.iy += g[1] * sums[0];
      d.ixx += g[0] * sums[2];
      d.ixy += g[1] * sums[1];
      d.iyy += g[2] * sums[0];
      d.ixxx += g[0] * sums[3];
      d.ixxy += g[1] * sums[2];
      d.ixyy += g[2] * sums[1];
      d.iyyy += g[3] * sums[0];
    }
    return d;
  }

 private:
  int radius() const { return border_ - 1; }
  const std::vector<Taps>& taps_of(int cell) const { return taps_[static_cast<std::size_t>(cell % 2)]; }
  const double* pixel(int x, int y) const {
    return pixels_.data() + static_cast<std::ptrdiff_t>(y + border_) * stride_ + x + border_;
  }

  int width_, height_, border_, stride_;
  std::array<std::vector<Taps>, 2> taps_;
  std::vector<double> pixels_;
};

struct GridEdge {
  double x, y, direction, strength, gradient_x, gradient_y;
};

void find_in_row(const Grid& grid, const reference::GradientField& field, int row, const EdgesConfig& config,
                 double threshold, std::vector<GridEdge>& edges) {
  const auto inside = [&](double at, int cells) { return at > config.margin && at < 0.5 * cells - 1 - config.margin; };
  for (int column = 2 * config.margin; column < field.width - 2 * config.margin; ++column) {
    if (!(field.magnitude(column, row) > threshold)) continue;
    const reference::Probe probe = reference::probe_maximum(field, column, row);
    const double m = probe.magnitude, ahead = probe.ahead, behind = probe.behind;
    if (m < ahead || m < behind || (m == ahead && m == behind)) continue;
    const double a = (ahead + behind - 2 * m) / (2 * probe.step * probe.step), b = (ahead - behind) / (2 * probe.step);
    const double shift = -b / (2 * a);  // in cells
    const double x = 0.5 * (column + shift * probe.gx), y = 0.5 * (row + shift * probe.gy);
    if (!inside(x, field.width) || !inside(y, field.height)) continue;
    const std::array<double, 2> f = reference::gradient_of_f(grid.derivatives(column, row));
    const double direction = std::atan2(f[0], -f[1]);
    edges.push_back({x, y, direction > -kPi ? direction : kPi, m + b * shift / 2, probe.gx, probe.gy});
  }
}

}  // namespace

reference::ReferenceEdges grid_edges(const ImageView& image, const EdgesConfig& config, double threshold) {
  if (image.empty()) throw UsageError("edge detection needs an image of at least 1 x 1 pixels");
  const Grid grid(image, config.sigma);
  const reference::GradientField field = grid.gradient();
  std::vector<std::vector<GridEdge>> rows(static_cast<std::size_t>(field.height));
  tbb::parallel_for(2 * config.margin, std::max(2 * config.margin, field.height - 2 * config.margin), [&](int row) {
    find_in_row(grid, field, row, config, threshold, rows[static_cast<std::size_t>(row)]);
  });
  std::vector<GridEdge> all;
  for (const auto& row : rows) all.insert(all.end(), row.begin(), row.end());
  std::stable_sort(all.begin(), all.end(), [](const GridEdge& p, const GridEdge& q) {
    return std::tuple(std::lround(p.y), p.x) < std::tuple(std::lround(q.y), q.x);
  });
  reference::ReferenceEdges edges;
  for (const GridEdge& edge : all) {
    edges.x.push_back(edge.x);
    edges.y.push_back(edge.y);
    edges.direction.push_back(edge.direction);
    edges.strength.push_back(edge.strength);
    edges.scale_shift.push_back(0);
    edges.gradient_x.push_back(edge.gradient_x);
    edges.gradient_y.push_back(edge.gradient_y);
    edges.peak_x.push_back(edge.x);
    edges.peak_y.push_back(edge.y);
    edges.column.push_back(static_cast<std::int32_t>(std::lround(edge.x)));
    edges.row.push_back(static_cast<std::int32_t>(std::lround(edge.y)));
  }
  for (int row = 0; row <= image.height; ++row)
    edges.row_first.push_back(
        static_cast<std::int32_t>(std::lower_bound(edges.row.begin(), edges.row.end(), row) - edges.row.begin()));
  return edges;
}

}  // namespace quadedge::paper
