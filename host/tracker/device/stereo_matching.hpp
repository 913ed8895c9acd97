#pragma once
/// \file stereo_matching.hpp  Stages 4a and 5: from edges to stereo edges. doc/method.md section 3.

#include "device/candidates.hpp"
#include "device/device_edges.hpp"
#include "device/edge_descriptions.hpp"
#include "device/images.hpp"
#include "device/stage.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::stages {

/// Stage 4a: right edges on each left edge's epipolar segment with a similar direction.
/// Filters 1 to 3 of doc/method.md section 3. Variants of the stage "stereo_candidates".
class StereoCandidates : private Stage {
 public:
  StereoCandidates(opencl::Context& context, const opencl::VariantChoice& variants, Turns turns = Turns::full);

  /// One row per left edge. `right_height` [px].
  void run(const DeviceEdges& left, const DeviceEdges& right, int right_height, const EpipolarGeometry& geometry,
           const DisparityProbe& probe, DeviceCandidates& candidates);

  /// Of the last run: which right edges are candidates (1, else 0).
  const opencl::Buffer<cl_int>& listed() const { return listed_; }

 private:
  Scan scan_;
  opencl::Buffer<cl_int> noted_;  ///< the first candidates of every row
  opencl::Buffer<cl_int> listed_;
  opencl::Kernel<void(StereoCandidateArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      const cl_int* right_row_first, cl_int* counts, cl_int* noted, cl_int* listed)>
      count_;
  opencl::Kernel<void(StereoCandidateArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      const cl_int* right_row_first, const cl_int* first, cl_int capacity, const cl_int* noted,
                      cl_int* target, cl_int* listed)>
      fill_;
};

/// What the refinement finds for every candidate.
struct DeviceRefined {
  opencl::Buffer<cl_float> position;  ///< on the left edge's epipolar line [px from the point at infinity]
  opencl::Buffer<cl_float>
      similarity;  ///< of the refined positions: mean of the NCC of the edges' own patches and of the better side
};

/// Stage 5a: epipolar shift and photometric refinement of stereo candidates.
/// doc/method.md section 3, 8a and 8b. Variants of the stage "stereo_refinement".
class StereoRefinement : private Stage {
 public:
  StereoRefinement(opencl::Context& context, const StereoConfig& config, double patch_offset,
                   const opencl::VariantChoice& variants, int max_value = kMaxValue8);

  /// Living candidates get a position and a similarity; those that diverge are rejected. Both images prepared for
  /// sampling; `left_patches`: the side patches of the left edges, see reference/edge_descriptions.hpp.
  void run(const PixelCorners& left_image, const PixelCorners& right_image, const DeviceEdges& left,
           const DeviceEdges& right, const opencl::Buffer<cl_char>& left_patches, const EpipolarGeometry& geometry,
           DeviceCandidates& candidates, DeviceRefined& refined);

 private:
  StereoConfig config_;
  float patch_offset_;
  opencl::Kernel<void(StereoRefinementArguments args, const cl_int* first, const cl_int* target, const cl_float* ncc,
                      const cl_uint* left_corners, const cl_uint* right_corners, const cl_char* left_patches,
                      const cl_float* left_edges, const cl_float* right_edges, cl_uchar* state, cl_float* position,
                      cl_float* similarity)>
      kernel_;
};

/// Clusters of one frame's candidates, in the rows of the candidates.
struct DeviceClusters {
  opencl::Buffer<cl_int> order;  ///< scratch
  opencl::Buffer<cl_int> count;  ///< clusters per left edge
  /// Three blocks of `stride` floats: position on the epipolar line [px from the point at infinity], direction [rad],
  /// similarity.
  opencl::Buffer<cl_float> packed;
  int stride = 0;
  opencl::Buffer<cl_int> anchor;  ///< right edge of the representative
};

/// Stage 5b: clusters of candidates and their representatives.
/// doc/method.md section 3, 8c. Variants of the stage "stereo_clusters".
class StereoClusters : private Stage {
 public:
  StereoClusters(opencl::Context& context, const opencl::VariantChoice& variants);

  void run(const DeviceEdges& left, const DeviceEdges& right, const DeviceCandidates& candidates,
           const DeviceRefined& refined, DeviceClusters& clusters);

 private:
  opencl::Kernel<void(StereoClusterArguments args, const cl_int* first, const cl_int* target,
                      const cl_float* right_edges, const cl_uchar* state, const cl_float* position,
                      const cl_float* similarity, cl_int* order, cl_int* cluster_count, cl_float* clusters,
                      cl_int* cluster_anchor)>
      cluster_;
};

/// Stage 5c: a coarse disparity of the pair, which decides where neighbouring edges disagree.
/// doc/method.md section 3, filter 10. Variants of the stage "coarse_disparity". Its memory, of the size of the largest
/// search so far, is allocated by the first run.
class CoarseDisparity : private Stage {
 public:
  /// `max_value`: largest value of the images' pixels.
  CoarseDisparity(opencl::Context& context, const opencl::VariantChoice& variants, int max_value);

  /// Memory that a search takes [bytes].
  static std::size_t bytes(const CoarseDisparityArguments& search);

  /// Matches the images of `search`, which are rectified.
  void run(const DeviceImage& left, const DeviceImage& right, const CoarseDisparityArguments& search);

  /// height x width of the search, see reference/coarse_disparity.hpp.
  const opencl::Buffer<cl_float>& positions() const { return positions_; }
  /// The last search.
  const CoarseDisparityArguments& search() const { return search_; }

 private:
  /// Rows of planes: `front` places, then one per column of the half-size image, `stride` in all.
  struct PlaneRows {
    int width, front, stride;
    bool mirrored;
  };
  void prepare(const DeviceImage& image, int height, const PlaneRows& rows, opencl::Buffer<cl_uchar>& planes);

