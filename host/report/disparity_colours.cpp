#include "report/disparity_colours.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

constexpr int kLevels = 256;

}  // namespace

DisparityColours::DisparityColours(const std::vector<double>& disparities)
    : largest_(disparities.empty() ? 1.0 : std::max(percentile(disparities, 0.98), 1e-3)) {
  cv::Mat levels(1, kLevels, CV_8UC1), bgr;
  for (int i = 0; i < kLevels; ++i) levels.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
  cv::applyColorMap(levels, bgr, cv::COLORMAP_VIRIDIS);
  for (int i = 0; i < kLevels; ++i) {
    const auto colour = bgr.at<cv::Vec3b>(0, i);
    colours_.emplace_back(colour[0], colour[1], colour[2]);
  }
}

cv::Scalar DisparityColours::of(double disparity) const {
  return colours_[static_cast<std::size_t>(std::clamp(disparity / largest_, 0.0, 1.0) * (kLevels - 1))];
}

int DisparityColours::draw_bar(cv::Mat& picture, int x, int y) const {
  for (const auto& colour : colours_) {
    cv::line(picture, {x, y - 14}, {x, y}, colour);
    ++x;
  }
  return x;
}

}  // namespace quadedge::report
