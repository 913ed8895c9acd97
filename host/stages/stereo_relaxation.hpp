#pragma once
/// \file stereo_relaxation.hpp  Stage 5c: neighbouring edges vote on the candidates of an edge.

#include <map>
#include <string>

#include "common/coarse_search.hpp"
#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/coarse_disparity.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_edges.hpp"
#include "stages/stereo_clusters.hpp"

namespace quadedge::stages {

/// Result of the vote; beliefs and slopes are stored in the rows of the candidates.
struct DeviceRelaxation {
  opencl::Buffer<cl_float> prior, belief, next_belief;
  opencl::Buffer<cl_float> slopes;  ///< two blocks: change of the position on the line per px along x, along y
  opencl::Buffer<cl_int> cells;     ///< the first edge with a candidate in every cell of the left image
  opencl::Buffer<cl_int> tally;     ///< see RelaxationTally
  RelaxationTally host_tally;       ///< the same, valid after the next wait for the queue
  opencl::Buffer<cl_int> chosen;    ///< cluster per left edge, -1: none
  opencl::Buffer<cl_float> score;   ///< per left edge: similarity of that cluster, and what its support counts
};

/// doc/method.md section 3, filter 10. Variants of the stage "stereo_relaxation".
class StereoRelaxation {
 public:
  /// `width` x `height`: of the left image [px].
  StereoRelaxation(opencl::Context& context, int width, int height, const StereoConfig& config,
                   const std::map<std::string, std::string>& variants);

  /// `witness`: of the same pair, null: none. The tally is taken before it speaks.
  void run(const DeviceEdges& left, const EpipolarGeometry& geometry, const DeviceCandidates& candidates,
           const DeviceClusters& clusters, DeviceRelaxation& relaxation, const CoarseDisparity* witness = nullptr);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  int columns_, cell_rows_;
  StereoConfig config_;
  std::size_t local_size_;
  opencl::Kernel<StereoRelaxationArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_float>, Out<cl_float>,
                 Out<cl_float>, Out<cl_float>, Out<cl_float>, Out<cl_int>>
      start_;
  opencl::Kernel<StereoRelaxationArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_float>, In<cl_float>,
                 In<cl_int>, In<cl_float>, In<cl_float>, Out<cl_float>>
      round_;
  opencl::Kernel<StereoRelaxationArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_float>, In<cl_float>,
                 In<cl_int>, In<cl_float>, Out<cl_int>, Out<cl_float>>
      choose_;
  opencl::Kernel<StereoRelaxationArguments, In<cl_int>, In<cl_int>, In<cl_float>, Out<cl_int>> tally_;
  opencl::Kernel<StereoRelaxationArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_float>, In<cl_float>,
                 Out<cl_float>, Out<cl_float>, Out<cl_float>>
      consult_;
};

}  // namespace quadedge::stages
