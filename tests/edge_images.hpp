#pragma once
/// \file edge_images.hpp  Test images: noise, and 8-bit edges at known positions, by the coverage of pixels.

#include "testing.hpp"

/// An image with these pixel values, by columns of each row in order.
inline quadedge::Image filled_image(int width, int height, int max_value,
                                    const std::function<int(int x, int y)>& value) {
  quadedge::Image image(width, height, max_value);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.set(x, y, value(x, y));
  return image;
}
inline quadedge::Image filled_image(int width, int height, const std::function<int(int x, int y)>& value) {
  return filled_image(width, height, quadedge::kMaxValue8, value);
}

/// Normal noise around `level`, both in grey levels, rounded and clipped as by a camera.
inline quadedge::Image noisy_image(int width, int height, double level, double sigma,
                                   int max_value = quadedge::kMaxValue8, unsigned seed = 1) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(level, sigma);
  return filled_image(width, height, max_value, [&](int, int) {
    const double value = normal(generator) * max_value / quadedge::kMaxValue8;
    return static_cast<int>(std::clamp(std::round(value), 0.0, static_cast<double>(max_value)));
  });
}

/// Points of the plane with `inside(x, y)` have grey level `bright`, all others `dark`. 256 samples per pixel on a
/// lattice without rows or columns, so that nearly upright edges are rendered as finely as oblique ones.
inline quadedge::Image render_shape(int width, int height, double dark, double bright,
                                    const std::function<bool(double, double)>& inside) {
  constexpr int kSamples = 256;
  quadedge::Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      int covered = 0;
      for (int i = 0; i < kSamples; ++i) {
        const double u = (i + 0.5) / kSamples, v = std::fmod((i + 0.5) * 0.61803398874989485, 1.0);
        covered += inside(x - 0.5 + u, y - 0.5 + v) ? 1 : 0;
      }
      const double grey = dark + (bright - dark) * covered / kSamples;
      image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }
  return image;
}

/// Half-plane: bright where (x - px) nx + (y - py) ny > 0 with n = (cos angle, sin angle).
inline quadedge::Image render_half_plane(int width, int height, double px, double py, double angle, double dark = 80,
                                         double bright = 200) {
  const double nx = std::cos(angle), ny = std::sin(angle);
  return render_shape(width, height, dark, bright,
                      [=](double x, double y) { return (x - px) * nx + (y - py) * ny > 0; });
}

/// Overlapping discs and waves with a little noise: edges of all directions, strengths and curvatures. Deterministic.
inline quadedge::Image textured_image(int width, int height, std::uint64_t seed = 1) {
  std::uint64_t state = seed * 0x9E3779B97F4A7C15ULL + 1;
  const auto uniform = [&state] {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<double>(state >> 11) * 0x1p-53;
  };
  std::vector<double> grey(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 128.0);
  const int discs = 12 + width * height / 500;
  for (int d = 0; d < discs; ++d) {
    const double cx = uniform() * width, cy = uniform() * height, r = 3 + 22 * uniform() * uniform(),
                 level = 30 + 200 * uniform();
    const int x0 = std::max(0, static_cast<int>(cx - r - 1)), x1 = std::min(width - 1, static_cast<int>(cx + r + 2));
    const int y0 = std::max(0, static_cast<int>(cy - r - 1)), y1 = std::min(height - 1, static_cast<int>(cy + r + 2));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) {
        const double cover = std::clamp(r - std::hypot(x - cx, y - cy) + 0.5, 0.0, 1.0);
        double& value =
            grey[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
        value += cover * (level - value);
      }
    }
  }
  quadedge::Image image(width, height);
  for (std::size_t i = 0; i < grey.size(); ++i) {
    const double noise = 2.0 * (uniform() + uniform() + uniform() - 1.5);
    image.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(grey[i] + noise), 0L, 255L));
  }
  return image;
}
