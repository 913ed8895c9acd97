/// \file latency.cpp  Times frames after warm-up and kernels in another pass; bisects for a number of edges.
#include "benchmark/latency.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "common/numeric.hpp"
#include "common/timing.hpp"
#include "data/image_file.hpp"
#include "device/context.hpp"
#include "device/edge_detection.hpp"
#include "device/images.hpp"
#include "quadedge/error.hpp"

namespace quadedge::bench {
namespace {

constexpr double kMegabyte = 1024.0 * 1024.0;

bool is_warm_up(std::size_t frame, const BenchRecord& record) {
  return frame >= 1 && frame <= static_cast<std::size_t>(record.warm_up);
}

/// Detects edges in single images of a fixed size.
class Detector {
 public:
  Detector(opencl::Context& context, const ImageView& image, const Config& config)
      : context_(context),
        upload_(context, {}, image.width, image.height, config.variants, image.max_value),
        plane_(context, image.width, image.height, config.edges.sigma, image.max_value),
        threshold_(context, config.edges, config.variants),
        detection_(context, image.width, image.height, config.edges, config.variants) {}

  /// Returns after the device has finished.
  void run(const ImageView& image) {
    upload_.run(image, pixels_);
    plane_.prepare(pixels_);
    threshold_.run(plane_, nullptr);
    detection_.run(plane_, threshold_.values(), edges_);
    context_.finish();
  }
  int count(const ImageView& image) {
    run(image);
    edges_.read_count();
    return edges_.host_count + edges_.host_dropped;
  }

 private:
  opencl::Context& context_;
  stages::Undistortion upload_;
  stages::PaddedPlane plane_;
  stages::EdgeThreshold threshold_;
  stages::EdgeDetection detection_;
  opencl::Buffer<cl_uchar> pixels_;
  stages::DeviceEdges edges_;
};

// Of OpenCV's filters that are timed beside the edge detection.
constexpr double kSigma = 2;  // as that of the edges [px]
constexpr int kFilters = 9;   // as many as third-order edges have derivatives

cv::Mat grey_matrix(const Image& image) { return data::matrix_of(to_8_bits(image.view())).clone(); }

template <class Function>
double milliseconds(const Function& work) {
  const auto start = Clock::now();
  work();
  return milliseconds_since(start);
}

}  // namespace

void measure_start(const StereoRig& rig, const std::function<Device()>& open_device,
                   const std::function<void(const Device&, Config&)>& complete, BenchRecord& record) {
  const auto start = Clock::now();
  Device device = open_device();
  complete(device, record.run.config);
  const StereoOdometry odometry(rig, device, record.run.config);
  record.run.start_ms = milliseconds_since(start);
  record.run.config = odometry.config();
  record.run.kernel_build_ms = odometry.kernel_build_ms();
  record.run.device = device.info();
  record.run.variants = odometry.variants();
  const unsigned processors =
      device.info().type == "cpu" ? device.info().compute_units : std::thread::hardware_concurrency();
  record.threads = static_cast<int>(std::max(1u, processors));
}

void measure_latency(const Subject& subject, BenchRecord& record) {
  Device device = subject.open_device(false);
  StereoOdometry odometry(subject.rig, device, subject.config);
  opencl::Context::Traffic before;
  const int total = static_cast<int>(subject.frames.size());
  for (std::size_t i = 0; i < subject.frames.size(); ++i) {
    if (i == 1 + static_cast<std::size_t>(record.warm_up) && device.context() != nullptr)
      before = device.context()->traffic();
    const double processor = processor_ms();
    FrameResult frame = odometry.track(subject.frames[i].view());
    if (i > 0 && !is_warm_up(i, record)) record.processor_ms.push_back(processor_ms() - processor);
    if (!is_warm_up(i, record)) record.run.frames.push_back(std::move(frame));
    subject.progress("latency", static_cast<int>(i) + 1, total);
  }
  record.run.host_peak_mb = host_peak_mb();
  if (device.context() == nullptr) return;
  const auto& traffic = device.context()->traffic();
  const double frames = std::max(1, total - 1 - record.warm_up), scale = 1 / (kMegabyte * frames);
  record.to_device_mb = static_cast<double>(traffic.to_device - before.to_device) * scale;
  record.launches = static_cast<double>(traffic.launches - before.launches) / frames;
  record.writes = static_cast<double>(traffic.writes - before.writes) / frames;
  record.waits = static_cast<double>(traffic.waits - before.waits) / frames;
  record.to_host_mb = static_cast<double>(traffic.to_host - before.to_host) * scale;
  record.run.device_peak_mb = static_cast<double>(device.context()->peak_bytes()) / kMegabyte;
}

void measure_edge_detection(const Subject& subject, int repetitions, BenchRecord& record) {
  constexpr int kWarmUp = 2;
  Device device = subject.open_device(false);
  if (device.is_reference()) return;
  const ImageView image = subject.frames.front().left.view();
  Detector detector(*device.context(), image, subject.config);
  for (int i = 0; i < kWarmUp; ++i) detector.run(image);
  for (int i = 0; i < repetitions; ++i) {
    const auto start = Clock::now();
    detector.run(image);
    record.edges_ms.push_back(milliseconds_since(start));
    subject.progress("edge detection", i + 1, repetitions);
  }
}

void measure_kernels(const Subject& subject, BenchRecord& record) {
  Device device = subject.open_device(true);
  if (device.is_reference()) return;
  StereoOdometry odometry(subject.rig, device, subject.config);
  for (std::size_t i = 0; i < subject.frames.size(); ++i) {
    const auto result = odometry.track(subject.frames[i].view());
    if (i > 0 && !is_warm_up(i, record))
      record.profiled.push_back({device.context()->last_profile(), result.timing.latency_ms});
    if (!is_warm_up(i, record)) record.run.kernel_times.push_back(result.timing.kernels);
    subject.progress("kernel times", static_cast<int>(i) + 1, static_cast<int>(subject.frames.size()));
  }
}

double threshold_for_edges(const FramePrefetcher::Frame& frame, int wanted, Device& device, const Config& config) {
  if (device.is_reference())
    throw UsageError("--edges needs an OpenCL device; give --edges 0 and --edges.threshold to the reference");
  if (wanted > config.edges.max_edges) {
    throw UsageError("--edges " + std::to_string(wanted) + ": edges.max_edges allows " +
                     std::to_string(config.edges.max_edges));
  }
  const auto mean_count = [&](double threshold) {
    Config tried = config;
    tried.edges.threshold = threshold;
    double sum = 0;
    for (const auto* image : {&frame.left, &frame.right}) {
      sum += Detector(*device.context(), image->view(), tried).count(image->view());
    }
    return sum / 2;
  };
  double low = 1e-6, high = 255;  // thresholds with more and with fewer edges than wanted
  if (mean_count(low) <= wanted) return low;
  while (high - low > 0.01) {
    // The number of edges depends on the ratio of thresholds: geometric mean once the lower bound is above zero.
    const double middle = low > 0 ? std::sqrt(low * high) : std::min(1.0, high / 2);
    const double count = mean_count(middle);
    if (std::abs(count - wanted) <= 0.01 * wanted) return middle;
    (count > wanted ? low : high) = middle;
  }
  return high;
}

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
