#pragma once
/// \file point_index.hpp  Stage 6a: the current stereo edges of both sides, sorted by cells of the image.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "stages/packed_positions.hpp"
#include "stages/scan.hpp"

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

/// doc/design.md section 2. Variants of the stage "point_index".
class PointIndex {
 public:
  PointIndex(opencl::Context& context, const std::map<std::string, std::string>& variants);

  /// Enqueues the index of either side's edges.
  void run(const PositionsView& left_edges, const PositionsView& right_edges, DevicePointIndex& left,
           DevicePointIndex& right);

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  /// Counts the edges of all cells, then places and sorts them, each in a launch over both sides.
  void run_in_groups(const PointIndexArguments& arguments, const PositionsView& left_edges,
                     const PositionsView& right_edges, DevicePointIndex& left, DevicePointIndex& right);

  opencl::Context& context_;
  std::size_t local_size_;
  bool grouped_;
  opencl::Kernel<PointIndexArguments, In<cl_float>, In<cl_float>, Out<cl_float>, Out<cl_int>, Out<cl_float>,
                 Out<cl_int>>
      kernel_;
  Scan scan_;
  opencl::Buffer<cl_int> counts_, first_, total_;  ///< per cell of both sides
  opencl::Buffer<cl_int> numbers_;                 ///< per edge of both sides
  opencl::Kernel<PointIndexArguments, In<cl_float>, In<cl_float>, Out<cl_int>> count_;
  opencl::Kernel<PointIndexArguments, In<cl_float>, In<cl_float>, In<cl_int>, Out<cl_int>, Out<cl_int>> place_;
  opencl::Kernel<PointIndexArguments, In<cl_float>, In<cl_float>, In<cl_int>, Out<cl_int>, Out<cl_float>, Out<cl_int>,
                 Out<cl_float>, Out<cl_int>>
      sort_;
};

}  // namespace quadedge::stages