  CoarseDisparityArguments search_{};
  int strip_;  ///< columns per work-item of coarse_columns
  opencl::Buffer<cl_uchar> half_, left_planes_, right_planes_, costs_;
  opencl::Buffer<cl_ushort> sums_;
  opencl::Buffer<cl_uint> lowest_;
  opencl::Buffer<cl_float> positions_;
  opencl::Kernel<void(const cl_uchar* bytes, cl_int width, cl_int half_width, cl_uchar* half_image)> halve_;
  opencl::Kernel<void(const cl_uchar* half_image, cl_int width, cl_int height, cl_int front, cl_int stride,
                      cl_int mirrored, cl_uchar* planes)>
      planes_;
  opencl::Kernel<void(CoarseDisparityArguments args, const cl_uchar* left, const cl_uchar* right, cl_uchar* costs,
                      cl_ushort* sums)>
      rows_;
  opencl::Kernel<void(CoarseDisparityArguments args, const cl_uchar* costs, cl_ushort* sums)> columns_;
  opencl::Kernel<void(CoarseDisparityArguments args, const cl_ushort* sums, cl_uint* lowest, cl_float* positions)>
      choose_;
};

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

/// Stage 5d: neighbouring edges vote on the candidates of an edge.
/// doc/method.md section 3, filter 10. Variants of the stage "stereo_relaxation".
class StereoRelaxation : private Stage {
 public:
  /// `width` x `height`: of the left image [px].
  StereoRelaxation(opencl::Context& context, int width, int height, const StereoConfig& config,
                   const opencl::VariantChoice& variants);

  /// `coarse_disparity`: of the same pair, null: none. The tally is that of the vote without it.
  void run(const DeviceEdges& left, const EpipolarGeometry& geometry, const DeviceCandidates& candidates,
           const DeviceClusters& clusters, DeviceRelaxation& relaxation,
           const CoarseDisparity* coarse_disparity = nullptr);

 private:
  int columns_, cell_rows_;
  StereoConfig config_;
  opencl::Kernel<void(StereoRelaxationArguments args, const cl_int* first, const cl_int* cluster_count,
                      const cl_float* left_edges, const cl_float* clusters, cl_float* prior, cl_float* belief,
                      cl_float* next_belief, cl_float* slopes, cl_int* cells)>
      start_;
  opencl::Kernel<void(StereoRelaxationArguments args, const cl_int* first, const cl_int* cluster_count,
                      const cl_float* left_edges, const cl_float* clusters, const cl_float* slopes, const cl_int* cells,
                      const cl_float* prior, const cl_float* belief, cl_float* next_belief)>
      round_;
  opencl::Kernel<void(StereoRelaxationArguments args, const cl_int* first, const cl_int* cluster_count,
                      const cl_float* left_edges, const cl_float* clusters, const cl_float* slopes, const cl_int* cells,
                      const cl_float* belief, cl_int* chosen, cl_float* score)>
      choose_;
  opencl::Kernel<void(StereoRelaxationArguments args, const cl_int* first, const cl_int* cluster_count,
                      const cl_float* belief, cl_int* tally)>
      tally_;
  opencl::Kernel<void(StereoRelaxationArguments args, const cl_int* first, const cl_int* cluster_count,
                      const cl_float* left_edges, const cl_float* clusters, const cl_float* coarse, cl_float* prior,
                      cl_float* belief, cl_float* next_belief)>
      consult_;
};

/// Stage 5e: best and mutual; the stereo edges of a frame.
/// doc/method.md section 3, filter 12. Variants of the stage "stereo_mutual".
class StereoMutual : private Stage {
 public:
  StereoMutual(opencl::Context& context, const StereoConfig& config, const opencl::VariantChoice& variants);

  /// Fills `result`, waits, copies it to `edges`, and enqueues the right patches without waiting for them.
  /// `right_patches` must hold the prepared right image.
  /// \param geometry lines onto which right points are written \param searched those on which they lie in the image,
  /// where patches are cut; null: the same
  void run(const DeviceEdges& left, const DeviceEdges& right, Patches& right_patches, const EpipolarGeometry& geometry,
           const EpipolarGeometry* searched, const DeviceClusters& clusters, const DeviceRelaxation& relaxation,
           DeviceStereoEdges& result, StereoEdges& edges);

  /// Of the last run, per right edge: the left edge that offers the highest score.
  const opencl::Buffer<cl_int>& owners() const { return owners_; }

 private:
  float mutual_radius_;
  opencl::Buffer<cl_int> claimed_;  ///< per right edge: the bits of the highest score offered
  opencl::Buffer<cl_int> owners_;
  opencl::Buffer<cl_int> keep_, keep_first_;
  Scan scan_;
  opencl::ReadBack read_back_;
  opencl::Kernel<void(StereoMutualArguments args, const cl_int* chosen, const cl_float* score,
                      const cl_int* cluster_anchor, cl_int* claimed)>
      claim_;
  opencl::Kernel<void(StereoMutualArguments args, const cl_int* chosen, const cl_float* score,
                      const cl_int* cluster_anchor, const cl_int* claimed, cl_int* owner)>
      owner_;
  opencl::Kernel<void(StereoMutualArguments args, const cl_int* chosen, const cl_int* cluster_anchor,
                      const cl_float* left_edges, const cl_int* owner, cl_int* keep)>
      mutual_;
  opencl::Kernel<void(StereoMutualArguments args, const cl_int* keep_first, const cl_int* chosen,
                      const cl_float* left_edges, const cl_float* clusters, const cl_int* cluster_anchor,
                      cl_int* left_index, cl_int* right_index, cl_float* packed, cl_float* ncc)>
      collect_;
};

}  // namespace quadedge::stages
