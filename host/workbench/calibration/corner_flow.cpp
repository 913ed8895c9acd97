/// \file corner_flow.cpp  Pyramids; Gauss-Newton with the template's slopes on every level.
#include "calibration/corner_flow.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/parallel.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kHalf = 8, kSide = 2 * kHalf + 1;  // patches of 17 x 17 px
constexpr std::size_t kLevels = 6;
constexpr int kSmallestLevel = 3 * kSide;  // px
constexpr int kSteps = 30;
constexpr double kMaxReturn = 0.35;  // px
constexpr double kMinFlowCorrelation = 0.7;

/// Half the size, by weights 1 3 3 1 in both directions; pixel x is at 2 x + 1/2.
GreyPlane halved(const GreyPlane& from) {
  GreyPlane to{from.width / 2, from.height / 2, {}, {}, {}};
  to.grey.resize(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height));
  constexpr std::array<float, 4> kWeights = {0.125F, 0.375F, 0.375F, 0.125F};
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      float sum = 0;
      for (int v = 0; v < 4; ++v) {
        const int row = std::clamp(2 * y + v - 1, 0, from.height - 1);
        float line = 0;
        for (int u = 0; u < 4; ++u)
          line += kWeights[static_cast<std::size_t>(u)] *
                  from.grey[from.index(std::clamp(2 * x + u - 1, 0, from.width - 1), row)];
        sum += kWeights[static_cast<std::size_t>(v)] * line;
      }
      to.grey[to.index(x, y)] = sum;
    }
  }
  return to;
}

bool holds(const GreyPlane& level, const Eigen::Vector2d& at, int reach) {
  return at.x() >= reach && at.y() >= reach && at.x() < level.width - 1 - reach && at.y() < level.height - 1 - reach;
}

/// Bilinear samples, `side` x `side` of them, around a position that holds() with half the side.
QUADEDGE_VECTOR_CLONES
void cut(const GreyPlane& plane, const Eigen::Vector2d& at, int side, float* out) {
  const int x = static_cast<int>(at.x()), y = static_cast<int>(at.y());
  const auto right = static_cast<float>(at.x() - x), below = static_cast<float>(at.y() - y);
  const float w00 = (1 - right) * (1 - below), w01 = right * (1 - below), w10 = (1 - right) * below,
              w11 = right * below;
  for (int row = 0; row < side; ++row, out += side) {
    const float* const here = &plane.grey[plane.index(x - side / 2, y - side / 2 + row)];
    const float* const under = here + plane.width;
    for (int i = 0; i < side; ++i) out[i] = w00 * here[i] + w01 * here[i + 1] + w10 * under[i] + w11 * under[i + 1];
  }
}

using Square = std::array<float, static_cast<std::size_t>(kSide) * kSide>;

Square cut(const GreyPlane& level, const Eigen::Vector2d& at) {
  Square square;
  cut(level, at, kSide, square.data());
  return square;
}

/// Sum of products of two squares, each column for itself, so that it does not depend on the width of vectors.
QUADEDGE_VECTOR_CLONES
double product(const Square& one, const Square& other) {
  float sums[kSide] = {};
  for (std::size_t row = 0; row < one.size(); row += kSide)
    for (std::size_t i = 0; i < kSide; ++i) sums[i] += one[row + i] * other[row + i];
  double sum = 0;
  for (const float column : sums) sum += static_cast<double>(column);
  return sum;
}

/// The patch with mean 0 and norm 1; a flat one stays as it is. \param contrast gets its norm
Square equalised(Square square, float* contrast = nullptr) {
  const float mean = std::accumulate(square.begin(), square.end(), 0.0F) / (kSide * kSide);
  for (float& value : square) value -= mean;
  const auto norm = static_cast<float>(std::sqrt(std::max(1e-6, product(square, square))));
  for (float& value : square) value /= norm;
  if (contrast != nullptr) *contrast = norm;
  return square;
}

/// A patch with its gradients.
struct Template {
  Square equal, slope_x, slope_y;
  float contrast = 0;  ///< of the patch that `equal` is made from
  Eigen::Matrix2d inverse;
  bool is_corner = false;
};

