#include "attack_sequence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <tuple>

#include "quadedge/dataset.hpp"
#include "quadedge/synthetic.hpp"

namespace attack {
using namespace quadedge;
namespace {

constexpr int kWidth = 480, kHeight = 249;
constexpr double kFocal = 276;  // px; gives the field of view of full-size scenes

/// A value from 0 to 1 that depends only on the grid cell.
double cell_value(int x, int y, unsigned salt) {
  unsigned hash = static_cast<unsigned>(x) * 374761393U + static_cast<unsigned>(y) * 668265263U + salt * 2246822519U;
  hash = (hash ^ (hash >> 13U)) * 1274126177U;
  return static_cast<double>((hash ^ (hash >> 16U)) & 0xffffU) / 65535.0;
}

double smooth_noise(double x, double y, double period, unsigned salt) {
  const double u = x / period, v = y / period;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(u - i), b = ease(v - j);
  return (1 - b) * ((1 - a) * cell_value(i, j, salt) + a * cell_value(i + 1, j, salt)) +
         b * ((1 - a) * cell_value(i, j + 1, salt) + a * cell_value(i + 1, j + 1, salt));
}

/// A mosaic of squares with borders one pixel wide.
double mosaic(double x, double y) {
  constexpr double kPeriod = 9;
  const double u = x / kPeriod, v = y / kPeriod;
  const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
  const auto border = [](double t) { return std::clamp((t - (1 - 1 / kPeriod)) * kPeriod, 0.0, 1.0); };
  const double a = border(u - i), b = border(v - j);
  return (1 - b) * ((1 - a) * cell_value(i, j, 5) + a * cell_value(i + 1, j, 5)) +
         b * ((1 - a) * cell_value(i, j + 1, 5) + a * cell_value(i + 1, j + 1, 5));
}

double board_grey(double x, double y, bool fine) {
  const double value = fine ? mosaic(x, y) : 0.6 * smooth_noise(x, y, 12, 1) + 0.4 * smooth_noise(x, y, 5, 2);
  return 30 + 190 * value;
}

}  // namespace

Image warp(const Image& image, int width, int height, const std::function<Eigen::Vector2d(double, double)>& from) {
  Image result(width, height, image.max_value);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector2d place = from(x, y);
      if (!(place.x() >= 0 && place.y() >= 0 && place.x() <= image.width - 1 && place.y() <= image.height - 1))
        continue;
      const int i = std::min(static_cast<int>(place.x()), image.width - 2),
                j = std::min(static_cast<int>(place.y()), image.height - 2);
      const double a = place.x() - i, b = place.y() - j;
      const auto view = image.view();
      const double value = (1 - b) * ((1 - a) * view.value(i, j) + a * view.value(i + 1, j)) +
                           b * ((1 - a) * view.value(i, j + 1) + a * view.value(i + 1, j + 1));
      result.set(x, y, static_cast<int>(std::lround(value)));
    }
  }
  return result;
}

const Sequence& rendered(const std::string& scene, int frames, int step, double blur, double light, double noise) {
  using Key = std::tuple<std::string, int, int, double, double, double>;
  static std::map<Key, Sequence> kept;
  const Key key{scene, frames, step, blur, light, noise};
  if (const auto found = kept.find(key); found != kept.end()) return found->second;
  SyntheticOptions options;
  options.scene = scene;
  options.width = kWidth;
  options.height = kHeight;
  options.focal = kFocal;
  options.frames = 1 + (frames - 1) * step;
  options.supersampling = 3;
  options.blur = blur;
  options.light = light;
  options.noise = noise;
  const SyntheticSequence source(options);
  Sequence sequence;
  sequence.rig = source.rig();
  sequence.config.stereo.max_disparity = source.rig().max_disparity;
  for (int i = 0; i < options.frames; i += step) {
    sequence.left.push_back(source.render(i, Side::left).image);
    sequence.right.push_back(source.render(i, Side::right).image);
    sequence.world_from_left.push_back(source.world_from_left(i));
  }
  return kept.emplace(key, std::move(sequence)).first->second;
}

