#include "reference/edge_detection.hpp"

#include <algorithm>
#include <cmath>

#include "common/layouts.hpp"
#include "common/numeric.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge::reference {
namespace {

/// Taps of one derivative order, for the pixels i - radius .. i + radius around pixel i.
std::vector<double> taps_of(double sigma, std::size_t order) {
  const int radius = kernel_radius(sigma);
  std::vector<double> taps;
  for (int k = -radius; k <= radius; ++k) taps.push_back(gaussian_derivatives(-k, sigma)[order]);
  return taps;
}

int clamp_index(int i, int size) { return std::clamp(i, 0, size - 1); }

}  // namespace

double GradientField::magnitude(int column, int row) const {
  const std::size_t i = index(column, row);
  return std::sqrt(ix[i] * ix[i] + iy[i] * iy[i]);
}

GradientField gradient_field(ImageView image, const EdgesConfig& config) {
  if (image.empty()) throw UsageError("edge detection needs an image of at least 1 x 1 pixels");
  GradientField field;
  field.width = image.width;
  field.height = image.height;
  field.ix.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  field.iy.resize(field.ix.size());

  const int radius = kernel_radius(config.sigma);
  const std::vector<double> g = taps_of(config.sigma, 0), dg = taps_of(config.sigma, 1);
  // Along y first: one line of column sums per row, then along x.
  std::vector<double> smoothed(static_cast<std::size_t>(image.width)), sloped(smoothed.size());
  for (int row = 0; row < image.height; ++row) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0, sum_slope = 0;
      for (std::size_t k = 0; k < g.size(); ++k) {
        const double grey = image.at(x, clamp_index(row - radius + static_cast<int>(k), image.height));
        sum += g[k] * grey;
        sum_slope += dg[k] * grey;
      }
      smoothed[static_cast<std::size_t>(x)] = sum;
      sloped[static_cast<std::size_t>(x)] = sum_slope;
    }
    for (int column = 0; column < image.width; ++column) {
      double ix = 0, iy = 0;
      for (std::size_t k = 0; k < g.size(); ++k) {
        const auto x = static_cast<std::size_t>(clamp_index(column - radius + static_cast<int>(k), image.width));
        ix += dg[k] * smoothed[x];
        iy += g[k] * sloped[x];
      }
      field.ix[field.index(column, row)] = ix;
      field.iy[field.index(column, row)] = iy;
    }
  }
  return field;
}

Probe probe_maximum(const GradientField& field, int column, int row) {
  const std::size_t i = field.index(column, row);
  Probe probe;
  probe.magnitude = field.magnitude(column, row);
  probe.gx = field.ix[i] / probe.magnitude;
  probe.gy = field.iy[i] / probe.magnitude;
  const double ax = std::abs(field.ix[i]), ay = std::abs(field.iy[i]);
  const int sx = field.ix[i] > 0 ? 1 : -1, sy = field.iy[i] > 0 ? 1 : -1;
  const int axis_x = ax >= ay ? sx : 0, axis_y = ax >= ay ? 0 : sy;
  const double q = std::min(ax, ay) / std::max(ax, ay);
  const auto interpolate = [&](int sign) {
    return (1.0 - q) * field.magnitude(column + sign * axis_x, row + sign * axis_y) +
           q * field.magnitude(column + sign * sx, row + sign * sy);
  };
  probe.ahead = interpolate(1);
  probe.behind = interpolate(-1);
  probe.step = std::sqrt(1.0 + q * q);
  return probe;
}

Derivatives derivatives_at(ImageView image, double x, double y, double sigma) {
  const int radius = kernel_radius(sigma);
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  const auto grey_at = [&](int column, int row) {
    return static_cast<double>(image.at(clamp_index(column, image.width), clamp_index(row, image.height)));
  };
  const double level = 0.25 * (grey_at(x0, y0) + grey_at(x0 + 1, y0) + grey_at(x0, y0 + 1) + grey_at(x0 + 1, y0 + 1));
  Derivatives d{};
  for (int row = y0 - radius; row <= y0 + radius + 1; ++row) {
    double along_x[5] = {0, 0, 0, 0, 0};
    for (int column = x0 - radius; column <= x0 + radius + 1; ++column) {
      const double grey = grey_at(column, row) - level;
      const std::array<double, 5> taps = gaussian_derivatives(x - column, sigma);
      for (std::size_t order = 0; order < 5; ++order) along_x[order] += taps[order] * grey;
    }
    const std::array<double, 5> taps = gaussian_derivatives(y - row, sigma);
    d.ix += taps[0] * along_x[1];
    d.iy += taps[1] * along_x[0];
    d.ixx += taps[0] * along_x[2];
    d.ixy += taps[1] * along_x[1];
    d.iyy += taps[2] * along_x[0];
    d.ixxx += taps[0] * along_x[3];
    d.ixxy += taps[1] * along_x[2];
    d.ixyy += taps[2] * along_x[1];
    d.iyyy += taps[3] * along_x[0];
    d.ixxxx += taps[0] * along_x[4];
    d.ixxxy += taps[1] * along_x[3];
    d.ixxyy += taps[2] * along_x[2];
    d.ixyyy += taps[3] * along_x[1];
    d.iyyyy += taps[4] * along_x[0];
  }
  return d;
}

std::array<double, 2> gradient_of_f(const Derivatives& d) {
  const double shared = 2.0 * d.ixy * (d.ixx + d.iyy);
  return {2.0 * d.ix * (d.ixx * d.ixx + d.ixy * d.ixy) + d.iy * shared + d.ix * d.ix * d.ixxx +
              2.0 * d.ix * d.iy * d.ixxy + d.iy * d.iy * d.ixyy,
          2.0 * d.iy * (d.iyy * d.iyy + d.ixy * d.ixy) + d.ix * shared + d.ix * d.ix * d.ixxy +
              2.0 * d.ix * d.iy * d.ixyy + d.iy * d.iy * d.iyyy};
}

