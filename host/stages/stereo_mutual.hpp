#pragma once
/// \file stereo_mutual.hpp  Stage 5d: best and mutual; the stereo edges of a rig.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "stages/device_edges.hpp"
#include "stages/device_stereo_edges.hpp"
#include "stages/patches.hpp"
#include "stages/scan.hpp"
#include "stages/stereo_clusters.hpp"
#include "stages/stereo_relaxation.hpp"

namespace quadedge::stages {

/// Owners of the right edges.
struct DeviceMutual {
  opencl::Buffer<cl_int> claimed;  ///< per right edge: the bits of the highest score offered
  opencl::Buffer<cl_int> owner;    ///< per right edge: the left edge that offers it
  opencl::Buffer<cl_int> keep, keep_first;
};

/// doc/method.md section 3, filter 12. Variants of the stage "stereo_mutual".
class StereoMutual {
 public:
  StereoMutual(opencl::Context& context, const StereoConfig& config,
               const std::map<std::string, std::string>& variants);

  /// Fills `result`, waits, copies it to `edges`, and enqueues the right patches without waiting for them.
  /// `right_patches` must hold the prepared right image.
  void run(const DeviceEdges& left, const DeviceEdges& right, Patches& right_patches, const EpipolarGeometry& geometry,
           const DeviceClusters& clusters, const DeviceRelaxation& relaxation, DeviceMutual& mutual,
           DeviceStereoEdges& result, StereoEdges& edges);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  float mutual_radius_;
  std::size_t local_size_;
  Scan scan_;
  opencl::ReadBack read_back_;
  opencl::Kernel<StereoMutualArguments, In<cl_int>, In<cl_float>, In<cl_int>, Out<cl_int>> claim_;
  opencl::Kernel<StereoMutualArguments, In<cl_int>, In<cl_float>, In<cl_int>, In<cl_int>, Out<cl_int>> owner_;
  opencl::Kernel<StereoMutualArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_int>, Out<cl_int>> mutual_;
  opencl::Kernel<StereoMutualArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_float>, In<cl_int>, Out<cl_int>,
                 Out<cl_int>, Out<cl_float>, Out<cl_float>>
      collect_;
};

}  // namespace quadedge::stages
