/// \file static_region.cpp  Correlates reduced cells with those at a window's start; what is static has to be nearer.
#include "rig/static_region.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kReducedCell = PinholeView::kBlock;
constexpr double kReduction = kStaticCell / kReducedCell;  ///< image pixels per reduced pixel and axis

/// Reduced grey levels of a cell, zero-mean and of unit length; empty if the cell is flat.
std::vector<float> texture_of(const PinholeView& view, int column, int row) {
  constexpr double kMiddle = 0.5 * (kStaticCell - 1);
  std::vector<float> texture(kReducedCell * kReducedCell);
  view.reduced({column * kStaticCell + kMiddle, row * kStaticCell + kMiddle}, kReduction * Eigen::Matrix2d::Identity(),
               texture.data());
  const float sum = std::accumulate(texture.begin(), texture.end(), 0.0F);
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

/// Some of the textured cells.
struct Part {
  double cells = 0;
  int matches = 0;
  std::vector<double> inverse_depths = {};  ///< means of the cells that have matches
  Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();  ///< of their places [cells]

  void add(const Eigen::Vector2d& place, double inverse_depth_sum, int number) {
    ++cells;
    matches += number;
    if (number > 0) inverse_depths.push_back(inverse_depth_sum / number);
    sum += place;
    squares += place.cwiseProduct(place);
  }
  double median_inverse_depth() const {
    std::vector<double> values = inverse_depths;
    return upper_median(values);
  }
  bool is_nearer_than(const Part& other, double factor) const {
    return median_inverse_depth() > factor * other.median_inverse_depth();
  }
  /// Variances of the places in x and y.
  Eigen::Vector2d variance() const { return squares / cells - (sum / cells).cwiseProduct(sum / cells); }
  /// Whether it lies on all sides of the whole.
  bool surrounds(const Part& whole) const {
    return (variance().array() > kSurroundingVariance * whole.variance().array()).all();
  }
};

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
  if (frames_ != kCertainAfter && frames_ < kStaticWindow) return std::nullopt;
  auto region = judge();
  if (frames_ >= kStaticWindow) {
    start(left);
  } else if (region) {
    for (std::size_t i = 0; i < mask_.hidden.size(); ++i) region->mask.hidden[i] |= mask_.hidden[i];
    mask_ = region->mask;
  } else if (masked_cells_move()) {
    mask_ = {};
    region.emplace().is_released = true;
  }
  return region;
}

/// Starts a window with this image.
void StaticRegionDetector::start(const PinholeView& left) {
  columns_ = left.width() / kStaticCell;
  rows_ = left.height() / kStaticCell;
  width_ = left.width();
  height_ = left.height();
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
  Part textured, still, moving;
  StaticRegion region;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (cell.texture.empty()) continue;
    const Eigen::Vector2d place = bounds(i).min() / kStaticCell;
    textured.add(place, cell.inverse_depths, cell.matches);
    if (cell.is_static) region.bounds.extend(bounds(i));
    if (!cell.is_static && 2 * cell.changes <= frames_ / kStaticPeriod) continue;
    (cell.is_static ? still : moving).add(place, cell.inverse_depths, cell.matches);
  }
  if (std::min(still.matches, moving.matches) < kMinStaticMatches) return std::nullopt;
  const double changing = moving.cells / textured.cells;
  region.ratio = still.cells / textured.cells;
  const bool is_nearer =
      region.ratio > kMinStaticRatio && changing > kMinMovingRatio && still.is_nearer_than(moving, 1);
  if (frames_ >= kStaticWindow) return is_nearer ? std::optional(region) : std::nullopt;
  const bool is_surrounded = region.ratio > kMinSurroundedRatio && changing > kMinSurroundingRatio &&
                             moving.surrounds(textured) && still.is_nearer_than(moving, kSurroundedNearness);
  if (!is_nearer && !is_surrounded) return std::nullopt;
  region.mask = static_mask();
  return region;
}

/// The static cells and their neighbours, since the border of the region runs through these.
PixelMask StaticRegionDetector::static_mask() const {
  PixelMask mask;
  mask.width = width_;
  mask.height = height_;
  mask.hidden.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i].texture.empty() || !cells_[i].is_static) continue;
    const Eigen::Vector2d reach = Eigen::Vector2d::Constant(kStaticCell);
    const Eigen::Vector2i from = (bounds(i).min() - reach).cast<int>().cwiseMax(0),
                          to = (bounds(i).max() + reach).cast<int>().cwiseMin(Eigen::Vector2i(width_, height_));
    for (int y = from.y(); y < to.y(); ++y)
      std::fill_n(mask.hidden.begin() + static_cast<std::ptrdiff_t>(y) * width_ + from.x(), to.x() - from.x(), 1);
  }
  return mask;
}

/// Whether most of what the mask covers changes in most comparisons.
bool StaticRegionDetector::masked_cells_move() const {
  int covered = 0, moving = 0;
  for (std::size_t i = 0; i < cells_.size() && !mask_.empty(); ++i) {
    const Eigen::Vector2i centre = bounds(i).center().cast<int>();
    if (cells_[i].texture.empty() || mask_.hidden[static_cast<std::size_t>(centre.y() * width_ + centre.x())] == 0)
      continue;
    ++covered;
    moving += 2 * cells_[i].changes > frames_ / kStaticPeriod ? 1 : 0;
  }
  return 2 * moving > covered;
}

Eigen::AlignedBox2d StaticRegionDetector::bounds(std::size_t cell) const {
  const Eigen::Vector2d corner(static_cast<int>(cell) % columns_, static_cast<int>(cell) / columns_);
  return {kStaticCell * corner, kStaticCell * (corner + Eigen::Vector2d::Ones())};
}

std::string StaticRegion::text() const {
  return printed(
             "%.0f %% of the left image's texture, between columns %.0f and %.0f and rows %.0f and %.0f, does not "
             "move ",
             100 * ratio, bounds.min().x(), bounds.max().x(), bounds.min().y(), bounds.max().y()) +
         (mask.empty()
              ? "although it is nearer than most of what moves: is it part of the vehicle, or dirt? Use a mask to "
                "exclude it"
              : "while the rest does: it is masked from here on, as a part of the vehicle or dirt; "
                "--no-auto-mask keeps it");
}

}  // namespace quadedge::rig
