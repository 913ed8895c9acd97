#pragma once
/// \file texture.hpp  Flat reflectance maps: painted in tiles when somebody looks, each at the resolution of the look.

#include <atomic>
#include <memory>
#include <vector>

namespace quadedge::synthetic {

/// A square of texels to paint.
struct TexelSquare {
  double left, top;  ///< place of the first texel on the surface [m]
  double texel;      ///< from texel to texel [m]
  int side;          ///< texels per side
  float* texels;     ///< side x side, row-major [grey levels]
};

/// What a surface looks like: a function of the place on it, band-limited to the texels that are asked for.
class Painter {
 public:
  virtual ~Painter() = default;
  /// Fills the square. The same place gets the same value in every square of the same texel size.
  virtual void paint(const TexelSquare& square) const = 0;
};

/// A flat reflectance map in grey levels, sampled at `texel` and interpolated bilinearly; with several levels also at
/// 2, 4, 8 ... times that, for surfaces that are seen from near and far. Tiles are painted when somebody looks at
/// them; what they hold depends on the painter alone. Safe for several threads.
class Texture {
 public:
  /// Covers |u| <= half_width, |v| <= half_height [m].
  Texture(std::unique_ptr<const Painter> painter, double half_width, double half_height, double texel, int levels = 1);

  /// Reflectance [grey levels] at (u, v) [m]; places outside the map take the value of its border. `footprint`:
  /// distance between neighbouring rays on the surface [m]; the levels around it are blended linearly in its logarithm.
  double sample(double u, double v, double footprint = 0.0) const;

 private:
  static constexpr int kTile = 64;           // texels per tile side
  static constexpr int kStride = kTile + 1;  // one more, shared with the neighbour, to interpolate inside one tile
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
  const Tile& tile(const Level& level, int index) const;

  std::unique_ptr<const Painter> painter_;
  double half_width_, half_height_;
  std::vector<std::unique_ptr<const Level>> levels_;
};

}  // namespace quadedge::synthetic
