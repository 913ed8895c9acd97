#pragma once
/// \file device_stereo_edges.hpp  The stereo edges of one rig on the device, with what the matching in time needs of them.

#include "opencl/buffer.hpp"
#include "quadedge/edges.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

/// Stereo edges in the scan order of their left edges. Everything a later frame needs stands here, so that the edges of the frame
/// itself can be overwritten.
struct DeviceStereoEdges {
  opencl::Buffer<cl_int> left_index, right_index;
  /// Six blocks of `stride` floats: left x, y, direction, right x, y, direction [px, rad].
  opencl::Buffer<cl_float> packed;
  opencl::Buffer<cl_float> right_x, right_y, right_direction;  ///< the right blocks again, for cutting patches
  opencl::Buffer<cl_float> ncc;
  opencl::Buffer<cl_float> left_patches;                       ///< of every edge of the left image, see host/reference/patches.hpp
  opencl::Buffer<cl_float> right_patches;                      ///< of every stereo edge, cut at its refined place
  DeviceImage left_image, right_image;                         ///< undistorted, for SIFT descriptors when a search asks for them
  opencl::Buffer<cl_uchar> left_sift, right_sift;              ///< of every stereo edge, where has_sift; see host/reference/sift.hpp
  bool has_sift = false;
  int stride = 0;
  int count = 0;

  /// Copies the rows to the host.
  StereoEdges read() const {
    const auto size = static_cast<std::size_t>(count), step = static_cast<std::size_t>(stride);
    StereoEdges edges;
    edges.left_index = left_index.read(size);
    edges.right_index = right_index.read(size);
    const auto block = [&](std::size_t number) {
      std::vector<float> values(size);
      packed.read(values.data(), size, number * step);
      return values;
    };
    edges.left_x = block(0);
    edges.left_y = block(1);
    edges.left_direction = block(2);
    edges.right_x = block(3);
    edges.right_y = block(4);
    edges.right_direction = block(5);
    edges.ncc = ncc.read(size);
    return edges;
  }
};

}  // namespace quadedge::stages
