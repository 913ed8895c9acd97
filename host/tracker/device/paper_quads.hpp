#pragma once
/// \file paper_quads.hpp  Quads of the paper's method: clusters of both images that hold the same current stereo edge.

#include "device/candidates.hpp"
#include "device/paper_clusters.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::stages {

/// Variants of the stage "paper_quads".
class PaperQuads : private Stage {
 public:
  PaperQuads(opencl::Context& context, const opencl::VariantChoice& variants);

  /// A previous stereo edge's candidates in one image and their clusters.
  struct Image {
    const DeviceCandidates& candidates;
    const DevicePaperClusters& clusters;
  };
  /// All quads in the order of the previous edges, the rows of both lists; waits for the device.
  void run(const Image& left, const Image& right, TemporalMatches& matches);

 private:
  using Count = opencl::Kernel<void(PaperQuadArguments args, const cl_int* left_first, const cl_int* left_count,
                                    const cl_int* left_member_first, const cl_int* left_members,
                                    const cl_int* right_first, const cl_int* right_count,
                                    const cl_int* right_member_first, const cl_int* right_members, cl_int* counts)>;
  using Fill = opencl::Kernel<void(
      PaperQuadArguments args, const cl_int* left_first, const cl_int* left_count, const cl_int* left_member_first,
      const cl_int* left_members, const cl_float* left_clusters, const cl_int* left_rows, const cl_int* left_target,
      const cl_float* left_ncc, const cl_int* right_first, const cl_int* right_count, const cl_int* right_member_first,
      const cl_int* right_members, const cl_float* right_clusters, const cl_int* right_rows, const cl_int* right_target,
      const cl_float* right_ncc, const cl_int* quad_first, cl_float* places, cl_int* numbers)>;

  Scan scan_;
  opencl::Buffer<cl_int> counts_, first_, total_, numbers_;
  opencl::Buffer<cl_float> places_;
  Count count_;
  Fill fill_;
};

}  // namespace quadedge::stages
