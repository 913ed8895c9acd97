/// \file draw_edges.cpp  Picture of third-order edges.
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "quadedge/pi.hpp"
#include "report/canvas.hpp"
#include "report/drawing.hpp"

namespace quadedge::report {
namespace {

constexpr double kEdgesBrightness = 0.35;
constexpr double kHalfStroke = 0.6;  // px of the image to either side of the edge

/// Colour wheel: one colour per hue step of OpenCV (2 degrees), full saturation.
std::vector<cv::Scalar> colour_wheel() {
  cv::Mat hsv(1, 180, CV_8UC3), bgr;
  for (int i = 0; i < 180; ++i) hsv.at<cv::Vec3b>(0, i) = {static_cast<unsigned char>(i), 220, 255};
  cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
  std::vector<cv::Scalar> colours;
  for (int i = 0; i < 180; ++i) {
    const auto colour = bgr.at<cv::Vec3b>(0, i);
    colours.emplace_back(colour[0], colour[1], colour[2]);
  }
  return colours;
}

const cv::Scalar& direction_colour(const std::vector<cv::Scalar>& wheel, double direction) {
  const double turn = direction / (2 * kPi);
  const auto index = static_cast<int>(std::floor((turn - std::floor(turn)) * 180.0));
  return wheel[static_cast<std::size_t>(std::min(index, 179))];
}

}  // namespace

void draw_edges(const std::string& path, const ImageView& image, const EdgeSet& edges) {
  Canvas canvas(image, kEdgesBrightness, 2);
  const auto wheel = colour_wheel();
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double dx = kHalfStroke * std::cos(edges.direction[i]), dy = kHalfStroke * std::sin(edges.direction[i]);
    cv::line(canvas.picture(), canvas.position(edges.x[i] - dx, edges.y[i] - dy),
             canvas.position(edges.x[i] + dx, edges.y[i] + dy), direction_colour(wheel, edges.direction[i]), 1,
             cv::LINE_AA, kPositionShift);
  }
  const cv::Scalar white(255, 255, 255);
  put_text(canvas.picture(),
           std::to_string(edges.size()) +
               " third-order edges, coloured by direction, "
               "which has the bright side on its right",
           10, canvas.legend_y(0), white);
  const int y = canvas.legend_y(1);
  int x = put_text(canvas.picture(), "-180 deg", 10, y, white) + 8;
  for (int i = 0; i < 360; ++i, ++x) {
    cv::line(canvas.picture(), {x, y - 12}, {x, y + 2}, direction_colour(wheel, (i - 180) * kPi / 180));
  }
  put_text(canvas.picture(), "+180 deg   (0: to the right, 90: down)", x + 8, y, white);
  write_png(path, canvas.picture());
}

}  // namespace quadedge::report
