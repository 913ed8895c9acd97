#include "synthetic/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "quadedge/pi.hpp"
#include "synthetic/hash.hpp"

namespace quadedge::synthetic {
namespace {

constexpr double kRamp = 1.5;  // width of a reflectance step [texels]

/// Gradient noise of unit wavelength, about -1..1. Neighbouring calls share the lattice cell, which is kept.
class GradientNoise {
 public:
  explicit GradientNoise(std::uint64_t key) : key_(key) {}

  double operator()(double x, double y) {
    const double fx = std::floor(x), fy = std::floor(y);
    if (fx != cell_x_ || fy != cell_y_) enter(fx, fy);
    const double tx = x - fx, ty = y - fy, u = fade(tx), v = fade(ty);
    const auto corner = [&](std::size_t i, double dx, double dy) { return gx_[i] * dx + gy_[i] * dy; };
    const double top = corner(0, tx, ty) * (1.0 - u) + corner(1, tx - 1.0, ty) * u;
    const double bottom = corner(2, tx, ty - 1.0) * (1.0 - u) + corner(3, tx - 1.0, ty - 1.0) * u;
    return 1.6 * (top * (1.0 - v) + bottom * v);
  }

 private:
  static double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

  void enter(double fx, double fy) {
    cell_x_ = fx;
    cell_y_ = fy;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint64_t bits =
          combine(combine(key_, static_cast<std::int64_t>(fx) + static_cast<std::int64_t>(i % 2)),
                  static_cast<std::int64_t>(fy) + static_cast<std::int64_t>(i / 2));
      gx_[i] = static_cast<double>(static_cast<std::int32_t>(bits)) * 0x1p-31;
      gy_[i] = static_cast<double>(static_cast<std::int32_t>(bits >> 32)) * 0x1p-31;
    }
  }

  std::uint64_t key_;
  double cell_x_ = 0.5, cell_y_ = 0.5;  // no cell yet
  std::array<double, 4> gx_{}, gy_{};
};

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

/// The leaf of a cell. Its circumscribed circle is smaller than the cell's side.
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
  double widest = 0.0;  // angle between neighbouring normals, 129 degrees at most
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

}  // namespace

Texture::Texture(const TextureStyle& style, std::uint64_t seed, double half_width, double half_height, double texel)
    : style_(style),
      seed_(seed),
      half_width_(half_width),
      half_height_(half_height),
      texel_(texel),
      width_(static_cast<int>(std::ceil(2.0 * half_width / texel)) + 2),
      height_(static_cast<int>(std::ceil(2.0 * half_height / texel)) + 2),
      tiles_x_((width_ + kTile - 1) / kTile),
      tiles_y_((height_ + kTile - 1) / kTile),
      tiles_(static_cast<std::size_t>(tiles_x_) * static_cast<std::size_t>(tiles_y_)) {
  for (auto& tile : tiles_) tile.store(nullptr, std::memory_order_relaxed);
}

Texture::~Texture() {
  for (auto& tile : tiles_) delete tile.load(std::memory_order_relaxed);
}

double Texture::sample(double u, double v) const {
  const double x = std::clamp((u + half_width_) / texel_, 0.0, static_cast<double>(width_ - 1));
  const double y = std::clamp((v + half_height_) / texel_, 0.0, static_cast<double>(height_ - 1));
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const Tile& t = tile((iy / kTile) * tiles_x_ + ix / kTile);
  const float* p = t.texels + (iy % kTile) * kStride + ix % kTile;
  const double fx = x - ix, fy = y - iy;
  const double top = p[0] + fx * (p[1] - p[0]);
  const double bottom = p[kStride] + fx * (p[kStride + 1] - p[kStride]);
  return top + fy * (bottom - top);
}

