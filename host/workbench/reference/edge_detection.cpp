/// \file edge_detection.cpp  Threshold from histograms, gradient maxima, Newton step onto F = 0; selection by rows.
#include "reference/edge_detection.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

#include "common/filter_limits.hpp"
#include "common/images.hpp"
#include "common/layouts.hpp"
#include "common/numeric.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

namespace quadedge::reference {
namespace {

constexpr double kBinsPerOctave = 8;
constexpr double kLowestExponent = -12;  // of the gradient that bin 1 begins with

/// Between powers of two the bins have equal width, as floats do.
double gradient_bin_start(int bin) {
  const int octave = (bin - 1) / 8, eighth = (bin - 1) % 8;
  return bin == 0 ? 0.0 : std::ldexp(1.0 + eighth / kBinsPerOctave, octave + static_cast<int>(kLowestExponent));
}

int gradient_bin(double magnitude) {
  int bin = 0;
  while (bin + 1 < kGradientBins && magnitude >= gradient_bin_start(bin + 1)) ++bin;
  return bin;
}

/// Integers below 16 have one bin each, larger ones eight bins per octave.
int noise_bin_start(int bin) { return bin < 16 ? bin : (8 + bin % 8) << (bin / 8 - 1); }

int noise_bin(int response) {
  int bin = 0;
  while (bin + 1 < kNoiseBins && response >= noise_bin_start(bin + 1)) ++bin;
  return bin;
}

double grey_at(const ImageView& image, int x, int y) {
  return static_cast<double>(image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1)));
}

bool is_saturated(double grey) { return grey <= 0 || grey >= kMaxGrey; }

double gradient_magnitude(const ImageView& image, int x, int y, double sigma) {
  const int radius = kernel_radius(sigma);
  double gx = 0, gy = 0;
  for (int dy = -radius; dy <= radius; ++dy) {
    const auto along_y = gaussian_derivatives(-dy, sigma);
    for (int dx = -radius; dx <= radius; ++dx) {
      const auto along_x = gaussian_derivatives(-dx, sigma);
      const double grey = grey_at(image, x + dx, y + dy);
      gx += along_x[1] * along_y[0] * grey;
      gy += along_x[0] * along_y[1] * grey;
    }
  }
  return std::hypot(gx, gy);
}

/// Magnitude of [1 -2 1] along both axes, in steps of the image's values; -1 where a pixel is saturated.
int noise_response(const ImageView& image, int x, int y) {
  constexpr int kWeights[3] = {1, -2, 1};
  double sum = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double grey = grey_at(image, x + dx, y + dy);
      if (is_saturated(grey)) return -1;
      sum += kWeights[dy + 1] * kWeights[dx + 1] * grey;
    }
  }
  return static_cast<int>(std::lround(std::abs(sum) * image.max_value / kMaxGrey));
}

template <std::size_t N>
double sum_of(const std::array<std::int64_t, N>& tally) {
  return static_cast<double>(std::accumulate(tally.begin(), tally.end(), std::int64_t{0}));
}

/// Taps of one derivative order, for the pixels i - radius .. i + radius around pixel i.
std::vector<double> taps_of(double sigma, std::size_t order) {
  const int radius = kernel_radius(sigma);
  std::vector<double> taps;
  for (int k = -radius; k <= radius; ++k) taps.push_back(gaussian_derivatives(-k, sigma)[order]);
  return taps;
}

