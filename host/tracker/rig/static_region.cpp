/// \file static_region.cpp  Correlates reduced cells with those at a window's start; what is static has to be nearer.
#include "rig/static_region.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {
namespace {

constexpr int kReducedCell = PinholeView::kBlock, kReduction = kStaticCell / kReducedCell;  ///< px per reduced pixel
constexpr int kReducedStep = kStaticStep / kReduction, kStepsPerCell = kStaticCell / kStaticStep;

/// Sets reduced grey levels of the whole cells of a view, row-major: samples between four pixels, which are their mean.
void reduce_levels(const PinholeView& view, int columns, int rows, std::vector<float>& levels) {
  const int width = columns * kReducedCell;
  levels.resize(static_cast<std::size_t>(width * rows * kReducedCell));
  float block[kReducedCell * kReducedCell];
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d middle = kStaticCell * (Eigen::Vector2d(column, row).array() + 0.5) + 0.5;
      view.patch(middle, static_cast<double>(kReduction) * Eigen::Matrix2d::Identity())
          .sample(-kReducedCell / 2, kReducedCell / 2 - 1, block);
      for (int y = 0; y < kReducedCell; ++y)
        std::copy_n(block + y * kReducedCell, kReducedCell,
                    &levels[static_cast<std::size_t>((row * kReducedCell + y) * width + column * kReducedCell)]);
    }
  }
}

/// Normalised correlation of two squares of a cell's size; 0 if one of them is flat.
/// \param width of the levels that hold them
double correlation(const float* one, const float* other, int width) {
  constexpr float kCount = kReducedCell * kReducedCell;
  float sum = 0, sum_other = 0, squares = 0, squares_other = 0, products = 0;
  for (int y = 0; y < kReducedCell; ++y, one += width, other += width) {
    for (int x = 0; x < kReducedCell; ++x) {
      sum += one[x];
      sum_other += other[x];
      squares += one[x] * one[x];
      squares_other += other[x] * other[x];
      products += one[x] * other[x];
    }
  }
  squares -= sum * sum / kCount;
  squares_other -= sum_other * sum_other / kCount;
  constexpr auto kFlatSquares = static_cast<float>(kStaticTexture * kStaticTexture) * kCount;
  if (squares < kFlatSquares || squares_other < kFlatSquares) return 0;
  return static_cast<double>((products - sum * sum_other / kCount) / std::sqrt(squares * squares_other));
}

/// Marks of a grid, each spread by `before` and `after` in both directions.
std::vector<std::uint8_t> spread(const std::vector<std::uint8_t>& marks, int columns, int before, int after) {
  const int rows = static_cast<int>(marks.size()) / columns;
  std::vector<std::uint8_t> result(marks.size(), 0);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (marks[static_cast<std::size_t>(row * columns + column)] == 0) continue;
      const int left = std::max(column - before, 0), right = std::min(column + after, columns - 1);
      for (int y = std::max(row - before, 0); y <= std::min(row + after, rows - 1); ++y)
        std::fill(&result[static_cast<std::size_t>(y * columns + left)],
                  &result[static_cast<std::size_t>(y * columns + right)] + 1, 1);
    }
  return result;
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
  reduce_levels(left, columns_, rows_, current_);
  compare(current_);
  if (is_at_rest()) start(left);
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
  is_static_.assign(cells_.size() * kStepsPerCell * kStepsPerCell, 1);
  reduce_levels(left, columns_, rows_, start_);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const float* const levels = &start_[reduced(place_of(i))];
    cells_[i].is_textured = correlation(levels, levels, columns_ * kReducedCell) > 0;
  }
}

