#pragma once
/// \file device_point_index.hpp  The stereo edges of one side in the order of their point index, on the device.

#include "common/point_index.hpp"
#include "common/temporal_search.hpp"
#include "opencl/buffer.hpp"

namespace quadedge::stages {

/// A point index with the values that searches read, so that these stand together.
struct DevicePointIndex {
  opencl::Buffer<cl_float> x, y, direction;  ///< px, px, rad
  opencl::Buffer<cl_int> number;             ///< of the stereo edge
  opencl::Buffer<cl_int> cell_first;
  int columns = 0, rows = 0;

  /// Indexes places in an image of width x height px.
  void build(opencl::Context& context, const std::vector<float>& xs, const std::vector<float>& ys,
             const std::vector<float>& directions, int width, int height) {
    make_point_index(xs, ys, width, height, index_);
    columns = index_.columns;
    rows = index_.rows;
    number.write(context, index_.order);
    cell_first.write(context, index_.cell_first);
    for (const auto& [values, buffer] : {std::pair(&xs, &x), std::pair(&ys, &y), std::pair(&directions, &direction)}) {
      sorted_.resize(values->size());
      for (std::size_t k = 0; k < sorted_.size(); ++k)
        sorted_[k] = (*values)[static_cast<std::size_t>(index_.order[k])];
      buffer->write(context, sorted_);
    }
  }

 private:
  PointIndex index_;
  std::vector<float> sorted_;
};

}  // namespace quadedge::stages
