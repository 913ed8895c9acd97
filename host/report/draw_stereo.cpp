/// \file draw_stereo.cpp  Picture of a pair's stereo edges.
#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "data/text.hpp"
#include "report/canvas.hpp"
#include "report/drawing.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

constexpr double kBrightness = 0.35;

cv::Scalar colour_of(double fraction) {
  cv::Mat value(1, 1, CV_8U, cv::Scalar(255 * std::clamp(fraction, 0.0, 1.0))), colour;
  cv::applyColorMap(value, colour, cv::COLORMAP_TURBO);
  const auto bgr = colour.at<cv::Vec3b>(0, 0);
  return {static_cast<double>(bgr[0]), static_cast<double>(bgr[1]), static_cast<double>(bgr[2])};
}

}  // namespace

void draw_stereo(const std::string& path, const ImageView& left, const StereoEdges& edges) {
  Canvas canvas(left, kBrightness, 2);
  std::vector<double> disparities;
  for (std::size_t i = 0; i < edges.size(); ++i) disparities.push_back(edges.left_x[i] - edges.right_x[i]);
  const double low = edges.size() > 0 ? percentile(disparities, 0.02) : 0;
  const double high = edges.size() > 0 ? std::max(percentile(disparities, 0.98), low + 1) : 1;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    cv::circle(canvas.picture(), canvas.position(edges.left_x[i], edges.left_y[i]), 1 << kPositionShift,
               colour_of((disparities[i] - low) / (high - low)), cv::FILLED, cv::LINE_AA, kPositionShift);
  }
  const cv::Scalar white(255, 255, 255);
  put_text(canvas.picture(), std::to_string(edges.size()) + " stereo edges, coloured by disparity", 10,
           canvas.legend_y(0), white);
  const int y = canvas.legend_y(1);
  int x = put_text(canvas.picture(), data::format_fixed(low, 1) + " px", 10, y, white) + 8;
  for (int i = 0; i < 256; ++i, ++x) cv::line(canvas.picture(), {x, y - 12}, {x, y + 2}, colour_of(i / 255.0));
  put_text(canvas.picture(), data::format_fixed(high, 1) + " px", x + 8, y, white);
  write_png(path, canvas.picture());
}

}  // namespace quadedge::report