/// \param levels of the current image, reduced
void StaticRegionDetector::compare(const std::vector<float>& levels) {
  const int places = columns_ * kStepsPerCell, last_column = places - kStepsPerCell,
            last_row = (rows_ - 1) * kStepsPerCell;
  for (std::size_t i = 0; i < is_static_.size(); ++i) {
    const int column = static_cast<int>(i) % places, row = static_cast<int>(i) / places;
    Cell* const cell = column % kStepsPerCell == 0 && row % kStepsPerCell == 0
                           ? &cells_[static_cast<std::size_t>(row / kStepsPerCell * columns_ + column / kStepsPerCell)]
                           : nullptr;
    if (cell == nullptr && is_static_[i] == 0) continue;
    const bool fits = column <= last_column && row <= last_row;
    const std::size_t at = reduced(i);
    const double same = fits ? correlation(&start_[at], &levels[at], columns_ * kReducedCell) : 0;
    if (same < kStaticCorrelation) is_static_[i] = 0;
    if (cell != nullptr && cell->is_textured && same < kChangedCorrelation) ++cell->changes;
  }
}

/// Whether nothing has moved since the start of the window.
bool StaticRegionDetector::is_at_rest() const {
  double textured = 0, still = 0;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (!cells_[i].is_textured) continue;
    ++textured;
    still += is_static_[place_of(i)];
  }
  return still > kRestRatio * textured;
}

std::optional<StaticRegion> StaticRegionDetector::judge() const {
  Part textured, still, moving;
  StaticRegion region;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Cell& cell = cells_[i];
    if (!cell.is_textured) continue;
    const Eigen::Vector2d place = bounds(i).min() / kStaticCell;
    textured.add(place, cell.inverse_depths, cell.matches);
    const bool is_still = is_static_[place_of(i)] != 0;
    if (is_still) region.bounds.extend(bounds(i));
    if (!is_still && 2 * cell.changes <= frames_ / kStaticPeriod) continue;
    (is_still ? still : moving).add(place, cell.inverse_depths, cell.matches);
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

/// The static squares and the gaps in them, such as what they mirror, and a border, since edges lie there.
PixelMask StaticRegionDetector::static_mask() const {
  PixelMask mask;
  mask.width = width_;
  mask.height = height_;
  mask.hidden.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  const int places = columns_ * kStepsPerCell;
  const auto invert = [](std::vector<std::uint8_t> marks) {
    for (std::uint8_t& mark : marks) mark ^= 1;
    return marks;
  };
  const auto filled = spread(spread(is_static_, places, 0, kStepsPerCell - 1), places, kStepsPerCell, kStepsPerCell);
  const auto hidden = invert(spread(invert(filled), places, kStepsPerCell, kStepsPerCell));
  constexpr int kBorder = kStaticStep / 2;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      for (const int corner : {0, 1, 2, 3}) {
        const int row = (y + (corner < 2 ? -kBorder : kBorder)) / kStaticStep,
                  column = (x + (corner % 2 == 0 ? -kBorder : kBorder)) / kStaticStep;
        mask.hidden[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)] |=
            hidden[static_cast<std::size_t>(std::min(row, rows_ * kStepsPerCell - 1) * places +
                                            std::min(column, places - 1))];
      }
  return mask;
}

/// Whether most of what the mask covers changes in most comparisons.
bool StaticRegionDetector::masked_cells_move() const {
  int covered = 0, moving = 0;
  for (std::size_t i = 0; i < cells_.size() && !mask_.empty(); ++i) {
    const Eigen::Vector2i centre = bounds(i).center().cast<int>();
    if (!cells_[i].is_textured || mask_.hidden[static_cast<std::size_t>(centre.y() * width_ + centre.x())] == 0)
      continue;
    ++covered;
    moving += 2 * cells_[i].changes > frames_ / kStaticPeriod ? 1 : 0;
  }
  return 2 * moving > covered;
}

std::size_t StaticRegionDetector::place_of(std::size_t cell) const {
  const auto columns = static_cast<std::size_t>(columns_);
  return kStepsPerCell * (cell / columns * columns * kStepsPerCell + cell % columns);
}

/// Index among the reduced levels of the upper left corner of the square at a place.
std::size_t StaticRegionDetector::reduced(std::size_t place) const {
  const auto places = static_cast<std::size_t>(columns_ * kStepsPerCell);
  return kReducedStep * (place / places * places * kReducedStep + place % places);
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