const Sequence& recorded(const std::string& path, int frames) {
  static std::map<std::pair<std::string, int>, Sequence> kept;
  Sequence& sequence = kept[{path, frames}];
  const char* root = std::getenv("QUADEDGE_DATA");
  if (sequence.size() > 0 || root == nullptr) return sequence;
  DatasetOptions options;
  options.last_frame = frames;
  const Dataset dataset = open_dataset(std::string(root) + "/" + path, options);
  sequence.rig = dataset.rig;
  sequence.config.stereo.max_disparity = dataset.rig.disparity_range();
  FramePrefetcher prefetcher(dataset);
  while (auto frame = prefetcher.next()) {
    const auto pose = std::min_element(dataset.truth.begin(), dataset.truth.end(), [&](const auto& a, const auto& b) {
      return std::abs(a.stamp_ns - frame->stamp_ns) < std::abs(b.stamp_ns - frame->stamp_ns);
    });
    sequence.world_from_left.push_back(pose == dataset.truth.end() ? Eigen::Isometry3d::Identity()
                                                                   : pose->world_from_left);
    sequence.left.push_back(std::move(frame->left));
    sequence.right.push_back(std::move(frame->right));
  }
  return sequence;
}

void add_board(Sequence& sequence, const Board& board) {
  std::mt19937 random(11);
  const double height = std::min(0.9, std::sqrt(board.area)) * kHeight, width = board.area * kWidth * kHeight / height;
  const double path = board.speed * static_cast<double>(sequence.size() - 1);
  const Image first_left = sequence.left.front(), first_right = sequence.right.front();
  const auto noise = [&] {  // nearly normal, standard deviation 1.5
    double sum = 0;
    for (int k = 0; k < 4; ++k) sum += static_cast<double>(random() & 0xffffU) / 65535.0 - 0.5;
    return 1.5 * sum * std::sqrt(3.0);
  };
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (board.still_camera) {
      sequence.left[i] = first_left;
      sequence.right[i] = first_right;
      sequence.world_from_left[i] = Eigen::Isometry3d::Identity();
    }
    for (const bool is_left : {true, false}) {
      Image& image = is_left ? sequence.left[i] : sequence.right[i];
      const double x0 = 0.5 * (kWidth - width) - 0.5 * path + board.speed * static_cast<double>(i) -
                        (is_left ? 0 : board.disparity),
                   y0 = 0.5 * (kHeight - height);
      for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
          const double cover =
              i < board.begin ? 0
                              : std::clamp(x - x0 + 0.5, 0.0, 1.0) * std::clamp(x0 + width - x + 0.5, 0.0, 1.0) *
                                    std::clamp(y - y0 + 0.5, 0.0, 1.0) * std::clamp(y0 + height - y + 0.5, 0.0, 1.0);
          if (cover == 0 && !board.still_camera) continue;
          double grey = (1 - cover) * image.view().value(x, y);
          if (cover > 0) grey += cover * board_grey(x - x0, y - y0, board.fine);
          image.set(x, y, std::clamp(static_cast<int>(std::lround(grey + noise())), 0, 255));
        }
      }
    }
  }
}

void show_checkerboard(Sequence& sequence, double cell, double speed, double disparity) {
  const double metres = sequence.rig.baseline() / disparity;  // per pixel
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    const double at = speed * static_cast<double>(i);
    sequence.world_from_left[i] = Eigen::Translation3d(at * metres, 0, 0);
    for (const bool is_left : {true, false}) {
      Image& image = is_left ? sequence.left[i] : sequence.right[i];
      const double shift = at + (is_left ? 0 : disparity);
      for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
          // The mean over the pixel: borders are one pixel wide.
          const auto stripe = [&](double u) {
            const double place = u / cell - 2 * std::floor(u / (2 * cell));
            const double from_border = std::min({place, std::abs(place - 1), 2 - place}) * cell;
            return (place < 1 ? 1 : -1) * std::min(1.0, 2 * from_border);
          };
          image.set(x, y, static_cast<int>(std::lround(127.5 + 90 * stripe(x + shift) * stripe(y + 0.3 * cell))));
        }
      }
    }
  }
}

}  // namespace attack
