#pragma once
/// \file edge_detection.hpp  Stage 2: third-order edges of the images. doc/method.md section 1.

#include "device/device_edges.hpp"
#include "device/images.hpp"
#include "device/stage.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge::stages {

/// Stage 2a: the threshold of a frame's edges, from what its images show.
/// Measures contrast and noise of a stereo pair. The threshold stays on the device, where the edge detection reads it,
/// so the host does not wait. If edges.threshold > 0, it is used and nothing is measured. The threshold of the previous
/// frame stays in use while it is within a factor kThresholdHold of the measured one (hysteresis). All variants give
/// the same bytes.
class EdgeThreshold : private Stage {
 public:
  /// `variants`: stage "edge_threshold". \throws UsageError for an unknown variant.
  EdgeThreshold(opencl::Context& context, const EdgesConfig& config, const opencl::VariantChoice& variants);

  /// Enqueues the measurement of a stereo pair, or of a single image (`right` null). \param known_noise in place of a
  /// measurement, unless it is negative
  void run(const PaddedPlane& left, const PaddedPlane* right, float known_noise = -1);

  /// {threshold [grey levels per px], standard deviation of the noise [grey levels], gradient that a fifth of the
  /// images exceeds} of the last frame; the last two are 0 if not measured.
  const opencl::Buffer<cl_float>& values() const { return values_; }

  /// Copies them to the host, where they are valid after the next wait for the queue.
  void request() { values_.read_later(host_values_, 3); }
  double host_threshold() const { return static_cast<double>(host_values_[0]); }
  double host_noise() const { return static_cast<double>(host_values_[1]); }
  double host_gradient() const { return static_cast<double>(host_values_[2]); }

 private:
  /// Enqueues the tallies of one image, the first of which is number `first`. \returns how many.
  int tally(const PaddedPlane& plane, int first);
  ThresholdArguments arguments(const PaddedPlane& plane) const;

  EdgesConfig config_;
  opencl::Buffer<cl_float> values_;
  opencl::Buffer<cl_int> tallies_;
  cl_float host_values_[3] = {0, 0, 0};
  opencl::Kernel<void(ThresholdArguments args, const cl_float* plane, const cl_float* taps, cl_int first_tally,
                      cl_int* tallies)>
      tally_;
  opencl::Kernel<void(ThresholdArguments args, const cl_int* tallies, cl_int count, cl_float known_noise,
                      cl_float* result)>
      choose_;
};

/// Stage 2b: third-order edges of one image.
/// Detects edges in images of one size. Owns its kernels and scratch memory and only enqueues commands, so that it can
/// be used for one image after another. All variants give the same bytes.
class EdgeDetection : private Stage {
 public:
  /// `variants`: stage "edge_detection" (strip, tile...) and stage "scan". \throws UsageError for an unknown variant or
  /// an empty image, DeviceError when the kernels do not build.
  EdgeDetection(opencl::Context& context, int width, int height, const EdgesConfig& config,
                const opencl::VariantChoice& variants);

  /// Enqueues the detection in the image of `plane`, above `threshold` (one float on the device, grey levels per px).
  /// At most config.max_edges edges are stored; the rest, at the end of the scan order, is counted in `edges.count`.
  /// Call edges.read_count() before the number is needed on the host.
  void run(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold, DeviceEdges& edges);

  /// The first half of run(): the maxima of the gradient.
  void find_maxima(const PaddedPlane& plane, const opencl::Buffer<cl_float>& threshold);
  /// The result of the first half. A selection can remove maxima before the second half.
  EdgeMaxima& maxima() { return maxima_; }
  /// The second half of run(): direction and position of the maxima.
  void take_directions(const PaddedPlane& plane, DeviceEdges& edges);

 private:
  void build();
  DetectionArguments arguments(const PaddedPlane& plane) const;

  int width_, height_;
  EdgesConfig config_;
  int tiles_x_ = 0, tiles_y_ = 0;
  int line_ = 0;  ///< floats of one scratch line of a strip

