#include "synthetic/texture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadedge::synthetic {

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

double Texture::sample(double u, double v, double footprint) const {
  if (levels_.size() == 1 || footprint <= levels_[0]->texel) return sample(*levels_[0], u, v);
  const double level = std::min(std::log2(footprint / levels_[0]->texel), static_cast<double>(levels_.size() - 1));
  const auto finer = static_cast<std::size_t>(level);
  const double fine = sample(*levels_[finer], u, v);
  const double blend = level - static_cast<double>(finer);
  return blend > 0.0 ? fine + blend * (sample(*levels_[finer + 1], u, v) - fine) : fine;
}

double Texture::sample(const Level& level, double u, double v) const {
  const double x = std::clamp((u + half_width_) / level.texel, 0.0, static_cast<double>(level.width - 1));
  const double y = std::clamp((v + half_height_) / level.texel, 0.0, static_cast<double>(level.height - 1));
  const int ix = static_cast<int>(x), iy = static_cast<int>(y);
  const Tile& t = tile(level, (iy / kTile) * level.tiles_x + ix / kTile);
  const float* p = t.texels + (iy % kTile) * kStride + ix % kTile;
  const double fx = x - ix, fy = y - iy;
  const double top = p[0] + fx * (p[1] - p[0]);
  const double bottom = p[kStride] + fx * (p[kStride + 1] - p[kStride]);
  return top + fy * (bottom - top);
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