int clamp_index(int i, int size) { return std::clamp(i, 0, size - 1); }

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
double scale_shift(const Derivatives& d, const std::array<double, 2>& gradient_f, double sigma) {
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

// What follows selects edges in single precision, so that the device makes the same decisions.
constexpr float kHalfAnOctave = 0.70710678F;

/// Directions of gradients are quantised by direction_code() of kernels/edge_detection.cl.
constexpr float kCodes = 255.5F;
float code_of(float ratio) { return std::rint((ratio + 1.0F) * kCodes); }

/// See kernels/edge_selection.cl.
struct Crossing {
  float row = 0, step = 0, sine = 0;
};

Crossing crossing(const SelectionArguments& arguments, const GradientMaxima& maxima, std::size_t i) {
  const float x = maxima.x[i], y = maxima.y[i], gx = maxima.gradient_x[i], gy = maxima.gradient_y[i];
  const bool steep = std::abs(gx) >= std::abs(gy);
  const float ratio = steep ? gy / gx : gx / gy;
  const float tangent_x = steep ? -ratio : 1.0F, tangent_y = steep ? 1.0F : -ratio;
  const EpipolarRows& rows = arguments.rows;
  const float depth = rows.forward_x * x + rows.forward_y * y + rows.forward_1;
  Crossing result;
  const float plane = (rows.across_x * x + rows.across_y * y + rows.across_1) / depth;
  const float bend_x = rows.bend_xx * x + rows.bend_xy * y, bend_y = rows.bend_yy * y;
  result.row = plane - (bend_x * x + bend_y * y);
  const float by_x = (rows.across_x - plane * rows.forward_x) / depth - (bend_x + rows.bend_xx * x),
              by_y = (rows.across_y - plane * rows.forward_y) / depth - (2.0F * bend_y + rows.bend_xy * x);
  const float rise = std::abs(tangent_x * by_x + tangent_y * by_y);
  result.step = rise;
  result.sine = rise / std::sqrt((1.0F + ratio * ratio) * (by_x * by_x + by_y * by_y));
  return result;
}

float density_of(float sine) {
  float density = 1.0F;
  while (sine < kHalfAnOctave * density && density > 0.0625F) density *= 0.5F;
  return density;
}

bool meets(const Crossing& at, float spacing, float width) {
  const float distance = at.row - spacing * std::rint(at.row / spacing), reach = 0.5F * width * at.step;
  return distance >= -reach && distance < reach;
}

/// From a sample of the rows.
double weight_of_all(const SelectionArguments& arguments, const GradientMaxima& maxima) {
  double sum = 0;
  for (std::size_t i = 0; i < maxima.x.size(); ++i) {
    if (maxima.row[i] % kSelectionSample != 0) continue;
    const Crossing at = crossing(arguments, maxima, i);
    if (at.sine >= arguments.min_sine)
      sum += kSelectionSample *
             static_cast<double>(std::rint(static_cast<float>(kSelectionUnit) * at.step / density_of(at.sine)));
  }
  return sum;
}

}  // namespace

void ContrastTally::add(const ImageView& image, double sigma) {
  const int columns = image.width / kThresholdStep, rows = image.height / kThresholdStep;
  for (int row = 0; row < rows; ++row) {
    const int y = row * kThresholdStep + kThresholdStep / 2;
    for (int column = 0; column < columns; ++column) {
      const int x = column * kThresholdStep + kThresholdStep / 2;
      if (is_saturated(grey_at(image, x, y))) continue;
      ++gradients[static_cast<std::size_t>(gradient_bin(gradient_magnitude(image, x, y, sigma)))];
    }
    for (int x = 1; x < std::min(columns * kThresholdStep, image.width - 1); ++x) {
      const int response = noise_response(image, x, y);
      if (response >= 0) ++responses[static_cast<std::size_t>(noise_bin(response))];
    }
  }
}

double ContrastTally::gradient_exceeded_by(double ratio) const {
  const double wanted = ratio * sum_of(gradients);
  double above = 0;
  for (int bin = kGradientBins - 1; bin >= 0; --bin) {
    const auto here = static_cast<double>(gradients[static_cast<std::size_t>(bin)]);
    const double start = gradient_bin_start(bin), end = gradient_bin_start(bin + 1);
    if (here > 0 && above + here >= wanted) return end - (end - start) * (wanted - above) / here;
    above += here;
  }
  return 0;
}

double ContrastTally::noise() const {
  const double half = 0.5 * sum_of(responses);
  double below = 0;
  for (int bin = 0; bin < kNoiseBins; ++bin) {
    const auto here = static_cast<double>(responses[static_cast<std::size_t>(bin)]);
    // An integer represents half a step to either side.
    const double start = std::max(noise_bin_start(bin) - 0.5, 0.0), end = noise_bin_start(bin + 1) - 0.5;
    if (here > 0 && below + here >= half)
      return (start + (end - start) * (half - below) / here) / static_cast<double>(kNoiseMedian);
    below += here;
  }
  return 0;
}

double EdgeThreshold::next(const std::vector<ImageView>& images, std::optional<double> known_noise) {
  if (config_.threshold > 0) return config_.threshold;
  ContrastTally tally;
  for (const ImageView& image : images) tally.add(image, config_.sigma);
  const double step = kMaxGrey / images.front().max_value;  // [grey levels]
  noise_ = known_noise ? *known_noise : step * tally.noise();
  const ThresholdLimits limits = threshold_limits(config_);
  gradient_ = sum_of(tally.gradients) > 0 ? tally.gradient_exceeded_by(kThresholdArea) : kThresholdMax;
  const double contrast = gradient_ * gradient_ / kThresholdMax;
  const double measured =
      std::min(std::max({contrast, limits.per_noise * noise_, limits.per_step * step}), kThresholdMax);
  const double hold = kThresholdHold;
  const bool held = threshold_ <= hold * measured && measured <= hold * threshold_;
  if (!held) threshold_ = measured;
  return threshold_;
}

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
      edges.scale_shift.push_back(scale_shift(d, f, config.sigma));
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
          to_float(edges.strength), to_float(edges.scale_shift), edges.row_first};
}

