#pragma once
/// \file device_stereo_edges.hpp  The stereo edges of one rig on the device, with what the matching in time needs of
/// them.

#include "opencl/buffer.hpp"
#include "opencl/read_back.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_image.hpp"
#include "stages/packed_positions.hpp"

namespace quadedge::stages {

/// Stereo edges in the scan order of their left edges, with everything that a later frame needs, so that the edges of
/// the frame itself can be overwritten.
struct DeviceStereoEdges {
  opencl::Buffer<cl_uchar> block;  ///< holds the next five arrays, which the host reads in one copy
  opencl::Buffer<cl_int> total;    ///< {number of rows, 0}
  opencl::Buffer<cl_int> left_index, right_index;
  /// Seven blocks of `stride` floats: left x, y, direction, right x, y, direction [px, rad], left scale drift [px].
  opencl::Buffer<cl_float> packed;
  opencl::Buffer<cl_float> ncc;
  opencl::Buffer<cl_char> left_patches;   ///< of the left edges that have candidates, see host/reference/patches.hpp
  opencl::Buffer<cl_char> right_patches;  ///< of every stereo edge, cut at its refined position
  DeviceImage left_image, right_image;    ///< undistorted, for SIFT descriptors when a search asks for them
  opencl::Buffer<cl_uchar> left_sift,
      right_sift;  ///< of every stereo edge, where has_sift; see host/reference/sift.hpp
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
