#pragma once
/// \file texture.hpp  Flat reflectance maps, painted on demand in tiles at the required resolution.

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

namespace quadedge::synthetic {

/// Numbers that are computed together, for example one per ray.
constexpr std::size_t kLanes = 16;
using Lanes = std::array<double, kLanes>;

/// A square of texels to paint.
struct TexelSquare {
  double left, top;  ///< position of the first texel on the surface [m]
  double texel;      ///< distance between texels [m]
  int side;          ///< texels per side
  float* texels;     ///< side x side, row-major [grey levels]
};

/// Appearance of a surface: a function of the position on it, band-limited to the requested texel size.
class Painter {
 public:
  virtual ~Painter() = default;
  /// Fills the square. A position has the same value in all squares of the same texel size.
  virtual void paint(const TexelSquare& square) const = 0;
};

/// A flat reflectance map in grey levels, sampled at `texel` and interpolated bilinearly; with several levels, also at
/// 2, 4, 8 ... times that, for surfaces seen at small and large distances. Tiles are painted on demand, and their
/// content depends on the painter only. Thread-safe.
class Texture {
 public:
  /// Covers |u| <= half_width, |v| <= half_height [m].
  Texture(std::unique_ptr<const Painter> painter, double half_width, double half_height, double texel, int levels = 1);

  /// Reflectance [grey levels] at (u, v) [m]; positions outside the map take the value of its border. `footprint`:
  /// distance between adjacent rays on the surface [m]; adjacent levels are blended linearly in its logarithm.
  double sample(double u, double v, double footprint = 0.0) const;
  /// The same for many positions, to the last bit.
  void sample(const Lanes& u, const Lanes& v, const Lanes& footprint, Lanes& grey) const;
  /// Whether the footprint matters.
  bool has_levels() const { return levels_.size() > 1; }

 private:
  static constexpr int kTile = 64;  // texels per tile side
  static constexpr int kStride =
      kTile + 1;  // one more than a tile, shared with the neighbour, so that interpolation needs one tile only
  struct Tile {
    float texels[kStride * kStride];
  };
  /// The whole map at one texel size.
  struct Level {
    Level(double half_width, double half_height, double texel_size);
    ~Level();
    double texel;
    int width, height, tiles_x, tiles_y;
    mutable std::vector<std::atomic<Tile*>> tiles;
  };

  double sample(const Level& level, double u, double v) const;
  void sample(const Level& level, const Lanes& u, const Lanes& v, Lanes& grey) const;
  /// Number of the level, which may lie between two.
  double level_of(double footprint) const;
  const Tile& tile(const Level& level, int index) const;
  static int tile_index(const Level& level, unsigned column, unsigned row) {
    return static_cast<int>(row / kTile) * level.tiles_x + static_cast<int>(column / kTile);
  }
  /// Between the texels around (x, y), of which the first is at (column, row).
  static double interpolate(const float* tile, double x, double y, unsigned column, unsigned row) {
    const float* p = tile + (row % kTile) * kStride + column % kTile;
    const double fx = x - static_cast<int>(column), fy = y - static_cast<int>(row);
    const double top = p[0] + fx * (p[1] - p[0]);
    const double bottom = p[kStride] + fx * (p[kStride + 1] - p[kStride]);
    return top + fy * (bottom - top);
  }

  std::unique_ptr<const Painter> painter_;
  double half_width_, half_height_;
  std::vector<std::unique_ptr<const Level>> levels_;
};

}  // namespace quadedge::synthetic