EdgeSet first_edges(const ReferenceEdges& all, int most, int& dropped) {
  EdgeSet edges = to_edge_set(all);
  const auto limit = static_cast<std::size_t>(most);
  if (edges.size() > limit) {
    dropped += static_cast<int>(edges.size() - limit);
    for (auto* values : {&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_shift})
      values->resize(limit);
    for (auto& first : edges.row_first) first = std::min(first, static_cast<std::int32_t>(limit));
  }
  return edges;
}

GradientMaxima maxima_of(const ReferenceEdges& edges) {
  GradientMaxima maxima;
  maxima.row = edges.row;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    maxima.x.push_back(static_cast<float>(edges.peak_x[i]));
    maxima.y.push_back(static_cast<float>(edges.peak_y[i]));
    const double gx = edges.gradient_x[i], gy = edges.gradient_y[i];
    const bool steep = std::abs(gx) >= std::abs(gy);
    const float ratio = code_of(static_cast<float>(steep ? gy / gx : gx / gy)) / kCodes - 1.0F;
    maxima.gradient_x.push_back(steep ? 1.0F : ratio);
    maxima.gradient_y.push_back(steep ? ratio : 1.0F);
  }
  return maxima;
}

float selection_spacing(const SelectionArguments& left_arguments, const GradientMaxima& left,
                        const SelectionArguments& right_arguments, const GradientMaxima& right,
                        const EdgesConfig& config) {
  const double most = std::max(weight_of_all(left_arguments, left), weight_of_all(right_arguments, right));
  const float even = static_cast<float>(most) / (float{kSelectionUnit} * static_cast<float>(config.budget));
  const float wanted = std::max(std::min(even, static_cast<float>(config.max_spacing)), even / kDenseBudget);
  return wanted > kClosestSelection ? std::rint(wanted * kSelectionSteps) / kSelectionSteps : 0.0F;
}

std::vector<std::uint8_t> kept_by_selection(const SelectionArguments& arguments, const GradientMaxima& maxima,
                                            float spacing) {
  std::vector<std::uint8_t> kept(maxima.x.size(), 1);
  if (spacing == 0.0F) return kept;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Crossing at = crossing(arguments, maxima, i);
    const bool searched = arguments.slack > 1.0F;
    bool chosen = meets(at, spacing * density_of(at.sine), searched ? kSearchedWidth : 1.0F);
    for (const float sine : {at.sine * arguments.slack, at.sine / arguments.slack})
      chosen = chosen || (searched && meets(at, spacing * density_of(sine), kSearchedWidth));
    kept[i] = at.sine >= arguments.min_sine && chosen ? 1 : 0;
  }
  return kept;
}

ReferenceEdges select_edges(const ReferenceEdges& edges, const std::vector<std::uint8_t>& kept) {
  ReferenceEdges result;
  const auto filter = [&](const auto& values, auto& chosen) {
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] != 0) chosen.push_back(values[i]);
  };
  for (const auto numbers : {&ReferenceEdges::x, &ReferenceEdges::y, &ReferenceEdges::direction,
                             &ReferenceEdges::strength, &ReferenceEdges::scale_shift, &ReferenceEdges::gradient_x,
                             &ReferenceEdges::gradient_y, &ReferenceEdges::peak_x, &ReferenceEdges::peak_y})
    filter(edges.*numbers, result.*numbers);
  filter(edges.column, result.column);
  filter(edges.row, result.row);
  std::int32_t count = 0;
  std::size_t i = 0;
  for (const auto first : edges.row_first) {
    for (; i < static_cast<std::size_t>(first); ++i) count += kept[i];
    result.row_first.push_back(count);
  }
  return result;
}

ReferenceEdges outside_mask(const ReferenceEdges& edges, const PixelMask& mask, int margin) {
  if (mask.empty()) return edges;
  const PixelMask wide = with_border(mask, margin);
  std::vector<std::uint8_t> kept;
  for (std::size_t i = 0; i < edges.size(); ++i)
    kept.push_back(1 - wide.hidden[static_cast<std::size_t>(edges.row[i] * wide.width + edges.column[i])]);
  return select_edges(edges, kept);
}

}  // namespace quadedge::reference
