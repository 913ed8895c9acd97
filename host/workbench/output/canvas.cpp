/// \file canvas.cpp  Enlarges by whole factors; positions in fixed point, so that OpenCV draws between pixels.
#include "output/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/image_file.hpp"

namespace quadedge::report {
namespace {

constexpr int kSmallestWidth = 1000;  // px; narrower images are enlarged so that strokes can be distinguished
constexpr int kLargestScale = 4;

int scale_for(int width) {
  int scale = 1;
  while (scale < kLargestScale && width * scale < kSmallestWidth) ++scale;
  return scale;
}

}  // namespace

Canvas::Canvas(const ImageView& image, double brightness, int legend_lines)
    : scale_(scale_for(image.width)), image_height_(image.height * scale_) {
  Image pixels = to_8_bits(image);
  const cv::Mat grey(image.height, image.width, CV_8UC1, pixels.pixels.data());
  cv::Mat large;
  cv::resize(grey, large, {}, scale_, scale_, cv::INTER_LINEAR);
  large.convertTo(large, CV_8UC1, brightness);
  picture_ = cv::Mat::zeros(large.rows + legend_lines * kLegendLine + 8, std::max(large.cols, kSmallestWidth), CV_8UC3);
  cv::Mat target = picture_(cv::Rect(0, 0, large.cols, large.rows));
  cv::cvtColor(large, target, cv::COLOR_GRAY2BGR);
}

cv::Point Canvas::position(double x, double y) const {
  // Pixel centres are whole numbers on both sides of the enlargement.
  const auto fixed_point = [this](double value) {
    return static_cast<int>(std::lround(((value + 0.5) * scale_ - 0.5) * (1 << kPositionShift)));
  };
  return {fixed_point(x), fixed_point(y)};
}

int Canvas::legend_y(int line) const { return image_height_ + (line + 1) * kLegendLine - 6; }

int put_text(cv::Mat& picture, const std::string& text, int x, int y, const cv::Scalar& colour, double size) {
  cv::putText(picture, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, size, colour, 1, cv::LINE_AA);
  int baseline = 0;
  return x + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &baseline).width;
}

cv::Scalar wheel_colour(double turn) {
  static const std::vector<cv::Scalar> wheel = [] {
    cv::Mat hsv(1, 180, CV_8UC3), bgr;
    for (int i = 0; i < 180; ++i) hsv.at<cv::Vec3b>(0, i) = {static_cast<unsigned char>(i), 220, 255};
    cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
    std::vector<cv::Scalar> colours;
    for (int i = 0; i < 180; ++i) colours.emplace_back(bgr.at<cv::Vec3b>(0, i));
    return colours;
  }();
  return wheel[static_cast<std::size_t>(std::min(static_cast<int>((turn - std::floor(turn)) * 180.0), 179))];
}

void write_png(const std::string& path, const cv::Mat& picture) {
  data::write_atomically(path, data::encode_png(picture));
}

void write_jpeg(const std::string& path, const cv::Mat& picture) {
  constexpr int kQuality = 75;
  data::write_atomically(path, data::encode_jpeg(picture, kQuality));
}

void write_image(const std::string& path, const ImageView& image) {
  Image grey = to_8_bits(image);
  write_png(path, cv::Mat(grey.height, grey.width, CV_8U, grey.pixels.data()));
}

}  // namespace quadedge::report