namespace {

/// Signed step along the gradient onto F = 0 [px], clamped. F falls across an edge towards the bright side; where it
/// does not, there is no edge to step to.
double newton_step(const Derivatives& d, const std::array<double, 2>& gradient_f, double longest) {
  const double f = d.ix * d.ix * d.ixx + 2.0 * d.ix * d.iy * d.ixy + d.iy * d.iy * d.iyy;
  const double m = std::hypot(d.ix, d.iy);
  const double slope = (gradient_f[0] * d.ix + gradient_f[1] * d.iy) / m;
  return slope < 0 ? std::clamp(-f / slope, -longest, longest) : 0.0;
}

/// How far F = 0 moves along the gradient per unit of log(sigma) [px]. The smoothed image obeys the heat equation
/// dI / dlog(sigma) = sigma^2 Laplacian(I), which gives the same of F.
double scale_drift(const Derivatives& d, const std::array<double, 2>& gradient_f, double sigma) {
  const double m = std::hypot(d.ix, d.iy);
  const double slope = (gradient_f[0] * d.ix + gradient_f[1] * d.iy) / m;
  if (!(slope < 0)) return 0.0;
  const double change_x = d.ixxx + d.ixyy, change_y = d.ixxy + d.iyyy;  // of the gradient
  const double by_scale = 2.0 * (d.ix * d.ixx + d.iy * d.ixy) * change_x +
                          2.0 * (d.ix * d.ixy + d.iy * d.iyy) * change_y + d.ix * d.ix * (d.ixxxx + d.ixxyy) +
                          2.0 * d.ix * d.iy * (d.ixxxy + d.ixyyy) + d.iy * d.iy * (d.ixxyy + d.iyyyy);
  // Of F / |grad I|^2, whose changes hardly depend on how near F = 0 they are taken.
  const double f = d.ix * d.ix * d.ixx + 2.0 * d.ix * d.iy * d.ixy + d.iy * d.iy * d.iyy;
  const double shift = by_scale - 2.0 * f * (d.ix * change_x + d.iy * change_y) / (m * m);
  const double fall = slope - 2.0 * f * f / (m * m * m);
  if (!(fall < 0)) return 0.0;
  const auto longest = static_cast<double>(kLongestScaleDrift);
  return std::clamp(-sigma * sigma * shift / fall, -longest, longest);
}

}  // namespace

ReferenceEdges detect_edges(const ImageView& image, const EdgesConfig& config, double threshold) {
  const GradientField field = gradient_field(image, config);
  ReferenceEdges edges;
  for (int row = 0; row < image.height; ++row) {
    edges.row_first.push_back(static_cast<std::int32_t>(edges.size()));
    // Strictly inside the margin: the parabola shifts by at most half a pixel along either axis, the Newton step by
    // newton_max.
    if (row <= config.margin || row >= image.height - 1 - config.margin) continue;
    for (int column = config.margin + 1; column < image.width - 1 - config.margin; ++column) {
      if (!(field.magnitude(column, row) > threshold)) continue;
      const Probe probe = probe_maximum(field, column, row);
      if (!probe.is_maximum()) continue;
      // Parabola through (-step, behind), (0, magnitude), (step, ahead).
      const double a = (probe.ahead + probe.behind - 2.0 * probe.magnitude) / (2.0 * probe.step * probe.step);
      const double b = (probe.ahead - probe.behind) / (2.0 * probe.step);
      const double shift = -b / (2.0 * a);
      const double x = column + shift * probe.gx, y = row + shift * probe.gy;
      const bool at_pixel = config.direction_at == "pixel";
      const Derivatives d =
          at_pixel ? derivatives_at(image, column, row, config.sigma) : derivatives_at(image, x, y, config.sigma);
      const std::array<double, 2> f = gradient_of_f(d);
      const double direction = std::atan2(f[0], -f[1]);
      const double step = at_pixel ? 0.0 : newton_step(d, f, config.newton_max);
      const double m = std::hypot(d.ix, d.iy);
      edges.x.push_back(x + step * d.ix / m);
      edges.y.push_back(y + step * d.iy / m);
      edges.direction.push_back(direction > -kPi ? direction : kPi);
      edges.strength.push_back(m);
      edges.scale_drift.push_back(scale_drift(d, f, config.sigma));
      edges.gradient_x.push_back(probe.gx);
      edges.gradient_y.push_back(probe.gy);
      edges.peak_x.push_back(x);
      edges.peak_y.push_back(y);
      edges.column.push_back(column);
      edges.row.push_back(row);
    }
  }
  edges.row_first.push_back(static_cast<std::int32_t>(edges.size()));
  return edges;
}

EdgeSet to_edge_set(const ReferenceEdges& edges) {
  const auto to_float = [](const std::vector<double>& values) {
    return std::vector<float>(values.begin(), values.end());
  };
  return {to_float(edges.x),        to_float(edges.y),           to_float(edges.direction),
          to_float(edges.strength), to_float(edges.scale_drift), edges.row_first};
}

EdgeSet first_edges(const ReferenceEdges& all, int most, int& dropped) {
  EdgeSet edges = to_edge_set(all);
  const auto limit = static_cast<std::size_t>(most);
  if (edges.size() > limit) {
    dropped += static_cast<int>(edges.size() - limit);
    for (auto* values : {&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_drift})
      values->resize(limit);
    for (auto& first : edges.row_first) first = std::min(first, static_cast<std::int32_t>(limit));
  }
  return edges;
}

}  // namespace quadedge::reference