Template template_at(const GreyPlane& level, const Eigen::Vector2d& at) {
  constexpr std::size_t kWide = kSide + 2;
  std::array<float, kWide * kWide> wide;
  cut(level, at, kWide, wide.data());
  Template patch;
  for (std::size_t row = 0; row < kSide; ++row) {
    for (std::size_t i = 0; i < kSide; ++i) {
      const std::size_t to = row * kSide + i, middle = (row + 1) * kWide + i + 1;
      patch.equal[to] = wide[middle];
      patch.slope_x[to] = 0.5F * (wide[middle + 1] - wide[middle - 1]);
      patch.slope_y[to] = 0.5F * (wide[middle + kWide] - wide[middle - kWide]);
    }
  }
  patch.equal = equalised(patch.equal, &patch.contrast);
  Eigen::Matrix2d normal;
  const double xy = product(patch.slope_x, patch.slope_y);
  normal << product(patch.slope_x, patch.slope_x), xy, xy, product(patch.slope_y, patch.slope_y);
  const double trace = normal.trace(), determinant = normal.determinant();
  patch.is_corner = determinant > kMinRoundness * trace * trace && trace > kSide * kSide;
  if (patch.is_corner) patch.inverse = normal.inverse();
  return patch;
}

/// Moves `at` to where the patch is; returns whether it stays inside the image. Whether it has settled, the way back
/// shows.
bool align(const Template& patch, const GreyPlane& to, Eigen::Vector2d& at) {
  Eigen::Vector2d position = at;
  for (int step = 0; step < kSteps; ++step) {
    if (!holds(to, position, kHalf + 1)) return false;
    Square difference = equalised(cut(to, position));
    for (std::size_t i = 0; i < difference.size(); ++i)
      difference[i] = patch.contrast * (patch.equal[i] - difference[i]);
    const Eigen::Vector2d move =
        patch.inverse * Eigen::Vector2d(product(patch.slope_x, difference), product(patch.slope_y, difference));
    position += move;
    if (move.norm() < kSettledShift) break;
  }
  if (!holds(to, position, kHalf + 1)) return false;
  at = position;
  return true;
}

Eigen::Vector2d reduced(const Eigen::Vector2d& at, double scale) {
  return (at.array() + 0.5).matrix() / scale - Eigen::Vector2d(0.5, 0.5);
}

/// One way: down the levels. A level on which the patch leaves the image changes nothing, except the last one.
std::optional<Eigen::Vector2d> search(const FlowImage& from, const FlowImage& to, const Eigen::Vector2d& at,
                                      Eigen::Vector2d position) {
  const std::size_t count = std::min(from.size(), to.size());
  for (std::size_t k = count; k-- > 0;) {
    const double scale = static_cast<double>(1 << k);
    const Eigen::Vector2d here = reduced(at, scale);
    Eigen::Vector2d there = reduced(position, scale);
    const bool is_last = k == 0;
    if (!holds(from[k], here, kHalf + 2)) {
      if (is_last) return std::nullopt;
      continue;
    }
    const Template patch = template_at(from[k], here);
    const bool found = patch.is_corner && align(patch, to[k], there);
    if (!found && is_last) return std::nullopt;
    if (found) position = ((there.array() + 0.5) * scale - 0.5).matrix();
  }
  return position;
}

double correlation(const GreyPlane& from, const Eigen::Vector2d& at, const GreyPlane& to,
                   const Eigen::Vector2d& found) {
  return product(equalised(cut(from, at)), equalised(cut(to, found)));
}

}  // namespace

FlowImage pyramid(const ImageView& recorded) {
  FlowImage levels{{recorded.width, recorded.height, {}, {}, {}}};
  for (int y = 0; y < recorded.height; ++y)
    for (int x = 0; x < recorded.width; ++x) levels[0].grey.push_back(recorded.at(x, y));
  while (levels.size() < kLevels && std::min(levels.back().width, levels.back().height) >= 2 * kSmallestLevel)
    levels.push_back(halved(levels.back()));
  return levels;
}

std::vector<Eigen::Vector2d> flow_corners(const FlowImage& image, int count) {
  GreyPlane plane = image.front();
  measure_patches(plane);
  const double area = static_cast<double>(plane.width) * plane.height;
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector2i& corner : find_corners(plane, std::max(kCell, static_cast<int>(std::sqrt(area / count)))))
    corners.push_back(corner.cast<double>());
  return corners;
}

std::optional<FlowMatch> follow(const FlowImage& from, const FlowImage& to, const Eigen::Vector2d& at,
                                const Eigen::Vector2d& start) {
  const auto there = search(from, to, at, start);
  if (!there) return std::nullopt;
  // Back from a start that is off by as much as the first one was.
  const auto back = search(to, from, *there, at + (start - *there));
  if (!back || (*back - at).cwiseAbs().maxCoeff() > kMaxReturn) return std::nullopt;
  const double likeness = correlation(from.front(), at, to.front(), *there);
  if (likeness < kMinFlowCorrelation) return std::nullopt;
  return FlowMatch{*there, likeness};
}

}  // namespace quadedge::rig
