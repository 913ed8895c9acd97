/// \file image_faults.cpp  Bad images.
#include "image_faults.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <random>

namespace attack {
using namespace quadedge;
namespace {

/// A circle on a lens [px].
struct Drop {
  double x, y, radius;
};

std::vector<Drop> random_drops(int count, const PinholeCamera& camera, unsigned seed) {
  std::mt19937 random(seed);
  const auto part = [&random] { return static_cast<double>(random() & 0xffffU) / 65535.0; };
  std::vector<Drop> drops;
  for (int i = 0; i < count; ++i) {
    const double x = part() * camera.width, y = part() * camera.height;
    drops.push_back({x, y, (0.01 + 0.02 * part()) * camera.width});
  }
  return drops;
}

void put(const Drop& drop, Image& image) {
  const Image before = image;
  const auto inside = [&](int x, int y) {
    return x >= 0 && y >= 0 && x < image.width && y < image.height && std::hypot(x - drop.x, y - drop.y) < drop.radius;
  };
  const int top = static_cast<int>(drop.y - drop.radius), left = static_cast<int>(drop.x - drop.radius),
            side = static_cast<int>(2 * drop.radius) + 1;
  double sum = 0;
  int count = 0;
  for (int y = top; y <= top + side; ++y)
    for (int x = left; x <= left + side; ++x)
      if (inside(x, y)) sum += before.view().value(x, y), ++count;
  for (int y = top; y <= top + side; ++y)
    for (int x = left; x <= left + side; ++x) {
      const int u = static_cast<int>(std::lround(2 * drop.x)) - x, v = static_cast<int>(std::lround(2 * drop.y)) - y;
      if (!inside(x, y)) continue;
      const double mirrored = inside(u, v) ? before.view().value(u, v) : sum / count;
      image.set(x, y, static_cast<int>(std::lround(0.5 * sum / count + 0.2 * mirrored)));
    }
}

}  // namespace

Alteration every_pixel(const PixelChange& change) {
  return [change](Sequence& s) {
    for (const bool is_left : {true, false}) {
      auto& images = is_left ? s.left : s.right;
      for (std::size_t i = 0; i < images.size(); ++i) {
        const Image before = images[i];
        for (int y = 0; y < before.height; ++y)
          for (int x = 0; x < before.width; ++x) {
            const double grey = change(before, x, y, is_left, i);
            images[i].set(x, y, std::clamp(static_cast<int>(std::lround(grey)), 0, before.max_value));
          }
      }
    }
  };
}

Alteration brighter(double left, double right) {
  return every_pixel([=](const Image& image, int x, int y, bool is_left, std::size_t) {
    return (is_left ? left : right) * image.view().value(x, y);
  });
}

Alteration exposures_in_turn(double ratio) {
  return every_pixel([=](const Image& image, int x, int y, bool, std::size_t frame) {
    return image.view().value(x, y) / (frame % 2 == 1 ? ratio : 1);
  });
}

Alteration compressed(int quality) {
  return [=](Sequence& s) {
    for (auto* images : {&s.left, &s.right})
      for (Image& image : *images) {
        std::vector<std::uint8_t> file;
        const cv::Mat pixels(image.height, image.width, CV_8U, image.pixels.data());
        cv::imencode(".jpg", pixels, file, {cv::IMWRITE_JPEG_QUALITY, quality});
        const cv::Mat read = cv::imdecode(file, cv::IMREAD_GRAYSCALE);
        for (int y = 0; y < image.height; ++y)
          for (int x = 0; x < image.width; ++x) image.set(x, y, read.at<std::uint8_t>(y, x));
      }
  };
}

Alteration drops(int count) {
  return [=](Sequence& s) {
    for (const bool is_left : {true, false})
      for (const Drop& drop : random_drops(count, is_left ? s.rig.left : s.rig.right, is_left ? 3 : 4))
        for (Image& image : is_left ? s.left : s.right) put(drop, image);
  };
}

Alteration lamp() {
  return every_pixel([](const Image& image, int x, int y, bool, std::size_t) {
    const double u = x / static_cast<double>(image.width) - 0.5, v = y / static_cast<double>(image.height) - 0.5;
    return image.view().value(x, y) * (0.3 + 2.2 * std::exp(-(u * u + v * v) / 0.04));
  });
}

void show_posters(Sequence& sequence, double distance, double speed) {
  constexpr double kDisparity = 8;
  const double metres = sequence.rig.baseline() / kDisparity;  // per pixel
  const int width = sequence.rig.left.width, height = sequence.rig.left.height;
  const double side = 0.55 * height, top = 0.2 * height;
  std::mt19937 random(5);
  const auto grain = [](int x, int y, unsigned salt) {  // a random mosaic of 6 x 6 px
    unsigned hash = static_cast<unsigned>(x / 6) * 374761393U + static_cast<unsigned>(y / 6) * 668265263U + salt;
    hash = (hash ^ (hash >> 13U)) * 1274126177U;
    return static_cast<double>((hash ^ (hash >> 16U)) & 0xffU) / 255.0;
  };
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const double at = speed * static_cast<double>(i);
    sequence.world_from_left[i] = Eigen::Translation3d(at * metres, 0, 0);
    for (const bool is_left : {true, false}) {
      Image& image = is_left ? sequence.left[i] : sequence.right[i];
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double wall = x + at + (is_left ? 0 : kDisparity), across = wall - 0.1 * width;
          const double in_poster = across - distance * std::floor(across / distance);
          double grey = 120 + 12 * grain(static_cast<int>(wall) + 3000, y, 1);
          if (across >= 0 && across < 2 * distance && in_poster < side && y >= top && y < top + side)
            grey = 40 + 170 * grain(static_cast<int>(in_poster), static_cast<int>(y - top), 2);
          const double noise = 3.0 * (static_cast<double>(random() & 0xffffU) / 65535.0 - 0.5);
          image.set(x, y, static_cast<int>(std::lround(grey + noise)));
        }
    }
  }
}

}  // namespace attack
