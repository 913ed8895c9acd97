/// \file render.cpp  Tiles list their surfaces; silhouettes get more rays; an exposure averages moments.
#include "scenes/render.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

#include "scenes/hash.hpp"
#include "scenes/reflectance.hpp"

namespace quadedge::synthetic {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kTile = 8;  // [px], rays of a tile test only the surfaces that may be visible in it

struct Hit {
  double inverse_depth = 0.0;
  const VisibleSurface* surface = nullptr;
  const void* object() const { return surface ? surface->object() : nullptr; }
};

using Candidates = std::vector<const VisibleSurface*>;

struct BoxedSurface {
  const VisibleSurface* surface;
  PixelBox box;
};

/// The nearest surface; at equal depth, the first.
Hit cast(const Candidates& candidates, const Vector3d& ray) {
  Hit hit;
  for (const VisibleSurface* surface : candidates) {
    const double inverse = surface->inverse_depth(ray);
    if (inverse > hit.inverse_depth) hit = {inverse, surface};
  }
  return hit;
}

/// The hits of a bundle of rays.
struct BundleHits {
  Lanes inverse_depth;
  std::array<const VisibleSurface*, kLanes> surface;

  Hit operator[](std::size_t ray) const { return {inverse_depth[ray], surface[ray]}; }
  bool is_one_surface() const {
    return surface[0] != nullptr &&
           std::all_of(surface.begin(), surface.end(), [&](const VisibleSurface* of) { return of == surface[0]; });
  }
};

/// The same as for every ray on its own.
void cast(const Candidates& candidates, const RayBundle& rays, BundleHits& hits) {
  hits.inverse_depth.fill(0.0);
  hits.surface.fill(nullptr);
  Lanes inverse;
  for (const VisibleSurface* surface : candidates) {
    surface->inverse_depths(rays, inverse);
    for (std::size_t i = 0; i < kLanes; ++i) {
      const bool nearer = inverse[i] > hits.inverse_depth[i];
      hits.inverse_depth[i] = nearer ? inverse[i] : hits.inverse_depth[i];
      hits.surface[i] = nearer ? surface : hits.surface[i];
    }
  }
}

/// count * count positions in the pixel square [-0.5, 0.5)^2.
std::vector<Vector2d> regular_grid(int count) {
  std::vector<Vector2d> offsets;
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) offsets.emplace_back((i + 0.5) / count - 0.5, (j + 0.5) / count - 0.5);
  return offsets;
}

/// Hammersley's set in the unit square; the position of any vertical or horizontal edge is resolved to 1 / count.
std::vector<Vector2d> hammersley(int count) {
  std::vector<Vector2d> offsets;
  for (int i = 0; i < count; ++i) {
    double reversed = 0.0, digit = 0.5;
    for (int rest = i; rest > 0; rest /= 2, digit *= 0.5) reversed += digit * (rest % 2);
    offsets.emplace_back((i + 0.5) / count, reversed);
  }
  return offsets;
}

bool overlap(const PixelBox& one, const PixelBox& other) {
  return one.x0 < other.x1 && other.x0 < one.x1 && one.y0 < other.y1 && other.y0 < one.y1;
}

/// Lists of the surfaces that may be visible in each tile of the image.
struct TiledView {
  TiledView(const VisibleSurfaces& parts, const PixelRays& rays)
      : columns((rays.width() + kTile - 1) / kTile),
        rows((rays.height() + kTile - 1) / kTile),
        tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {
    std::vector<BoxedSurface> surfaces;
    for (const auto& part : parts) surfaces.push_back({part.get(), part->pixels(rays.pinhole())});
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        const PixelBox tile = rays.footprint(
            {x * kTile, y * kTile, std::min((x + 1) * kTile, rays.width()), std::min((y + 1) * kTile, rays.height())});
        for (const BoxedSurface& surface : surfaces)
          if (overlap(surface.box, tile)) tiles[static_cast<std::size_t>(y * columns + x)].push_back(surface);
      }
    }
  }
  int columns, rows;
  std::vector<std::vector<BoxedSurface>> tiles;
};

class TileRenderer {
 public:
  TileRenderer(const PixelRays& rays, int supersampling, Radiance& view)
      : rays_(rays),
        grid_(regular_grid(supersampling)),
        fine_(hammersley(4 * supersampling * supersampling)),
        supersampling_(supersampling),
        view_(view) {}

  using PixelCandidates = std::array<std::array<Candidates, kTile>, kTile>;  // for each pixel of a tile

