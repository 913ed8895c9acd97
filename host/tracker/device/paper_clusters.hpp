#pragma once
/// \file paper_clusters.hpp  Clusters of refined candidates in the paper's method, and the best one of a left edge.

#include <vector>

#include "device/candidates.hpp"
#include "device/paper_patches.hpp"

namespace quadedge::stages {

/// Clusters in the rows of the candidates: cluster k of row i is element first[i] + k of every block.
struct DevicePaperClusters {
  opencl::Buffer<cl_int> first;  ///< rows + 1: alive candidates of the rows before, at least as many as clusters
  opencl::Buffer<cl_int> scratch;
  opencl::Buffer<cl_int> count;  ///< clusters per row
  /// Four blocks of `stride` floats: x, y [px] and direction [rad] of the centre; similarity, after compare().
  opencl::Buffer<cl_float> packed;
  /// Two blocks of `stride`: where a cluster's members begin in `members`, and their number.
  opencl::Buffer<cl_int> member_first;
  opencl::Buffer<cl_int> members;  ///< targets, the nearest to the centre first
  opencl::Buffer<cl_int> chosen;   ///< best cluster per row, -1: none; after compare()
  int rows = 0, stride = 0;

  /// Clusters on the host, without gaps: those of row i are first[i] .. first[i + 1] - 1, the members of cluster k
  /// members[member_first[k]] .. members[member_first[k + 1] - 1].
  struct Lists {
    std::vector<std::int32_t> first;
    std::vector<float> x, y, direction, similarity;
    std::vector<std::int32_t> member_first, members;
    std::vector<std::int32_t> chosen;  ///< index of the best cluster per row, -1: none
  };
  /// \param compared whether compare() has run: otherwise without similarity and choice
  Lists read(bool compared) const;
};

/// Variants of the stage "paper_clusters".
class PaperClusters : private Stage {
 public:
  PaperClusters(opencl::Context& context, const opencl::VariantChoice& variants, int max_value = kMaxValue8);

  /// Clusters the alive candidates. \param moving the edges that the candidates are \param refined PaperRefinement
  void cluster(const PositionsView& moving, const DeviceCandidates& candidates, const opencl::Buffer<cl_float>& refined,
               DevicePaperClusters& clusters);
  /// NCC of every cluster with the row's left edge, and the best cluster of each that has `ncc_min`.
  /// \param left_patches cut `offset` px from the edges
  void compare(const DevicePicture& right, const opencl::Buffer<cl_float>& left_patches, double offset, double ncc_min,
               DevicePaperClusters& clusters);

 private:
  Scan scan_;
  opencl::Buffer<cl_int> alive_, total_;
  opencl::Kernel<void(cl_int rows, cl_int candidates, const cl_int* first, const cl_uchar* state, cl_int* counts)>
      count_;
  opencl::Kernel<void(PaperClusterArguments args, const cl_int* first, const cl_int* target, const cl_uchar* state,
                      const cl_int* alive_first, const cl_float* moving_edges, const cl_float* refined, cl_int* scratch,
                      cl_int* count, cl_float* clusters, cl_int* member_first, cl_int* members)>
      cluster_;
  opencl::Kernel<void(PaperSimilarityArguments args, const cl_int* alive_first, const cl_int* count,
                      const cl_uint* records, const cl_float* patches, cl_float* clusters, cl_int* chosen)>
      compare_;
};

}  // namespace quadedge::stages
