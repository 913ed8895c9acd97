#pragma once
/// \file temporal_matching.hpp  Stage 6: from predicted positions to quads, and the global matching. doc/method.md
/// section 4.

#include <cstring>

#include "common/filter_limits.hpp"
#include "common/layouts.hpp"
#include "device/candidates.hpp"
#include "device/context.hpp"
#include "device/device_edges.hpp"
#include "device/stage.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::stages {

/// A point index and the positions of its points in index order, so that searches read contiguous memory.
/// kernels/indexed_points.cl reads it.
class DevicePointIndex {
 public:
  /// For edges in an image of width x height px.
  DevicePointIndex(int width, int height);

  /// Positions of the edges, in the order of the index.
  opencl::Buffer<cl_float> points;
  /// The first edge of every cell and the end of the last, then the number of every edge.
  opencl::Buffer<cl_int> cells;

  const PackedPointIndex& layout() const { return layout_; }
  int cell_count() const { return layout_.columns * layout_.rows; }
  /// Allocates room for `count` edges and discards the contents.
  void resize(opencl::Context& context, int count);

 private:
  PackedPointIndex layout_{};
};

/// Stage 6a: the current stereo edges of both sides, sorted by cells of the image.
/// doc/design.md section 2. Variants of the stage "point_index".
class PointIndex : private Stage {
 public:
  PointIndex(opencl::Context& context, const opencl::VariantChoice& variants);

  /// Enqueues the index of either side's edges.
  void run(const PositionsView& left_edges, const PositionsView& right_edges, DevicePointIndex& left,
           DevicePointIndex& right);

 private:
  /// Counts the edges of all cells, then places and sorts them, each in a launch over both sides.
  void run_in_groups(const PointIndexArguments& arguments, const PositionsView& left_edges,
                     const PositionsView& right_edges, DevicePointIndex& left, DevicePointIndex& right);

  opencl::Kernel<void(PointIndexArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      cl_float* left_points, cl_int* left_cells, cl_float* right_points, cl_int* right_cells)>
      kernel_;
  Scan scan_;
  opencl::Buffer<cl_int> counts_, first_, total_;  ///< per cell of both sides
  opencl::Buffer<cl_int> numbers_;                 ///< per edge of both sides
  opencl::Kernel<void(PointIndexArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      cl_int* counts)>
      count_;
  opencl::Kernel<void(PointIndexArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      const cl_int* first, cl_int* counts, cl_int* numbers)>
      place_;
  opencl::Kernel<void(PointIndexArguments args, const cl_float* left_edges, const cl_float* right_edges,
                      const cl_int* first, cl_int* numbers, cl_float* left_points, cl_int* left_cells,
                      cl_float* right_points, cl_int* right_cells)>
      sort_;
};

/// Stage 6b in lists: current stereo edges near the predicted positions, in the left or the right images.
/// Filters 1 and 2 of doc/method.md section 4. Variants of the stage "temporal_candidates".
class TemporalCandidates : private Stage {
 public:
  TemporalCandidates(opencl::Context& context, const opencl::VariantChoice& variants, Turns turns = Turns::full);

  /// `radius` [px], `orientation` [rad]. Every row_step-th predicted position has a row. `current`: the stereo edges of
  /// one side.
  void run(const PositionsView& predicted, int row_step, const DevicePointIndex& current, float radius,
           float orientation, DeviceCandidates& candidates);

 private:
  Scan scan_;
  opencl::Kernel<void(TemporalCandidateArguments args, const cl_float* predicted, const cl_float* points,
                      const cl_int* cells, cl_int* counts)>
      count_;
  opencl::Kernel<void(TemporalCandidateArguments args, const cl_float* predicted, const cl_float* points,
                      const cl_int* cells, const cl_int* first, cl_int capacity, cl_int* target)>
      fill_;
};