  /// `candidates`: scratch memory
  void render(const std::vector<BoxedSurface>& surfaces, int left, int top, PixelCandidates& candidates) const {
    const int columns = std::min(kTile, rays_.width() - left), rows = std::min(kTile, rays_.height() - top);
    for (std::size_t j = 0; j < kTile; ++j) {
      for (std::size_t i = 0; i < kTile; ++i) {
        const int x = left + static_cast<int>(i), y = top + static_cast<int>(j);
        candidates[j][i].clear();
        if (x >= rays_.width() || y >= rays_.height()) continue;
        const PixelBox pixel = rays_.footprint({x, y, x + 1, y + 1});
        for (const auto& [surface, box] : surfaces)
          if (overlap(pixel, box)) candidates[j][i].push_back(surface);
      }
    }
    std::array<std::array<const void*, kTile + 1>, kTile + 1> corner{};  // object at (left - 0.5 + i, top - 0.5 + j)
    for (int j = 0; j <= rows; ++j) {
      for (int i = 0; i <= columns; ++i) {
        const auto near_i = static_cast<std::size_t>(std::min(i, columns - 1));
        const auto near_j = static_cast<std::size_t>(std::min(j, rows - 1));
        corner[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] =
            cast(candidates[near_j][near_i], rays_.corner(left + i, top + j)).object();
      }
    }
    for (std::size_t j = 0; j < static_cast<std::size_t>(rows); ++j) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(columns); ++i) {
        const Candidates& nearby = candidates[j][i];
        const int x = left + static_cast<int>(i), y = top + static_cast<int>(j);
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(rays_.width()) + static_cast<std::size_t>(x);
        if (!rays_.is_visible(x, y)) continue;
        const Hit centre = cast(nearby, rays_.centre(x, y));
        const void* object = centre.object();
        bool mixed = corner[j][i] != object || corner[j][i + 1] != object || corner[j + 1][i] != object ||
                     corner[j + 1][i + 1] != object;
        double grey = 0.0;
        if (!mixed) grey = coarse(nearby, x, y, object, mixed);
        if (mixed) grey = fine(nearby, x, y);
        view_.grey[pixel] = grey;
        view_.depth[pixel] = centre.surface ? static_cast<float>(1.0 / centre.inverse_depth) : 0.0f;
      }
    }
  }

 private:
  double radiance(const Hit& hit, const Vector3d& ray, double spread) const {
    return hit.surface ? hit.surface->radiance(ray, 1.0 / hit.inverse_depth, spread) : 0.0;
  }

  /// Distance between adjacent rays of the grid at unit depth.
  double spread(int x, int y) const { return 1.0 / (supersampling_ * rays_.focal_length(x, y)); }

  /// Adds the radiance of a bundle's rays in their order.
  void add_radiance(const BundleHits& hits, const RayBundle& rays, double spread, double& sum) const {
    Lanes grey;
    if (hits.is_one_surface()) {
      hits.surface[0]->radiances(rays, hits.inverse_depth, spread, grey);
    } else {
      for (std::size_t i = 0; i < kLanes; ++i) grey[i] = radiance(hits[i], rays[i], spread);
    }
    for (const double value : grey) sum += value;
  }

  /// Mean over the grid; stops at a ray that hits another object.
  double coarse(const Candidates& candidates, int x, int y, const void* object, bool& mixed) const {
    const double spread = this->spread(x, y);
    double sum = 0.0;
    std::size_t i = 0;
    for (; !mixed && i + kLanes <= grid_.size(); i += kLanes) {
      RayBundle rays;
      BundleHits hits;
      rays_.within(x, y, &grid_[i], rays);
      cast(candidates, rays, hits);
      for (std::size_t k = 0; k < kLanes; ++k) mixed = mixed || hits[k].object() != object;
      if (!mixed) add_radiance(hits, rays, spread, sum);
    }
    for (; !mixed && i < grid_.size(); ++i) {
      const Vector3d ray = rays_.within(x, y, grid_[i]);
      const Hit hit = cast(candidates, ray);
      mixed = hit.object() != object;
      sum += radiance(hit, ray, spread);
    }
    return sum / static_cast<double>(grid_.size());
  }

  double fine(const Candidates& candidates, int x, int y) const {
    const std::uint64_t key = combine(combine(0, x), y);
    const Vector2d shift(uniform(mix(key)), uniform(mix(~key)));
    const double spread = this->spread(x, y);
    const auto position = [&](std::size_t i) {
      const Vector2d moved = fine_[i] + shift;
      return Vector2d(moved - Vector2d(std::floor(moved.x()) + 0.5, std::floor(moved.y()) + 0.5));
    };
    double sum = 0.0;
    std::size_t i = 0;
    for (; i + kLanes <= fine_.size(); i += kLanes) {
      std::array<Vector2d, kLanes> offsets;
      for (std::size_t k = 0; k < kLanes; ++k) offsets[k] = position(i + k);
      RayBundle rays;
      BundleHits hits;
      rays_.within(x, y, offsets.data(), rays);
      cast(candidates, rays, hits);
      add_radiance(hits, rays, spread, sum);
    }
    for (; i < fine_.size(); ++i) {
      const Vector3d ray = rays_.within(x, y, position(i));
      sum += radiance(cast(candidates, ray), ray, spread);
    }
    return sum / static_cast<double>(fine_.size());
  }

  const PixelRays& rays_;
  std::vector<Vector2d> grid_, fine_;
  int supersampling_;
  Radiance& view_;
};

