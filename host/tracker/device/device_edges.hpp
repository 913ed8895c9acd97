#pragma once
/// \file device_edges.hpp  Edges and stereo edges on the device, as stages pass them on.

#include <initializer_list>
#include <vector>

#include "common/layouts.hpp"
#include "device/buffer.hpp"
#include "device/context.hpp"
#include "device/images.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::stages {

/// Positions of edges, x, y [px] and direction [rad], in a buffer that another object owns.
struct PositionsView {
  const opencl::Buffer<cl_float>& packed;
  PackedPositions at;
};

/// Lists of edges in one buffer, each a block of x, one of y and one of direction.
class DevicePositions {
 public:
  /// Replaces the contents. The copy is complete after the next read() of a buffer of the context; do not call this
  /// again before.
  void write(opencl::Context& context, std::initializer_list<EdgePositionsView> lists) {
    at_.clear();
    staged_.clear();
    for (const auto& list : lists) {
      const auto count = static_cast<int>(list.size());
      at_.push_back({static_cast<int>(staged_.size()), count, count});
      for (const auto* block : {&list.x, &list.y, &list.direction})
        staged_.insert(staged_.end(), block->begin(), block->end());
    }
    packed_.ensure(context, staged_.size());
    packed_.write_later(staged_.data(), staged_.size());
  }

  /// The list with that number, as written last.
  PositionsView list(int number = 0) const { return {packed_, at_.at(static_cast<std::size_t>(number))}; }

 private:
  opencl::Buffer<cl_float> packed_;
  std::vector<PackedPositions> at_;
  std::vector<float> staged_;  ///< kept for its memory
};

/// Third-order edges in scan order (EdgeSet on the device). Only the first host_count elements of a block are valid.
struct DeviceEdges {
  /// Five blocks of `stride` floats: x, y [px], direction [rad], strength [grey levels per px], scale-space shift [px].
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
    for (auto* values : {&edges.x, &edges.y, &edges.direction, &edges.strength, &edges.scale_shift}) {
      values->resize(static_cast<std::size_t>(host_count));
      packed.read_later(values->data(), values->size(), static_cast<std::size_t>(stride) * block++);
    }
    edges.row_first = row_first.read(static_cast<std::size_t>(height) + 1);
    return edges;
  }
};

/// The maxima of one image on the device.
struct EdgeMaxima {
  /// 4 floats per maximum: x, y [px], column of the pixel, direction code (kernels/edge_detection.cl). Room for every
  /// pixel and kMaximaAtOnce more.
  opencl::Buffer<cl_float> winners;
  opencl::Buffer<cl_int> counts;   ///< maxima per row
  opencl::Buffer<cl_uchar> flags;  ///< 1 for pixels that are maxima; only with `at_pixels`
  bool at_pixels =
      false;  ///< maxima are stored at the position of their pixel and marked in `flags`; otherwise rows are packed

  /// Defines of the kernels that thin out the maxima.
  opencl::Defines defines() const { return at_pixels ? opencl::Defines{{"AT_PIXELS", "1"}} : opencl::Defines{}; }
};

/// Stereo edges in the scan order of their left edges, with everything that a later frame needs, so that the edges of
/// the frame itself can be overwritten.
struct DeviceStereoEdges {
  opencl::Buffer<cl_uchar> block;  ///< holds the next five arrays, which the host reads in one copy
  opencl::Buffer<cl_int> total;    ///< {number of rows, 0}
  opencl::Buffer<cl_int> left_index, right_index;
  /// Seven blocks of `stride` floats: left x, y, direction, right x, y, direction [px, rad], left scale-space shift
  /// [px].
  opencl::Buffer<cl_float> packed;
  opencl::Buffer<cl_float> ncc;
  opencl::Buffer<cl_char> left_patches;   ///< of the left edges that have candidates, see patches.cl
  opencl::Buffer<cl_char> right_patches;  ///< of every stereo edge, cut at its refined position
  DeviceImage left_image, right_image;    ///< undistorted, for SIFT descriptors when a search asks for them
  opencl::Buffer<cl_uchar> left_sift,
      right_sift;  ///< of every stereo edge, where has_sift; see reference/edge_descriptions.hpp
  bool has_sift = false;
  int stride = 0;
  cl_int count = 0;

  PositionsView positions(Side side) const { return {packed, {3 * index_of(side) * stride, stride, count}}; }

  /// Makes room for `rows` stereo edges; contents are lost when it grows.
  void reserve(opencl::Context& context, std::size_t rows);
  /// Copies the rows to `edges` and their number to `count`; waits for the device once.
  void read(opencl::Context& context, opencl::ReadBack& read_back, StereoEdges& edges);

 private:
  /// Where the arrays begin in the block [bytes].
  struct Places {
    std::size_t left_index = 0, right_index = 0, packed = 0, ncc = 0, end = 0;
  };
  Places places_;
  std::size_t room_ = 0;  ///< rows
};

}  // namespace quadedge::stages
