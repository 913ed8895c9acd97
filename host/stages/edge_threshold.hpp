#pragma once
/// \file edge_threshold.hpp  Stage 2a: the threshold of a frame's edges, from what its images show. doc/method.md
/// section 1.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/padded_plane.hpp"

namespace quadedge::stages {

/// Measures contrast and noise of a stereo pair. The threshold stays on the device, where the edge detection reads it,
/// so the host does not wait. If edges.threshold > 0, it is used and nothing is measured. The threshold of the previous
/// frame is kept. All variants give the same bytes.
class EdgeThreshold {
 public:
  /// `variants`: stage "edge_threshold". \throws UsageError for an unknown variant.
  EdgeThreshold(opencl::Context& context, const EdgesConfig& config,
                const std::map<std::string, std::string>& variants);

  /// Enqueues the measurement of a stereo pair, or of a single image (`right` null).
  void run(const PaddedPlane& left, const PaddedPlane* right);

  /// {threshold [grey levels per px], standard deviation of the noise [grey levels], 0 if not measured} of the last
  /// frame.
  const opencl::Buffer<cl_float>& values() const { return values_; }

  /// Copies them to the host, where they are valid after the next wait for the queue.
  void request() { values_.read_later(host_values_, 2); }
  double host_threshold() const { return static_cast<double>(host_values_[0]); }

 private:
  /// Enqueues the tallies of one image, the first of which is number `first`. \returns how many.
  int tally(const PaddedPlane& plane, int first);
  ThresholdArguments arguments(const PaddedPlane& plane) const;

  using InInt = opencl::In<cl_int>;
  using In = opencl::In<cl_float>;

  opencl::Context& context_;
  EdgesConfig config_;
  std::size_t local_size_ = 1;
  opencl::Buffer<cl_float> values_;
  opencl::Buffer<cl_int> tallies_;
  cl_float host_values_[2] = {0, 0};
  opencl::Kernel<ThresholdArguments, In, In, cl_int, opencl::Out<cl_int>> tally_;
  opencl::Kernel<ThresholdArguments, InInt, cl_int, opencl::Out<cl_float>> choose_;
};

}  // namespace quadedge::stages
