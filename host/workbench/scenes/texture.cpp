/// \file texture.cpp  Paints tiles at their first sample, without locks; interpolates in and between levels.
#include "scenes/texture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel.hpp"

namespace quadedge::synthetic {
namespace {

double texels_from_start(double position, double half, double texel, int last) {
  return std::clamp((position + half) / texel, 0.0, static_cast<double>(last));
}

QUADEDGE_VECTOR_CLONES
void find_texels(const Lanes& position, double half, double texel, int last, Lanes& texels) {
  const double highest = last;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double place = (position[i] + half) / texel, high = place < highest ? place : highest;
    texels[i] = high > 0.0 ? high : 0.0;
  }
}

}  // namespace

Texture::Level::Level(double half_width, double half_height, double texel_size)
    : texel(texel_size),
      width(static_cast<int>(std::ceil(2.0 * half_width / texel)) + 2),
      height(static_cast<int>(std::ceil(2.0 * half_height / texel)) + 2),
      tiles_x((width + kTile - 1) / kTile),
      tiles_y((height + kTile - 1) / kTile),
      tiles(static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y)) {
  for (auto& tile : tiles) tile.store(nullptr, std::memory_order_relaxed);
}

Texture::Level::~Level() {
  for (auto& tile : tiles) delete tile.load(std::memory_order_relaxed);
}

Texture::Texture(std::unique_ptr<const Painter> painter, double half_width, double half_height, double texel,
                 int levels)
    : painter_(std::move(painter)), half_width_(half_width), half_height_(half_height) {
  for (int level = 0; level < levels; ++level, texel *= 2.0)
    levels_.push_back(std::make_unique<Level>(half_width, half_height, texel));
}

double Texture::level_of(double footprint) const {
  if (levels_.size() == 1 || footprint <= levels_[0]->texel) return 0.0;
  return std::min(std::log2(footprint / levels_[0]->texel), static_cast<double>(levels_.size() - 1));
}

double Texture::sample(double u, double v, double footprint) const {
  const double level = level_of(footprint);
  const auto finer = static_cast<std::size_t>(level);
  const double fine = sample(*levels_[finer], u, v), blend = level - static_cast<double>(finer);
  return blend > 0.0 ? fine + blend * (sample(*levels_[finer + 1], u, v) - fine) : fine;
}

void Texture::sample(const Lanes& u, const Lanes& v, const Lanes& footprint, Lanes& grey) const {
  Lanes blend;
  const auto finer = static_cast<std::size_t>(level_of(footprint[0]));
  bool is_one_level = true, blends = false;
  for (std::size_t i = 0; i < kLanes; ++i) {
    blend[i] = level_of(footprint[i]) - static_cast<double>(finer);
    is_one_level = is_one_level && blend[i] >= 0.0 && blend[i] < 1.0;
    blends = blends || blend[i] > 0.0;
  }
  if (!is_one_level) {
    for (std::size_t i = 0; i < kLanes; ++i) grey[i] = sample(u[i], v[i], footprint[i]);
    return;
  }
  sample(*levels_[finer], u, v, grey);
  if (!blends) return;
  Lanes coarse;
  sample(*levels_[finer + 1], u, v, coarse);
  for (std::size_t i = 0; i < kLanes; ++i)
    grey[i] = blend[i] > 0.0 ? grey[i] + blend[i] * (coarse[i] - grey[i]) : grey[i];
}

double Texture::sample(const Level& level, double u, double v) const {
  const double x = texels_from_start(u, half_width_, level.texel, level.width - 1);
  const double y = texels_from_start(v, half_height_, level.texel, level.height - 1);
  const auto column = static_cast<unsigned>(static_cast<int>(x)), row = static_cast<unsigned>(static_cast<int>(y));
  return interpolate(tile(level, tile_index(level, column, row)).texels, x, y, column, row);
}

void Texture::sample(const Level& level, const Lanes& u, const Lanes& v, Lanes& grey) const {
  Lanes x, y;
  find_texels(u, half_width_, level.texel, level.width - 1, x);
  find_texels(v, half_height_, level.texel, level.height - 1, y);
  int index = -1;
  const float* texels = nullptr;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const auto column = static_cast<unsigned>(static_cast<int>(x[i])),
               row = static_cast<unsigned>(static_cast<int>(y[i]));
    if (const int wanted = tile_index(level, column, row); wanted != index) {
      index = wanted;
      texels = tile(level, index).texels;
    }
    grey[i] = interpolate(texels, x[i], y[i], column, row);
  }
}

const Texture::Tile& Texture::tile(const Level& level, int index) const {
  std::atomic<Tile*>& slot = level.tiles[static_cast<std::size_t>(index)];
  if (const Tile* ready = slot.load(std::memory_order_acquire)) return *ready;
  // Two threads may paint the same tile; both produce the same texels, and one tile is dropped.
  auto fresh = std::make_unique<Tile>();
  painter_->paint({index % level.tiles_x * kTile * level.texel - half_width_,
                   index / level.tiles_x * kTile * level.texel - half_height_, level.texel, kStride, fresh->texels});
  Tile* expected = nullptr;
  if (slot.compare_exchange_strong(expected, fresh.get(), std::memory_order_acq_rel)) return *fresh.release();
  return *expected;
}

}  // namespace quadedge::synthetic
