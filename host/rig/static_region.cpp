#include "rig/static_region.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kReduction = 4;  ///< image pixels per reduced pixel and axis
constexpr int kReducedCell = kStaticCell / kReduction;

/// Reduced grey levels of a cell, zero-mean and of unit length; empty if the cell is flat.
std::vector<float> texture_of(const PinholeView& view, int column, int row) {
  std::vector<float> texture(kReducedCell * kReducedCell);
  float sum = 0;
  for (int y = 0; y < kReducedCell; ++y) {
    for (int x = 0; x < kReducedCell; ++x) {
      const double u = column * kStaticCell + kReduction * (x + 0.5) - 0.5,
                   v = row * kStaticCell + kReduction * (y + 0.5) - 0.5;
      float& level = texture[static_cast<std::size_t>(y * kReducedCell + x)];
      level = 0.25F * (view.at(u - 1, v - 1) + view.at(u + 1, v - 1) + view.at(u - 1, v + 1) + view.at(u + 1, v + 1));
      sum += level;
    }
  }
  const auto count = static_cast<float>(texture.size());
  float squares = 0;
  for (float& level : texture) {
    level -= sum / count;
    squares += level * level;
  }
  if (squares < static_cast<float>(kStaticTexture * kStaticTexture) * count) return {};
  for (float& level : texture) level /= std::sqrt(squares);
  return texture;
}

/// Normalised correlation of two textures; 0 if one of them is flat.
double correlation(const std::vector<float>& one, const std::vector<float>& other) {
  if (one.size() != other.size()) return 0;
  float sum = 0;
  for (std::size_t i = 0; i < one.size(); ++i) sum += one[i] * other[i];
  return static_cast<double>(sum);
}

}  // namespace

std::optional<StaticRegion> StaticRegionDetector::observe(const PinholeView& left,
                                                          const std::vector<CornerMatch>& matches) {
  if (cells_.empty()) {
    start(left);
    return std::nullopt;
  }
  for (const CornerMatch& match : matches) {
    const int column = static_cast<int>(match.left.x()) / kStaticCell,
              row = static_cast<int>(match.left.y()) / kStaticCell;
    if (column >= columns_ || row >= rows_) continue;
    Cell& cell = cells_[static_cast<std::size_t>(row * columns_ + column)];
    cell.inverse_depths += match.inverse_depth;
    ++cell.matches;
  }
  if (++frames_ % kStaticPeriod != 0) return std::nullopt;
  compare(left);
  if (frames_ < kStaticWindow) return std::nullopt;
  const auto region = judge();
  start(left);
  return region;
}

/// Starts a window with this image.
void StaticRegionDetector::start(const PinholeView& left) {
  columns_ = left.width() / kStaticCell;
  rows_ = left.height() / kStaticCell;
  frames_ = 0;
  cells_.assign(static_cast<std::size_t>(columns_ * rows_), {});
  for (std::size_t i = 0; i < cells_.size(); ++i)
    cells_[i].texture = texture_of(left, static_cast<int>(i) % columns_, static_cast<int>(i) / columns_);
}

void StaticRegionDetector::compare(const PinholeView& left) {
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    Cell& cell = cells_[i];
    if (cell.texture.empty()) continue;
    const double same =
        correlation(cell.texture, texture_of(left, static_cast<int>(i) % columns_, static_cast<int>(i) / columns_));
    if (same < kStaticCorrelation) cell.is_static = false;
    if (same < kChangedCorrelation) ++cell.changes;
  }
}

std::optional<StaticRegion> StaticRegionDetector::judge() const {
  struct Part {
    double cells = 0;
    int matches = 0;
    std::vector<double> inverse_depths;  // means of the cells that have matches
  };
  Part still, moving;
  StaticRegion region;
  double textured = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (cell.texture.empty()) continue;
    ++textured;
    if (cell.is_static) region.bounds.extend(bounds(i));
    if (!cell.is_static && 2 * cell.changes <= kStaticWindow / kStaticPeriod) continue;
    Part& part = cell.is_static ? still : moving;
    ++part.cells;
    part.matches += cell.matches;
    if (cell.matches > 0) part.inverse_depths.push_back(cell.inverse_depths / cell.matches);
  }
  region.ratio = still.cells / std::max(textured, 1.0);
  const bool is_part = region.ratio > kMinStaticRatio && moving.cells > kMinMovingRatio * textured;
  if (!is_part || std::min(still.matches, moving.matches) < kMinStaticMatches ||
      upper_median(still.inverse_depths) <= upper_median(moving.inverse_depths))
    return std::nullopt;
  return region;
}

Eigen::AlignedBox2d StaticRegionDetector::bounds(std::size_t cell) const {
  const Eigen::Vector2d corner(static_cast<int>(cell) % columns_, static_cast<int>(cell) / columns_);
  return {kStaticCell * corner, kStaticCell * (corner + Eigen::Vector2d::Ones())};
}

}  // namespace quadedge::rig