  opencl::Kernel<void(DetectionArguments args, const cl_float* threshold_of_frame, cl_int strip_rows,
                      const cl_float* plane, const cl_float* taps, cl_float* scratch, cl_int line, cl_float* winners,
                      cl_int* counts)>
      strip_maxima_;
  opencl::Kernel<void(DetectionArguments args, const cl_float* plane, const cl_float* winners, const cl_int* counts,
                      const cl_int* row_first, cl_float* edges)>
      strip_directions_;
  opencl::Kernel<void(DetectionArguments args, const cl_float* threshold_of_frame, cl_int tiles_x,
                      const cl_float* plane, const cl_float* taps, cl_float* winners, cl_uchar* flags)>
      tile_maxima_;
  opencl::Kernel<void(const cl_uchar* flags, cl_int width, cl_int* counts)> tile_count_;
  opencl::Kernel<void(const cl_uchar* flags, cl_int width, const cl_float* winners, const cl_int* row_first,
                      cl_int max_edges, cl_float* compact, cl_int* rows)>
      tile_compact_;
  opencl::Kernel<void(DetectionArguments args, const cl_float* plane, const cl_float* compact, const cl_int* rows,
                      const cl_int* total, cl_float* edges)>
      tile_directions_;
  Scan scan_;

  opencl::Buffer<cl_float> scratch_;  ///< strips: lines of column sums and gradients
  EdgeMaxima maxima_;
  opencl::Buffer<cl_float> compact_;  ///< tiles: winners in scan order
  opencl::Buffer<cl_int> rows_;       ///< tiles: their rows
};

/// Between stages 2b and 2c: no edges where an image shows nothing of the world.
/// Removes the maxima of one camera's images within edges.margin of hidden pixels. Does nothing without a mask.
class EdgeMask {
 public:
  /// \param margin edges.margin [px]
  /// \param maxima the argument of later calls of run()
  EdgeMask(opencl::Context& context, const PixelMask& mask, int margin, const EdgeMaxima& maxima);

  /// Replaces the mask, between frames.
  void set(const PixelMask& mask, int margin);
  /// Enqueues only.
  void run(EdgeMaxima& maxima);

 private:
  opencl::Context& context_;
  int width_ = 0, height_ = 0;
  std::size_t local_size_;
  opencl::Buffer<cl_uchar> hidden_;  ///< empty: no mask
  opencl::Kernel<void(cl_int width, cl_int height, const cl_uchar* mask, cl_float* winners, cl_int* counts)> rows_;
  opencl::Kernel<void(cl_int pixels, const cl_uchar* mask, cl_uchar* flags)> pixels_;
};

/// Stage 2c: which maxima become edges: about edges.budget per image, or more (edges.max_spacing), where curves cross
/// evenly spaced epipolar lines. The spacing stays on the device, so the host does not wait.
class EdgeSelection {
 public:
  /// \param maxima the argument of later calls of run()
  EdgeSelection(opencl::Context& context, const EdgesConfig& config, const EdgeMaxima& maxima);

  /// Enqueues the selection in both images. Does nothing if edges.budget is 0.
  /// \param in_left, in_right see selection_arguments()
  void run(const SelectionArguments& in_left, const SelectionArguments& in_right, EdgeMaxima& left, EdgeMaxima& right);

  /// Copies the spacing to host_spacing(), which is valid after the next wait for the queue.
  void request() { spacing_.read_later(&host_spacing_, 1); }
  /// Spacing of the lines in the last frame [px]; 0: all edges were kept.
  double host_spacing() const { return static_cast<double>(host_spacing_); }

 private:
  void weigh(const SelectionArguments& arguments, const EdgeMaxima& maxima, cl_int image);
  void choose(const SelectionArguments& arguments, EdgeMaxima& maxima);

  opencl::Context& context_;
  cl_int budget_;
  cl_float most_;
  std::size_t local_size_, weighing_group_;
  opencl::Buffer<cl_int> tally_;  ///< weights of the left and the right image
  opencl::Buffer<cl_float> spacing_;
  cl_float host_spacing_ = 0;
  opencl::Kernel<void(SelectionArguments args, const cl_float* winners, const cl_int* counts, cl_int image,
                      cl_int* tally)>
      weigh_rows_;
  opencl::Kernel<void(SelectionArguments args, const cl_float* winners, const cl_uchar* flags, cl_int image,
                      cl_int* tally)>
      weigh_pixels_;
  opencl::Kernel<void(cl_int budget, cl_float most, cl_int* tally, cl_float* spacing)> space_;
  opencl::Kernel<void(SelectionArguments args, const cl_float* spacing_of_frame, cl_float* winners, cl_int* counts)>
      choose_rows_;
  opencl::Kernel<void(SelectionArguments args, const cl_float* spacing_of_frame, const cl_float* winners,
                      cl_uchar* flags)>
      choose_pixels_;
};

}  // namespace quadedge::stages
