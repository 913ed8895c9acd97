#pragma once
/// \file device_point_index.hpp  The stereo edges of one side in the order of their point index, on the device.

#include "common/point_index.hpp"
#include "stages/packed_positions.hpp"

namespace quadedge::stages {

/// A point index with the positions that searches read, so that these stand together. kernels/point_index.cl reads it.
class DevicePointIndex {
 public:
  /// Indexes the edges of an image of width x height px.
  void build(opencl::Context& context, const EdgePositionsView& edges, int width, int height) {
    make_point_index(edges.x, edges.y, width, height, index_);
    const auto sort = [this](const std::vector<float>& values, std::vector<float>& sorted) {
      sorted.resize(values.size());
      for (std::size_t k = 0; k < sorted.size(); ++k) sorted[k] = values[static_cast<std::size_t>(index_.order[k])];
    };
    sort(edges.x, sorted_.x);
    sort(edges.y, sorted_.y);
    sort(edges.direction, sorted_.direction);
    points_.write(context, {sorted_});
    staged_ = index_.cell_first;
    staged_.insert(staged_.end(), index_.order.begin(), index_.order.end());
    cells_.write(context, staged_);
  }

  /// Of the edges, in the order of the index.
  const opencl::Buffer<cl_float>& points() const { return points_.list().packed; }
  /// The first edge of every cell and the end of the last, then the number of every edge.
  const opencl::Buffer<cl_int>& cells() const { return cells_; }
  PackedPointIndex layout() const { return {points_.list().at, index_.columns, index_.rows}; }

 private:
  DevicePositions points_;
  opencl::Buffer<cl_int> cells_;
  PointIndex index_;  ///< this and the next two: kept for their memory
  EdgePositions sorted_;
  std::vector<cl_int> staged_;
};

}  // namespace quadedge::stages
