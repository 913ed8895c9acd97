#pragma once
/// \file stereo_refinement.hpp  Stage 5a: epipolar shift and photometric refinement of stereo candidates.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_edges.hpp"
#include "stages/pixel_corners.hpp"

namespace quadedge::stages {

/// What the refinement finds for every candidate.
struct DeviceRefined {
  opencl::Buffer<cl_float> position;  ///< on the left edge's epipolar line [px from the point at infinity]
  opencl::Buffer<cl_float>
      similarity;  ///< of the refined positions: mean of the NCC of the edges' own patches and of the better side
};

/// doc/method.md section 3, 8a and 8b. Variants of the stage "stereo_refinement".
class StereoRefinement {
 public:
  StereoRefinement(opencl::Context& context, const StereoConfig& config, double patch_offset,
                   const std::map<std::string, std::string>& variants, int max_value = kMaxValue8);

  /// Living candidates get a position and a similarity; those that diverge are rejected. Both images prepared for
  /// sampling; `left_patches`: the side patches of the left edges, see host/reference/patches.hpp.
  void run(const PixelCorners& left_image, const PixelCorners& right_image, const DeviceEdges& left,
           const DeviceEdges& right, const opencl::Buffer<cl_char>& left_patches, const EpipolarGeometry& geometry,
           DeviceCandidates& candidates, DeviceRefined& refined);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  StereoConfig config_;
  float patch_offset_;
  std::size_t local_size_, items_per_edge_;
  opencl::Kernel<StereoRefinementArguments, In<cl_int>, In<cl_int>, In<cl_float>, In<cl_uint>, In<cl_uint>, In<cl_char>,
                 In<cl_float>, In<cl_float>, Out<cl_uchar>, Out<cl_float>, Out<cl_float>>
      kernel_;
};

}  // namespace quadedge::stages
