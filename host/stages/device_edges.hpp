#pragma once
/// \file device_edges.hpp  The edges of one image on the device.

#include "opencl/buffer.hpp"
#include "quadedge/edges.hpp"
#include "stages/packed_positions.hpp"

namespace quadedge::stages {

/// Third-order edges in scan order (EdgeSet on the device). Only the first host_count elements of a block are valid.
struct DeviceEdges {
  /// Five blocks of `stride` floats: x, y [px], direction [rad], strength [grey levels per px], scale drift [px].
  opencl::Buffer<cl_float> packed;
  int stride = 0;
  opencl::Buffer<cl_int> row_first;  ///< height + 1 starts of the rows
  opencl::Buffer<cl_int> count;      ///< {number of edges, edges cut off because the capacity ran out}
  cl_int host_count = 0;             ///< count[0] after read_count()
  cl_int host_dropped = 0;           ///< count[1] after read_count(); if not 0, the frame reports an overflow

  /// Allocates room for `capacity` edges. Growing discards the contents.
  void reserve(opencl::Context& context, int capacity) {
    packed.ensure(context, 5 * static_cast<std::size_t>(capacity));
    stride = capacity;
  }

  /// Waits for the detection and copies the two numbers of `count` to the host.
  void read_count() {
    request_count();
    count.context()->finish();
  }
  /// read_count() without the wait: both numbers are valid after the next one.
  void request_count() {
    count.read_later(&host_count, 1);
    count.read_later(&host_dropped, 1, 1);
  }

  /// After read_count().
  PositionsView positions() const { return {packed, {0, stride, host_count}}; }

  /// Copies the edges to the host; call it after read_count(). `height`: of the image [px].
  EdgeSet read(int height) const {
    EdgeSet edges;
    const opencl::CopyGuard guard(*packed.context());
    std::size_t block = 0;
    for (auto* values : {&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_drift}) {
      values->resize(static_cast<std::size_t>(host_count));
      packed.read_later(values->data(), values->size(), static_cast<std::size_t>(stride) * block++);
    }
    edges.row_first = row_first.read(static_cast<std::size_t>(height) + 1);
    return edges;
  }
};

}  // namespace quadedge::stages
