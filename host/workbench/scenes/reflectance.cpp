/// \file reflectance.cpp  A leaf per cell and size, with smooth borders; cladding averaged exactly over texels.
#include "scenes/reflectance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "quadedge/camera.hpp"
#include "scenes/hash.hpp"

namespace quadedge::synthetic {
namespace {

constexpr double kRamp = 1.5;  // width of a reflectance step [texels]

/// One opaque shape: a convex polygon or an ellipse. Lengths in metres, relative to its centre.
struct Leaf {
  double x, y, radius;
  double grey, grey_x, grey_y;  // value at the centre and its gradient
  int sides;                    // 0: ellipse
  std::array<double, 6> nx, ny, distance;
  double cosine, sine, major, minor;

  double signed_distance(double dx, double dy) const {
    if (sides == 0) {
      const double p = (cosine * dx + sine * dy) / major, q = (cosine * dy - sine * dx) / minor;
      const double k = std::sqrt(p * p + q * q);
      const double slope = std::sqrt(p * p / (major * major) + q * q / (minor * minor));
      return slope > 0.0 ? k * (k - 1.0) / slope : -minor;
    }
    double result = nx[0] * dx + ny[0] * dy - distance[0];
    for (int i = 1; i < sides; ++i) {
      const auto k = static_cast<std::size_t>(i);
      result = std::max(result, nx[k] * dx + ny[k] * dy - distance[k]);
    }
    return result;
  }
};

/// The leaf of a cell. Its circumscribed circle is smaller than the side of the cell.
Leaf make_leaf(Random& random, const TextureStyle& style, double cell, double cell_x, double cell_y) {
  Leaf leaf{};
  leaf.x = (cell_x + random(0.0, 1.0)) * cell;
  leaf.y = (cell_y + random(0.0, 1.0)) * cell;
  leaf.grey = std::clamp(style.mean + style.spread * random(-1.0, 1.0), 30.0, 230.0);
  const double slope = random(0.0, 0.35) * style.spread / cell, toward = random(0.0, 2.0 * kPi);
  leaf.grey_x = slope * std::cos(toward);
  leaf.grey_y = slope * std::sin(toward);

  const bool upright = random(0.0, 1.0) < style.alignment;
  const double angle = upright ? 0.0 : random(0.0, 2.0 * kPi);
  const double kind = upright ? 0.5 : random(0.0, 1.0);
  leaf.cosine = std::cos(angle);
  leaf.sine = std::sin(angle);
  if (kind < 0.25) {
    leaf.major = cell * random(0.3, 0.6);
    leaf.minor = leaf.major * random(0.45, 1.0);
    leaf.radius = leaf.major;
    return leaf;
  }
  if (kind < 0.7) {  // rectangle, sometimes a thin stroke
    const double half_length = cell * random(0.25, 0.65);
    const double half_width = random(0.0, 1.0) < 0.3 ? half_length * random(0.08, 0.2) : half_length * random(0.4, 1.0);
    const bool turned = random(0.0, 1.0) < 0.5;
    leaf.sides = 4;
    leaf.nx = {leaf.cosine, -leaf.sine, -leaf.cosine, leaf.sine};
    leaf.ny = {leaf.sine, leaf.cosine, -leaf.sine, -leaf.cosine};
    leaf.distance = turned ? std::array<double, 6>{half_width, half_length, half_width, half_length}
                           : std::array<double, 6>{half_length, half_width, half_length, half_width};
    leaf.radius = std::hypot(half_length, half_width);
    return leaf;
  }
  leaf.sides = 3 + static_cast<int>(random(0.0, 3.0));
  const double inner = cell * random(0.18, 0.3);
  double widest = 0.0;  // angle between adjacent normals, at most 129 degrees
  std::array<double, 7> directions{};
  for (int i = 0; i < leaf.sides; ++i) {
    const auto k = static_cast<std::size_t>(i);
    directions[k] = angle + (2.0 * kPi * i + random(-0.22, 0.22)) / leaf.sides;
    leaf.nx[k] = std::cos(directions[k]);
    leaf.ny[k] = std::sin(directions[k]);
    leaf.distance[k] = inner * random(0.75, 1.0);
  }
  directions[static_cast<std::size_t>(leaf.sides)] = directions[0] + 2.0 * kPi;
  for (std::size_t k = 0; k < static_cast<std::size_t>(leaf.sides); ++k)
    widest = std::max(widest, directions[k + 1] - directions[k]);
  leaf.radius = inner / std::cos(0.5 * widest);
  return leaf;
}

class DeadLeaves : public Painter {
 public:
  DeadLeaves(const TextureStyle& style, std::uint64_t seed) : style_(style), seed_(seed) {}

  void paint(const TexelSquare& square) const override {
    std::fill_n(square.texels, square.side * square.side, static_cast<float>(style_.mean));
    if (style_.feature > 0.0)
      for (int level = 0; level < style_.levels; ++level) add_leaves(square, level);
    add_noise(square, style_.noise, style_.noise_size, seed_);
  }

 private:
  void add_leaves(const TexelSquare& square, int level) const;