/// The float whose bits a kernel wrote among ints.
inline float from_bits(cl_int bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Adds the quad of a row, if it has one. \param base_edge that the row belongs to \param edges the current ones
inline void append_row(const cl_int* row, std::int32_t base_edge, const StereoEdges& edges, TemporalMatches& matches) {
  if (row[0] >= 0) matches.append(base_edge, row[0], edges, from_bits(row[2]), row[1]);
}

/// Stages 6b and 6c in one kernel: from predicted positions to quads, without SIFT and without lists.
/// doc/method.md section 4 for searches without SIFT. Variants of the stage "temporal_match".
class TemporalMatch : private Stage {
 public:
  TemporalMatch(opencl::Context& context, const TemporalConfig& config, const opencl::VariantChoice& variants);

  /// True if the variant is a fused kernel and the search does not use SIFT.
  bool serves(const TemporalSearch& search) const {
    return variant_.form != opencl::Form::lists && temporal_limits(config_, search).sift_max == 0;
  }

  /// Matches and reads the rows back into `matches`; `edges` holds the current stereo edges on the host. `predicted`:
  /// the lists of the left and of the right image; `left` and `right`: the point indices of the current stereo edges.
  /// \returns false where a row has more candidates than the kernel has room for: then lists have to be
  /// used
  bool run(const DevicePositions& predicted, const TemporalSearch& search, const DeviceStereoEdges& base,
           const DeviceStereoEdges& current, const DevicePointIndex& left, const DevicePointIndex& right,
           const StereoEdges& edges, TemporalMatches& matches);

 private:
  /// Reads the rows of the result back. \returns false where a row has no room for its candidates
  bool read_quads(std::size_t rows, int step, const StereoEdges& edges, TemporalMatches& matches);

  TemporalConfig config_;
  opencl::Buffer<cl_int> result_;
  opencl::ReadBack read_back_;
  opencl::Kernel<void(TemporalMatchArguments args, const cl_float* predicted, const cl_float* left_points,
                      const cl_int* left_cells, const cl_float* right_points, const cl_int* right_cells,
                      const cl_char* base_left_patches, const cl_int* base_left_index,
                      const cl_char* base_right_patches, const cl_char* left_patches, const cl_int* left_index,
                      const cl_char* right_patches, const cl_float* current, cl_int* result)>
      kernel_;
};

/// Stage 6c in lists: agreement of left and right, and the best of what remains: quads.
/// Agreement of both images and selection of the best candidate (doc/method.md section 4). Variants of the stage
/// "temporal_quads".
class TemporalQuads : private Stage {
 public:
  TemporalQuads(opencl::Context& context, const TemporalConfig& config, const opencl::VariantChoice& variants);

  /// Enqueues the agreement: rejects left candidates that are not alive in the right list.
  void agree(DeviceCandidates& left, const DeviceCandidates& right);
  /// Selects the best candidates, reads the rows back and returns the quads. `edges` holds the stereo edges `current`
  /// on the host. \param predicted in the left image
  TemporalMatches collect(const DeviceStereoEdges& current, const StereoEdges& edges, const TemporalSearch& search,
                          const PositionsView& predicted, const DeviceCandidates& left);

 private:
  TemporalConfig config_;
  opencl::Buffer<cl_float> score_;
  opencl::Buffer<cl_int> label_, result_;
  opencl::Kernel<void(TemporalAgreementArguments args, const cl_int* left_first, const cl_int* left_target,
                      const cl_float* left_ncc, cl_uchar* left_state, const cl_int* right_first,
                      const cl_int* right_target, const cl_float* right_ncc, const cl_uchar* right_state,
                      cl_float* score)>
      agree_;
  opencl::Kernel<void(TemporalBestArguments args, const cl_int* first, const cl_int* target, const cl_uchar* state,
                      const cl_float* score, const cl_float* predicted, const cl_float* current, cl_int* label,
                      cl_int* result)>
      best_;
};

/// Every step-th stereo edge of a frame with its wide descriptor.
struct DeviceWideEdges {
  const DeviceStereoEdges& edges;
  int step;
  int rows;
  const opencl::Buffer<cl_uchar>& descriptors;
};

/// Global matching of stereo edges of an earlier frame with the current left image: kernels/global_matching.cl and
/// kernels/global_matching_tiles.cl.
/// Variants of the stage "global_matching".
class GlobalMatching : private Stage {
 public:
  GlobalMatching(opencl::Context& context, const opencl::VariantChoice& variants);

  /// See reference::find_global_matches(). `current_edges` are those of `current` on the host.
  TemporalMatches run(const DeviceWideEdges& earlier, const DeviceWideEdges& current, const StereoEdges& current_edges);

 private:
  void transpose(const DeviceWideEdges& edges, opencl::Buffer<cl_uchar>& blocks);

  float neighbourhood_, ratio_;
  std::size_t rows_at_once_;  ///< of a work-item or of a group that shares them
  opencl::Buffer<cl_uchar> earlier_blocks_, current_blocks_;
  opencl::Buffer<cl_int> best_;
  opencl::Buffer<cl_float> similarity_;
  opencl::Kernel<void(GlobalMatchingArguments args, const cl_uchar* row_descriptors, const cl_float* row_edges,
                      const cl_uchar* column_descriptors, const cl_float* column_edges, cl_int* best,
                      cl_float* similarity)>
      kernel_;
  opencl::Kernel<void(const cl_uchar* descriptors, cl_int count, cl_uchar* blocks)> transpose_;
  opencl::Kernel<void(GlobalMatchingArguments args, const cl_uchar* row_descriptors, const cl_uchar* row_blocks,
                      const cl_float* row_edges, const cl_uchar* column_descriptors, const cl_uchar* column_blocks,
                      const cl_float* column_edges, cl_int* best, cl_float* similarity)>
      blocks_kernel_;
};

}  // namespace quadedge::stages
