#pragma once
/// \file coarse_disparity.hpp  Stage 5c: a coarse disparity of the pair, a witness where neighbouring edges disagree.

#include <map>
#include <string>

#include "opencl/argument_structs.hpp"
#include "stages/device_image.hpp"

namespace quadedge::stages {

/// doc/method.md section 3, filter 10. Variants of the stage "coarse_disparity". Its memory, of the size of the largest
/// search so far, is allocated by the first run.
class CoarseDisparity {
 public:
  /// `max_value`: largest value of the images' pixels.
  CoarseDisparity(opencl::Context& context, const std::map<std::string, std::string>& variants, int max_value);

  /// Memory that a search takes [bytes].
  static std::size_t bytes(const CoarseDisparityArguments& search);

  /// Matches the images of `search`, which are rectified.
  void run(const DeviceImage& left, const DeviceImage& right, const CoarseDisparityArguments& search);

  /// height x width of the search, see host/reference/coarse_disparity.hpp.
  const opencl::Buffer<cl_float>& positions() const { return positions_; }
  /// The last search.
  const CoarseDisparityArguments& search() const { return search_; }

 private:
  template <class T>
  using In = opencl::In<T>;
  template <class T>
  using Out = opencl::Out<T>;

  /// Rows of planes: `front` places, then one per column of the half-size image, `stride` in all.
  struct PlaneRows {
    int width, front, stride;
    bool mirrored;
  };
  void prepare(const DeviceImage& image, int height, const PlaneRows& rows, opencl::Buffer<cl_uchar>& planes);

  opencl::Context& context_;
  CoarseDisparityArguments search_{};
  int strip_;  ///< columns per work-item of coarse_columns
  std::size_t items_per_row_;
  opencl::Buffer<cl_uchar> half_, left_planes_, right_planes_, costs_;
  opencl::Buffer<cl_ushort> sums_;
  opencl::Buffer<cl_uint> lowest_;
  opencl::Buffer<cl_float> positions_;
  opencl::Kernel<In<cl_uchar>, cl_int, cl_int, Out<cl_uchar>> halve_;
  opencl::Kernel<In<cl_uchar>, cl_int, cl_int, cl_int, cl_int, cl_int, Out<cl_uchar>> planes_;
  opencl::Kernel<CoarseDisparityArguments, In<cl_uchar>, In<cl_uchar>, Out<cl_uchar>, Out<cl_ushort>> rows_;
  opencl::Kernel<CoarseDisparityArguments, In<cl_uchar>, Out<cl_ushort>> columns_;
  opencl::Kernel<CoarseDisparityArguments, In<cl_ushort>, Out<cl_uint>, Out<cl_float>> choose_;
};

}  // namespace quadedge::stages
