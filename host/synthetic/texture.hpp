#pragma once
/// \file texture.hpp  Band-limited reflectance maps that never repeat.

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

namespace quadedge::synthetic {

/// What a surface looks like.
struct TextureStyle {
  double feature = 0.0;      ///< size of the largest leaves [m]; 0: no leaves, noise alone
  int levels = 4;            ///< generations of leaves, each half as large as the one before
  double cover = 0.4;        ///< leaves per cell of their size in the generations after the first, 0 to 1
  double alignment = 0.0;    ///< fraction of the leaves that are upright rectangles, 0 to 1
  double noise = 10.0;       ///< amplitude of the fractal noise [grey levels]
  double noise_size = 0.25;  ///< largest noise wavelength [m]
  double mean = 130.0;       ///< grey level of the ground
  double spread = 70.0;      ///< leaves are mean +- spread [grey levels], kept in 25..235
};

/// A flat reflectance map in grey levels: opaque leaves of all sizes lying on one another ("dead leaves": sharp
/// reflectance steps, corners and occlusions at several scales) plus multi-octave gradient noise.
///
/// The map is a function of the plane that is sampled at `texel` and interpolated bilinearly. Steps are ramps 1.5
/// texels wide and noise or leaves below the sampling limit are faded, so that a texel of half a pixel does not alias.
/// Tiles are made when somebody looks at them; what they hold depends on the seed alone. Safe for several threads.
class Texture {
 public:
  /// Covers |u| <= half_width, |v| <= half_height [m].
  Texture(const TextureStyle& style, std::uint64_t seed, double half_width, double half_height, double texel);
  ~Texture();
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  /// Reflectance [grey levels] at (u, v) [m]; places outside the map take the value of its border.
  double sample(double u, double v) const;

 private:
  static constexpr int kTile = 64;           // texels per tile side
  static constexpr int kStride = kTile + 1;  // one more, shared with the neighbour, to interpolate inside one tile
  struct Tile {
    float texels[kStride * kStride];
  };

  const Tile& tile(int index) const;
  void paint(Tile& tile, int tile_x, int tile_y) const;
  void add_leaves(Tile& tile, double left, double top, int level) const;
  void add_noise(Tile& tile, double left, double top) const;

  TextureStyle style_;
  std::uint64_t seed_;
  double half_width_, half_height_, texel_;
  int width_, height_, tiles_x_, tiles_y_;
  mutable std::vector<std::atomic<Tile*>> tiles_;
};

}  // namespace quadedge::synthetic
