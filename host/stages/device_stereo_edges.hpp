#pragma once
/// \file device_stereo_edges.hpp  The stereo edges of one rig on the device, with what the matching in time needs of
/// them.

#include <utility>

#include "opencl/buffer.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_image.hpp"
#include "stages/packed_positions.hpp"

namespace quadedge::stages {

/// Stereo edges in the scan order of their left edges. Everything a later frame needs stands here, so that the edges of
/// the frame itself can be overwritten.
struct DeviceStereoEdges {
  opencl::Buffer<cl_int> left_index, right_index;
  /// Seven blocks of `stride` floats: left x, y, direction, right x, y, direction [px, rad], left scale drift [px].
  opencl::Buffer<cl_float> packed;
  opencl::Buffer<cl_float> ncc;
  opencl::Buffer<cl_char> left_patches;   ///< of every edge of the left image, see host/reference/patches.hpp
  opencl::Buffer<cl_char> right_patches;  ///< of every stereo edge, cut at its refined position
  DeviceImage left_image, right_image;    ///< undistorted, for SIFT descriptors when a search asks for them
  opencl::Buffer<cl_uchar> left_sift,
      right_sift;  ///< of every stereo edge, where has_sift; see host/reference/sift.hpp
  bool has_sift = false;
  int stride = 0;
  cl_int count = 0;

  PositionsView positions(Side side) const { return {packed, {3 * index_of(side) * stride, stride, count}}; }

  /// Copies the rows to the host, and their number, which stands in `total` first; waits for the device once. As many
  /// rows as there may be are copied, as their number is not known yet.
  void read(const opencl::Buffer<cl_int>& total, StereoEdges& edges) {
    const auto size = static_cast<std::size_t>(stride), step = size;
    for (auto [buffer, values] :
         {std::pair(&left_index, &edges.left_index), std::pair(&right_index, &edges.right_index)}) {
      values->resize(size);
      buffer->read_later(values->data(), size);
    }
    std::size_t block = 0;
    for (auto* values : {&edges.left_x, &edges.left_y, &edges.left_direction, &edges.right_x, &edges.right_y,
                         &edges.right_direction, &edges.left_scale_drift}) {
      values->resize(size);
      packed.read_later(values->data(), size, step * block++);
    }
    edges.ncc.resize(size);
    ncc.read_later(edges.ncc.data(), size);
    total.read(&count, 1);
    const auto found = static_cast<std::size_t>(count);
    for (auto* values : {&edges.left_index, &edges.right_index}) values->resize(found);
    for (auto* values : {&edges.left_x, &edges.left_y, &edges.left_direction, &edges.right_x, &edges.right_y,
                         &edges.right_direction, &edges.left_scale_drift, &edges.ncc})
      values->resize(found);
  }
};

}  // namespace quadedge::stages