  TextureStyle style_;
  std::uint64_t seed_;
};

void DeadLeaves::add_leaves(const TexelSquare& square, int level) const {
  const double cell = style_.feature / (1 << level);
  const double visible = std::clamp(cell / square.texel / 3.0 - 1.0, 0.0, 1.0);  // fades leaves of a few texels
  if (visible == 0.0) return;
  const double fraction = level == 0 ? 0.9 : style_.cover;
  const double extent = (square.side - 1) * square.texel, margin = cell + kRamp * square.texel;
  const auto first = [&](double start) { return static_cast<std::int64_t>(std::floor((start - margin) / cell)); };
  const auto last = [&](double start) {
    return static_cast<std::int64_t>(std::floor((start + extent + margin) / cell));
  };
  const std::uint64_t key = combine(seed_, level + 1);
  for (std::int64_t cy = first(square.top); cy <= last(square.top); ++cy) {
    for (std::int64_t cx = first(square.left); cx <= last(square.left); ++cx) {
      Random random(combine(combine(key, cx), cy));
      if (random(0.0, 1.0) > fraction) continue;
      const Leaf leaf = make_leaf(random, style_, cell, static_cast<double>(cx), static_cast<double>(cy));
      const double reach = leaf.radius + kRamp * square.texel;
      const auto texel_range = [&](double centre, double start) {
        return std::pair(
            std::clamp(static_cast<int>(std::ceil((centre - reach - start) / square.texel)), 0, square.side),
            std::clamp(static_cast<int>(std::floor((centre + reach - start) / square.texel)) + 1, 0, square.side));
      };
      const auto [x0, x1] = texel_range(leaf.x, square.left);
      const auto [y0, y1] = texel_range(leaf.y, square.top);
      for (int y = y0; y < y1; ++y) {
        const double dy = square.top + y * square.texel - leaf.y;
        for (int x = x0; x < x1; ++x) {
          const double dx = square.left + x * square.texel - leaf.x;
          const double inside = std::clamp(0.5 - leaf.signed_distance(dx, dy) / (kRamp * square.texel), 0.0, 1.0);
          if (inside == 0.0) continue;
          float& texel = square.texels[y * square.side + x];
          const double grey = leaf.grey + leaf.grey_x * dx + leaf.grey_y * dy;
          texel += static_cast<float>(inside * visible * (grey - texel));
        }
      }
    }
  }
}

constexpr double kFilter = 1.5;  // width of the averaging filter [texels]

/// Contribution of a unit to the mean over an interval.
struct Part {
  std::int64_t unit;
  double weight;  // fraction of the interval, 0 to 1
  double place;   // position of the part's middle in the unit, -1 to 1
};

/// Finds the units that an interval [m] overlaps; the rest of the weights up to 1 is joint.
void find_parts(double middle, double width, double pitch, double joint, std::vector<Part>& parts) {
  parts.clear();
  const double low = middle - 0.5 * width, high = middle + 0.5 * width;
  const auto first = static_cast<std::int64_t>(std::floor(low / pitch));
  const auto last = static_cast<std::int64_t>(std::floor(high / pitch));
  for (std::int64_t unit = first; unit <= last; ++unit) {
    const double start = static_cast<double>(unit) * pitch + 0.5 * joint, end = start + pitch - joint;
    const double from = std::max(low, start), to = std::min(high, end);
    if (from >= to) continue;
    parts.push_back({unit, (to - from) / width, (from + to - start - end) / (end - start)});
  }
}

class Cladding : public Painter {
 public:
  Cladding(const CladdingStyle& style, std::uint64_t seed) : style_(style), seed_(seed) {}

  void paint(const TexelSquare& square) const override {
    const double width = kFilter * square.texel;
    std::vector<Part> courses, units;
    for (int y = 0; y < square.side; ++y) {
      find_parts(square.top + y * square.texel, width, style_.unit_height, style_.joint, courses);
      for (int x = 0; x < square.side; ++x) {
        double grey = style_.joint_grey;
        for (const Part& course : courses) {
          const double shift = course.unit % 2 == 0 ? 0.0 : style_.bond * style_.unit_width;
          find_parts(square.left + x * square.texel + shift, width, style_.unit_width, style_.joint, units);
          for (const Part& unit : units)
            grey += course.weight * unit.weight *
                    (tone(course.unit, unit.unit) - style_.bevel * unit.place - style_.joint_grey);
        }
        square.texels[y * square.side + x] = static_cast<float>(grey);
      }
    }
    add_noise(square, style_.noise, style_.noise_size, seed_, style_.grain);
  }

 private:
  double tone(std::int64_t course, std::int64_t unit) const {
    return style_.mean + style_.spread * (2.0 * uniform(combine(combine(seed_, course), unit)) - 1.0);
  }

  CladdingStyle style_;
  std::uint64_t seed_;
};

}  // namespace

std::unique_ptr<const Painter> dead_leaves(const TextureStyle& style, std::uint64_t seed) {
  return std::make_unique<DeadLeaves>(style, seed);
}

void add_noise(const TexelSquare& square, double amplitude, double wavelength, std::uint64_t seed, double stretch) {
  constexpr int kOctaves = 4;
  for (int octave = 0; octave < kOctaves; ++octave, amplitude *= 0.6, wavelength *= 0.25) {
    const double height =
        amplitude * std::clamp(wavelength / square.texel / 3.0 - 1.0, 0.0, 1.0);  // fades at the sampling limit
    if (height == 0.0) continue;
    GradientNoise noise(combine(seed, -1 - octave));
    for (int y = 0; y < square.side; ++y)
      for (int x = 0; x < square.side; ++x)
        square.texels[y * square.side + x] +=
            static_cast<float>(height * noise((square.left + x * square.texel) / wavelength,
                                              (square.top + y * square.texel) / (wavelength * stretch)));
  }
  std::for_each_n(square.texels, square.side * square.side,
                  [](float& texel) { texel = std::clamp(texel, 25.0f, 235.0f); });
}

std::unique_ptr<const Painter> cladding(const CladdingStyle& style, std::uint64_t seed) {
  return std::make_unique<Cladding>(style, seed);
}

}  // namespace quadedge::synthetic
