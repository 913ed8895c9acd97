#include "report/match_view.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "report/canvas.hpp"

namespace quadedge::report {
namespace {

constexpr int kPairWidth = 1900;  // px of the picture that a pair should fill, at a whole scale
constexpr int kGap = 6;           // px between views
constexpr int kRegions = 3;
constexpr double kRegionWidth = 72, kRegionHeight = 54;  // px of the image
constexpr double kWholeBrightness = 0.5, kDetailBrightness = 0.7;

double middle(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

MatchView::MatchView(cv::Mat& picture, const cv::Rect& rectangle, const Image& image, const cv::Rect2d& region,
                     double brightness)
    : view_(picture(rectangle)), region_(region), scale_(rectangle.width / region.width) {
  Image pixels = to_8_bits(image.view());
  const cv::Mat grey(pixels.height, pixels.width, CV_8UC1, pixels.pixels.data());
  cv::Mat part;
  cv::resize(grey(cv::Rect(region)), part, rectangle.size(), 0, 0, scale_ > 2 ? cv::INTER_CUBIC : cv::INTER_LINEAR);
  part.convertTo(part, CV_8UC1, brightness);
  cv::cvtColor(part, view_, cv::COLOR_GRAY2BGR);
}

cv::Point MatchView::position(double x, double y) const {
  const auto fixed_point = [this](double value, double from) {
    return static_cast<int>(std::lround(((value - from + 0.5) * scale_ - 0.5) * (1 << kPositionShift)));
  };
  return {fixed_point(x, region_.x), fixed_point(y, region_.y)};
}

void MatchView::stroke(double x, double y, double direction, double half_length, int dot, const cv::Scalar& colour) {
  if (dot > 0) {
    cv::circle(view_, position(x, y), dot << kPositionShift, colour, cv::FILLED, cv::LINE_AA, kPositionShift);
    return;
  }
  const double dx = half_length * std::cos(direction), dy = half_length * std::sin(direction);
  cv::line(view_, position(x - dx, y - dy), position(x + dx, y + dy), colour, scale_ > 3 ? 2 : 1, cv::LINE_AA,
           kPositionShift);
}

void MatchView::mark(double x, double y, int marker, const cv::Scalar& colour) {
  cv::drawMarker(view_, position(x, y) / (1 << kPositionShift), colour, marker, kMarkerSize, 2, cv::LINE_AA);
}

void MatchView::link(double x, double y, double true_x, double true_y, const cv::Scalar& colour) {
  cv::line(view_, position(x, y), position(true_x, true_y), colour, 1, cv::LINE_AA, kPositionShift);
  cv::circle(view_, position(true_x, true_y), (scale_ > 3 ? 4 : 3) << kPositionShift, colour, 1, cv::LINE_AA,
             kPositionShift);
}

void MatchView::frame(const cv::Rect2d& region, const std::string& number, const cv::Scalar& colour) {
  const auto whole = [&](double x, double y) { return position(x, y) / (1 << kPositionShift); };
  const cv::Point low = whole(region.x, region.y),
                  high = whole(region.x + region.width - 1, region.y + region.height - 1);
  cv::rectangle(view_, low, high, colour, 1);
  const int text_x = high.x + 16 > view_.cols ? low.x - 14 : high.x + 4;
  cv::putText(view_, number, {text_x, low.y + 13}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {0, 0, 0}, 3, cv::LINE_AA);
  put_text(view_, number, text_x, low.y + 13, colour);
}

void MatchView::label(const std::string& text, const cv::Scalar& colour) {
  cv::putText(view_, text, {6, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.6, {0, 0, 0}, 4, cv::LINE_AA);
  put_text(view_, text, 6, 20, colour, 0.6);
}

PairLayout::PairLayout(int left_width, int left_height, int right_width, int right_height, int text_lines)
    : left_width_(left_width), left_height_(left_height), right_width_(right_width), right_height_(right_height) {
  scale_ = std::max(1, kPairWidth / (left_width + right_width));
  top_ = text_lines * kLegendLine;
  width_ = std::max((left_width + right_width) * scale_ + kGap, 1000);
  pair_bottom_ = top_ + std::max(left_height, right_height) * scale_;
  detail_top_ = pair_bottom_ + kGap;
  const int one = (width_ - (kRegions - 1) * 3 * kGap) / kRegions;
  detail_.width = (one - kGap) / 2;
  detail_.height = static_cast<int>(std::lround(detail_.width * kRegionHeight / kRegionWidth));
}

std::vector<PairLayout::Region> PairLayout::choose_regions(const evaluation::DrawnFrame& frame,
                                                           const std::vector<std::size_t>& chosen) const {
  std::vector<Region> regions;
  if (std::min(left_width_, right_width_) < kRegionWidth || std::min(left_height_, right_height_) < kRegionHeight)
    return regions;
  // Candidates overlap by half, so every match lies in up to four of them.
  const double step_x = kRegionWidth / 2, step_y = kRegionHeight / 2;
  const int columns = static_cast<int>((left_width_ - kRegionWidth) / step_x) + 1;
  const int rows = static_cast<int>((left_height_ - kRegionHeight) / step_y) + 1;
  std::vector<std::vector<std::size_t>> members(static_cast<std::size_t>(columns * rows));
  for (const std::size_t i : chosen) {
    const int column = static_cast<int>(frame.matches[i].left_x / step_x),
              row = static_cast<int>(frame.matches[i].left_y / step_y);
    for (const int c : {column - 1, column}) {
      for (const int r : {row - 1, row}) {
        if (c >= 0 && r >= 0 && c < columns && r < rows)
          members[static_cast<std::size_t>(r * columns + c)].push_back(i);
      }
    }
  }
  const auto rectangle = [&](std::size_t k) {
    const int column = static_cast<int>(k) % columns, line = static_cast<int>(k) / columns;
    return cv::Rect2d(column * step_x, line * step_y, kRegionWidth, kRegionHeight);
  };
  while (regions.size() < kRegions) {
    std::size_t best = 0, most = 0;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const bool apart = std::all_of(regions.begin(), regions.end(), [&](const Region& region) {
        const cv::Rect2d wide(region.left.x - step_x, region.left.y - step_y, 2 * kRegionWidth, 2 * kRegionHeight);
        return (wide & rectangle(k)).area() == 0;
      });
      if (apart && members[k].size() > most) best = k, most = members[k].size();
    }
    if (most == 0) break;
    // The right view shows what the left one shows: it is moved by the middle of the true displacements.
    std::vector<double> dx, dy;
    for (const std::size_t i : members[best]) {
      const auto& match = frame.matches[i];
      const bool known = std::isfinite(match.true_x);
      dx.push_back((known ? match.true_x : match.right_x) - match.left_x);
      dy.push_back((known ? match.true_y : match.right_y) - match.left_y);
    }
    const cv::Rect2d left = rectangle(best);
    const double right_x = std::clamp(std::round(left.x + middle(dx)), 0.0, right_width_ - kRegionWidth);
    const double right_y = std::clamp(std::round(left.y + middle(dy)), 0.0, right_height_ - kRegionHeight);
    regions.push_back({left, {right_x, right_y, kRegionWidth, kRegionHeight}});
  }
  return regions;
}

cv::Mat PairLayout::blank(bool with_details) const {
  return cv::Mat::zeros(with_details ? detail_top_ + detail_.height : pair_bottom_, width_, CV_8UC3);
}

MatchView PairLayout::whole(cv::Mat& picture, const Image& image, Side side) const {
  const bool right = side == Side::right;
  const int width = right ? right_width_ : left_width_, height = right ? right_height_ : left_height_;
  const cv::Rect area(right ? left_width_ * scale_ + kGap : 0, top_, width * scale_, height * scale_);
  return {picture, area, image, cv::Rect2d(0, 0, width, height), kWholeBrightness};
}

MatchView PairLayout::detail(cv::Mat& picture, const Image& image, const cv::Rect2d& region, std::size_t number,
                             Side side) const {
  const int left = static_cast<int>(number) * (2 * detail_.width + kGap + 3 * kGap) +
                   (side == Side::right ? detail_.width + kGap : 0);
  return {picture, cv::Rect({left, detail_top_}, detail_), image, region, kDetailBrightness};
}

}  // namespace quadedge::report
