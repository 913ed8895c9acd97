#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "benchmark/latency.hpp"
#include "common/numeric.hpp"
#include "common/timing.hpp"

namespace quadedge::bench {
namespace {

constexpr double kSigma = 2;  // of the edges [px]
constexpr int kFilters = 9;   // as many as third-order edges have derivatives

cv::Mat grey_matrix(const Image& image) {
  Image grey = to_8_bits(image.view());
  return cv::Mat(grey.height, grey.width, CV_8UC1, grey.pixels.data()).clone();
}

template <class Function>
double milliseconds(const Function& work) {
  const auto start = Clock::now();
  work();
  return milliseconds_since(start);
}

}  // namespace

Yardsticks measure_yardsticks(const FramePrefetcher::Frame& frame, int samples, int threads, int repetitions,
                              const std::function<void(int done, int total)>& progress) {
  const int threads_before = cv::getNumThreads();
  cv::setNumThreads(threads);
  const auto sift = cv::SIFT::create();
  cv::Mat grid, filtered, descriptors;
  cv::resize(grey_matrix(frame.left), grid, {}, samples, samples, cv::INTER_LINEAR);
  grid.convertTo(grid, CV_32F);
  const double sigma = kSigma * samples;
  const cv::Mat taps = cv::getGaussianKernel(2 * kernel_radius(sigma) + 1, sigma, CV_32F);
  std::vector<cv::KeyPoint> points;
  const auto both_sifts = [&] {
    for (const auto* image : {&frame.left, &frame.right})
      sift->detectAndCompute(grey_matrix(*image), cv::noArray(), points, descriptors);
  };
  const auto nine_filters = [&] {
    for (int i = 0; i < kFilters; ++i) cv::sepFilter2D(grid, filtered, CV_32F, taps, taps);
  };
  both_sifts();
  nine_filters();
  Yardsticks result;
  result.threads = threads;
  for (int i = 0; i < repetitions; ++i) {
    result.sift_both_ms.push_back(milliseconds(both_sifts));
    result.sepfilter_nine_ms.push_back(milliseconds(nine_filters));
    progress(i + 1, repetitions);
  }
  cv::setNumThreads(threads_before);
  return result;
}

}  // namespace quadedge::bench
