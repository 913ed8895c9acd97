#pragma once
/// \file temporal_refinement.hpp  Stage 6b: agreement of left and right, refinement of place and disparity, clusters: quads.

#include <map>
#include <string>

#include "opencl/kernel.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_candidates.hpp"
#include "stages/device_stereo_edges.hpp"
#include "stages/pixel_corners.hpp"
#include "stages/stereo_refinement.hpp"

namespace quadedge::stages {

/// The images and stereo edges of one rig.
struct DeviceRig {
  DeviceImage left, right;
  DeviceStereoEdges edges;
};

/// The closing of the circle and filters 6 and 7 of SPEC section 4. Variants of the stage "temporal_refinement".
class TemporalRefinement {
 public:
  TemporalRefinement(opencl::Context& context, const TemporalConfig& config, double patch_offset,
                     const std::map<std::string, std::string>& variants);

  /// Enqueues the agreement: marks left candidates that the right list does not hold alive.
  void agree(DeviceCandidates& left, const DeviceCandidates& right);
  /// Enqueues the refinement of the living left candidates.
  void refine(const DeviceRig& previous, const DeviceRig& current, int row_step, const opencl::Buffer<cl_float>& geometry,
              DeviceCandidates& left);
  /// Clusters, reads the rows back and returns the quads.
  TemporalMatches collect(const DeviceRig& current, int row_step, const DeviceCandidates& left);
  /// Refined left places of all candidates, for a tap: x, y, right x, right y per candidate.
  const opencl::Buffer<cl_float>& refined() const { return refined_; }

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  opencl::Context& context_;
  TemporalConfig config_;
  float patch_offset_;
  std::size_t local_size_;
  PixelCorners previous_left_, previous_right_, current_left_, current_right_;
  opencl::Buffer<cl_float> score_, refined_, best_score_, best_place_;
  opencl::Buffer<cl_uchar> right_pairing_;
  opencl::Buffer<cl_int> label_, best_, rivals_;
  opencl::Kernel<In<cl_int>, In<cl_int>, cl_int, In<cl_float>, Out<cl_uchar>, In<cl_int>, In<cl_int>, cl_int, In<cl_float>,
                 In<cl_uchar>, In<cl_uchar>, cl_int, cl_int, Out<cl_float>, Out<cl_uchar>>
      agree_;
  opencl::Kernel<In<cl_int>, In<cl_int>, cl_int, cl_int, cl_int, In<cl_uint>, In<cl_uint>, In<cl_uint>, In<cl_uint>, cl_int,
                 cl_int, cl_int, cl_int, In<cl_float>, cl_int, In<cl_float>, cl_int, In<cl_float>, In<cl_uchar>, In<cl_uchar>,
                 cl_float, cl_float, cl_int, cl_float, cl_float, cl_float, cl_float, cl_int, Out<cl_uchar>, Out<cl_float>>
      refine_;
  opencl::Kernel<In<cl_int>, In<cl_int>, cl_int, cl_int, In<cl_float>, cl_int, In<cl_uchar>, In<cl_float>, In<cl_float>, cl_float,
                 cl_float, Out<cl_int>, Out<cl_int>, Out<cl_int>, Out<cl_float>, Out<cl_float>>
      cluster_;
};

}  // namespace quadedge::stages