// MovingBoard and exposures.
constexpr double kBoardDepth = 1.15;      // [m], in front of nearly everything but beyond the nearest depth
constexpr double kBoardRhythm = 0.11;     // [rad per frame]
constexpr double kMomentsPerPixel = 2.0;  // of image motion

}  // namespace

Radiance render(const Scene& scene, const PixelRays& rays, const Eigen::Isometry3d& camera_from_world,
                int supersampling, int threads, const Surface* extra) {
  VisibleSurfaces parts;
  for (const auto& surface : scene.surfaces) surface(camera_from_world, parts);
  if (extra != nullptr) (*extra)(camera_from_world, parts);
  const TiledView tiled(parts, rays);

  Radiance view;
  view.grey.resize(static_cast<std::size_t>(rays.width()) * static_cast<std::size_t>(rays.height()));
  view.depth.resize(view.grey.size());
  const TileRenderer renderer(rays, supersampling, view);

  std::atomic<int> next{0};
  const int count = tiled.columns * tiled.rows;
  const auto work = [&] {
    TileRenderer::PixelCandidates candidates;
    for (int tile = next++; tile < count; tile = next++)
      renderer.render(tiled.tiles[static_cast<std::size_t>(tile)], tile % tiled.columns * kTile,
                      tile / tiled.columns * kTile, candidates);
  };
  const int workers = threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  std::vector<std::future<void>> others;
  for (int i = 1; i < workers; ++i) others.push_back(std::async(std::launch::async, work));
  work();
  for (std::future<void>& other : others) other.get();
  return view;
}

MovingBoard::MovingBoard(const PinholeCamera& left, double fraction, std::uint64_t seed) {
  const double side = std::sqrt(fraction);  // of the image's sides
  half_width_ = 0.5 * side * left.width / left.fx * kBoardDepth;
  half_height_ = 0.5 * side * left.height / left.fy * kBoardDepth;
  // Half the amplitude at which it would reach the border.
  sway_x_ = 0.5 * (1.0 - side) / side * half_width_;
  sway_y_ = 0.5 * (1.0 - side) / side * half_height_;
  TextureStyle style;
  style.feature = 0.16, style.levels = 3, style.alignment = 0.4;
  texture_ = std::make_shared<Texture>(dead_leaves(style, combine(seed, 4)), half_width_, half_height_,
                                       0.5 * kBoardDepth / left.fx);
}

Surface MovingBoard::surface(double phase, const Eigen::Isometry3d& scene_from_left) const {
  const double p = kBoardRhythm * phase;
  const Vector3d centre(sway_x_ * std::sin(p + 0.5), sway_y_ * std::sin(1.3 * p),
                        kBoardDepth + 0.05 * std::sin(0.8 * p));
  const Eigen::Isometry3d left_from_board = pose(centre, 0.12 * std::sin(0.9 * p), 0.0, 0.08 * std::sin(1.2 * p + 1.0));
  return plane_surface(scene_from_left * left_from_board, half_width_, half_height_, texture_);
}

Radiance expose(const Exposure& exposure, int frame, Side side) {
  const auto at = [&](double phase, int rays) {
    const Eigen::Isometry3d scene_from_left = exposure.path.scene_from_left(phase);
    Eigen::Isometry3d camera_from_scene = scene_from_left.inverse();
    if (side == Side::right) camera_from_scene = exposure.rig.right_from_left * camera_from_scene;
    if (exposure.board == nullptr)
      return render(exposure.scene, exposure.rays, camera_from_scene, rays, exposure.threads);
    const Surface surface = exposure.board->surface(phase, scene_from_left);
    return render(exposure.scene, exposure.rays, camera_from_scene, rays, exposure.threads, &surface);
  };
  if (!(exposure.duration > 0.0)) return at(frame, exposure.supersampling);
  // An odd number, so that the middle moment is the time of the frame; the rays are spread over the moments, so that
  // each moment needs fewer.
  const double motion = exposure.path.image_motion(exposure.rig.left, frame, exposure.duration);
  const int moments = 2 * static_cast<int>(std::ceil(0.5 * kMomentsPerPixel * motion)) + 1;
  const int rays = std::max(2, exposure.supersampling / 2);
  Radiance mean = at(frame, rays);
  for (int i = 0; i < moments; ++i) {
    if (2 * i + 1 == moments) continue;
    const Radiance moment = at(frame + exposure.duration * ((i + 0.5) / moments - 0.5), rays);
    for (std::size_t pixel = 0; pixel < mean.grey.size(); ++pixel) mean.grey[pixel] += moment.grey[pixel];
  }
  for (double& grey : mean.grey) grey /= moments;
  return mean;
}

}  // namespace quadedge::synthetic
