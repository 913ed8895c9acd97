#include "data/samples.hpp"

#include <cstdint>
#include <opencv2/imgproc.hpp>

namespace quadedge::data {

void from_big_endian(cv::Mat& samples) {
  if (samples.depth() != CV_16U) return;
  for (int y = 0; y < samples.rows; ++y) {
    auto* words = samples.ptr<std::uint16_t>(y);
    const std::uint8_t* bytes = samples.ptr(y);
    for (int i = 0; i < samples.cols * samples.channels(); ++i)
      words[i] = static_cast<std::uint16_t>(bytes[2 * i] << 8 | bytes[2 * i + 1]);
  }
}

Image grey_image(const cv::Mat& samples, int max_value) {
  cv::Mat grey = samples;
  if (samples.channels() == 3) cv::cvtColor(samples, grey, cv::COLOR_RGB2GRAY);
  Image image(samples.cols, samples.rows, max_value);
  const cv::Mat target(image.height, image.width, max_value > kMaxValue8 ? CV_16UC1 : CV_8UC1, image.pixels.data());
  cv::min(grey, max_value, target);
  return image;
}

}  // namespace quadedge::data
