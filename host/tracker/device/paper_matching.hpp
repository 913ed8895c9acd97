#pragma once
/// \file paper_matching.hpp  The stages of the paper's method after its edges: from side patches to quads.
/// doc/paper.md.

#include <vector>

#include "device/candidates.hpp"
#include "device/device_edges.hpp"
#include "device/stage.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// Grey levels and slopes of an image: records of kernels/paper_sides.cl, 8 bytes per pixel, of more than 8 bits 16.
struct DevicePicture {
  opencl::Buffer<cl_uint> records;
  int width = 0, height = 0;
};

/// Cuts the side patches of the paper's method. One object per camera image: it holds the image's picture until the
/// next one. Variants of the stage "paper_patches".
class PaperPatches : private Stage {
 public:
  /// For images of width x height pixels with values to `max_value`.
  PaperPatches(opencl::Context& context, int width, int height, const opencl::VariantChoice& variants,
               int max_value = kMaxValue8);

  /// Takes the next image (packed, height x width).
  void prepare(const opencl::Buffer<cl_uchar>& image);

  /// Both patches of edges anywhere in the picture, their middles `offset` px from the edge: kPaperPatchFloats each.
  void cut(const PositionsView& edges, double offset, opencl::Buffer<cl_float>& patches);

  const DevicePicture& picture() const { return picture_; }
  /// Exchanges the picture with another one of this size, for example with that of the frame before.
  void swap(DevicePicture& picture) noexcept { std::swap(picture_, picture); }

 private:
  std::size_t words_per_record_;
  DevicePicture picture_;
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int height, cl_uint* records)> prepare_;
  opencl::Kernel<void(PatchArguments args, const cl_uint* records, const cl_float* positions, cl_float* patches)> cut_;
};

/// Descriptions of a set of edges by the paper's method.
struct PaperDescribedEdges {
  const opencl::Buffer<cl_float>& patches;  ///< kPaperPatchFloats of kernels/layouts.cl each
  const opencl::Buffer<cl_int>& number_of;  ///< of each edge: the number of its patches and of its descriptor
  const opencl::Buffer<cl_uchar>& sift;     ///< in the order of the patches, see reference/edge_descriptions.hpp
};

/// CandidateFilters with the paper's patches.
/// Variants of the stage "paper_filters".
class PaperFilters : private Stage {
 public:
  PaperFilters(opencl::Context& context, const opencl::VariantChoice& variants);

  /// As CandidateFilters::run().
  void run(const PaperDescribedEdges& a, const PaperDescribedEdges& b, const FilterLimits& limits, int row_step,
           bool all_scores, DeviceCandidates& candidates);

 private:
  opencl::Buffer<cl_char> unused_;  ///< in place of the patches that candidate_filters.cl does not read
  opencl::Kernel<void(FilterArguments args, const cl_int* first, const cl_int* target, const cl_float* patches_a,
                      const cl_int* patch_of_a, const cl_float* patches_b, const cl_int* patch_of_b, cl_float* ncc)>
      ncc_;
  CandidateKernel decide_;
};

/// Edges of an image as the refinement takes them.
struct PaperEdges {
  const DevicePicture& picture;
  PositionsView positions;
  const opencl::Buffer<cl_float>& patches;  ///< PaperPatches::cut(); read only where refine_sides is "best"
};

/// Moves the alive candidates of a list until their patches look like those of the row's edge.
/// Variants of the stage "paper_refinement".
class PaperRefinement : private Stage {
 public:
  PaperRefinement(opencl::Context& context, const StereoConfig& config, const opencl::VariantChoice& variants,
                  int max_value = kMaxValue8);

  /// Positions of right edges on the epipolar lines of left edges, the rows. `refined`: two blocks of
  /// candidates.capacity floats, x and y [px]; those of other candidates are left as they are.
  void in_stereo(const PaperEdges& left, const PaperEdges& right, const EpipolarGeometry& geometry,
                 const DeviceCandidates& candidates, opencl::Buffer<cl_float>& refined);
  /// Positions of edges of the current image that look like those of the earlier one, the rows.
  void in_time(const PaperEdges& before, const PaperEdges& now, const DeviceCandidates& candidates,
               opencl::Buffer<cl_float>& refined);

 private:
  using Refine = opencl::Kernel<void(PaperRefinementArguments args, const cl_int* first, const cl_int* target,
                                     const cl_uchar* state, const cl_uint* fixed_records, const cl_uint* moving_records,
                                     const cl_float* fixed_edges, const cl_float* moving_edges,
                                     const cl_float* fixed_patches, const cl_float* moving_patches, cl_float* refined)>;
  void run(const Refine& kernel, const PaperEdges& fixed, const PaperEdges& moving, const EpipolarGeometry& geometry,
           const DeviceCandidates& candidates, opencl::Buffer<cl_float>& refined);

  StereoConfig config_;
  Refine along_line_, freely_;
};

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