const Texture::Tile& Texture::tile(int index) const {
  std::atomic<Tile*>& slot = tiles_[static_cast<std::size_t>(index)];
  if (const Tile* ready = slot.load(std::memory_order_acquire)) return *ready;
  // Two threads may paint the same tile: both get the same texels, and one of them is dropped.
  auto fresh = std::make_unique<Tile>();
  paint(*fresh, index % tiles_x_, index / tiles_x_);
  Tile* expected = nullptr;
  if (slot.compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return *fresh.release();
  return *expected;
}

void Texture::paint(Tile& tile, int tile_x, int tile_y) const {
  const double left = tile_x * kTile * texel_ - half_width_, top = tile_y * kTile * texel_ - half_height_;
  std::fill(std::begin(tile.texels), std::end(tile.texels), static_cast<float>(style_.mean));
  if (style_.feature > 0.0)
    for (int level = 0; level < style_.levels; ++level) add_leaves(tile, left, top, level);
  add_noise(tile, left, top);
}

void Texture::add_leaves(Tile& tile, double left, double top, int level) const {
  const double cell = style_.feature / (1 << level);
  const double visible = std::clamp(cell / texel_ / 3.0 - 1.0, 0.0, 1.0);  // fades leaves of a few texels
  if (visible == 0.0) return;
  const double fraction = level == 0 ? 0.9 : style_.cover;
  const double extent = (kStride - 1) * texel_, margin = cell + kRamp * texel_;
  const auto first = [&](double start) { return static_cast<std::int64_t>(std::floor((start - margin) / cell)); };
  const auto last = [&](double start) {
    return static_cast<std::int64_t>(std::floor((start + extent + margin) / cell));
  };
  const std::uint64_t key = combine(seed_, level + 1);
  for (std::int64_t cy = first(top); cy <= last(top); ++cy) {
    for (std::int64_t cx = first(left); cx <= last(left); ++cx) {
      Random random(combine(combine(key, cx), cy));
      if (random(0.0, 1.0) > fraction) continue;
      const Leaf leaf = make_leaf(random, style_, cell, static_cast<double>(cx), static_cast<double>(cy));
      const double reach = leaf.radius + kRamp * texel_;
      const auto texel_range = [&](double centre, double start) {
        return std::pair(std::clamp(static_cast<int>(std::ceil((centre - reach - start) / texel_)), 0, kStride),
                         std::clamp(static_cast<int>(std::floor((centre + reach - start) / texel_)) + 1, 0, kStride));
      };
      const auto [x0, x1] = texel_range(leaf.x, left);
      const auto [y0, y1] = texel_range(leaf.y, top);
      for (int y = y0; y < y1; ++y) {
        const double dy = top + y * texel_ - leaf.y;
        for (int x = x0; x < x1; ++x) {
          const double dx = left + x * texel_ - leaf.x;
          const double inside = std::clamp(0.5 - leaf.signed_distance(dx, dy) / (kRamp * texel_), 0.0, 1.0);
          if (inside == 0.0) continue;
          float& texel = tile.texels[y * kStride + x];
          const double grey = leaf.grey + leaf.grey_x * dx + leaf.grey_y * dy;
          texel += static_cast<float>(inside * visible * (grey - texel));
        }
      }
    }
  }
}

void Texture::add_noise(Tile& tile, double left, double top) const {
  constexpr int kOctaves = 4;
  double amplitude = style_.noise, wavelength = style_.noise_size;
  for (int octave = 0; octave < kOctaves; ++octave, amplitude *= 0.6, wavelength *= 0.25) {
    const double height =
        amplitude * std::clamp(wavelength / texel_ / 3.0 - 1.0, 0.0, 1.0);  // fades at the sampling limit
    if (height == 0.0) continue;
    GradientNoise noise(combine(seed_, -1 - octave));
    for (int y = 0; y < kStride; ++y)
      for (int x = 0; x < kStride; ++x)
        tile.texels[y * kStride + x] +=
            static_cast<float>(height * noise((left + x * texel_) / wavelength, (top + y * texel_) / wavelength));
  }
  for (float& texel : tile.texels) texel = std::clamp(texel, 25.0f, 235.0f);
}

}  // namespace quadedge::synthetic
