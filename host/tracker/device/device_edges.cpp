/// \file device_edges.cpp  Columns of stereo edges as aligned parts of one buffer, which a single transfer reads.
#include "device/device_edges.hpp"

#include <algorithm>

#include "common/numeric.hpp"

namespace quadedge::stages {
namespace {

constexpr std::size_t kFloatBlocks = 7;  // of `packed`

/// Copies `count` values of any four-byte type.
template <class T>
void copy_values(const cl_uchar* source, std::size_t count, std::vector<T>& values) {
  const T* const first = reinterpret_cast<const T*>(source);
  values.assign(first, first + count);
}

}  // namespace

void DeviceStereoEdges::reserve(opencl::Context& context, std::size_t rows) {
  if (room_ > 0 && rows <= room_) return;
  room_ = std::max<std::size_t>(rows + (room_ > 0 ? rows / 8 : 0), 1);
  const auto behind = [&](std::size_t begin, std::size_t values) {
    const std::size_t end = begin + 4 * values, step = context.region_alignment();
    return (end + step - 1) / step * step;
  };
  places_.left_index = behind(0, 2);
  places_.right_index = behind(places_.left_index, room_);
  places_.packed = behind(places_.right_index, room_);
  places_.ncc = behind(places_.packed, kFloatBlocks * room_);
  places_.end = behind(places_.ncc, room_);
  block.ensure(context, places_.end);
  total.place(context, block, 0, 2);
  left_index.place(context, block, places_.left_index, room_);
  right_index.place(context, block, places_.right_index, room_);
  packed.place(context, block, places_.packed, kFloatBlocks * room_);
  ncc.place(context, block, places_.ncc, room_);
}

void DeviceStereoEdges::read(opencl::Context& context, opencl::ReadBack& read_back, StereoEdges& edges) {
  const auto all = {&edges.left_x,  &edges.left_y,          &edges.left_direction,   &edges.right_x,
                    &edges.right_y, &edges.right_direction, &edges.left_scale_shift, &edges.ncc};
  for (auto* values : all) values->reserve(room_);  // steady frames allocate nothing
  for (auto* values : {&edges.left_index, &edges.right_index}) values->reserve(room_);
  read_back.read(context, block, places_.end, [&](const cl_uchar* bytes) {
    count = *reinterpret_cast<const cl_int*>(bytes);
    const auto found = static_cast<std::size_t>(count);
    copy_values(bytes + places_.left_index, found, edges.left_index);
    copy_values(bytes + places_.right_index, found, edges.right_index);
    const cl_uchar* values = bytes + places_.packed;
    for (auto* column : {&edges.left_x, &edges.left_y, &edges.left_direction, &edges.right_x, &edges.right_y,
                         &edges.right_direction, &edges.left_scale_shift}) {
      copy_values(values, found, *column);
      values += 4 * static_cast<std::size_t>(stride);
    }
    copy_values(bytes + places_.ncc, found, edges.ncc);
  });
}

}  // namespace quadedge::stages
