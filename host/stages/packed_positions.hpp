#pragma once
/// \file packed_positions.hpp  Positions and directions of edges on the device, as stages pass them on.

#include <initializer_list>
#include <vector>

#include "common/layouts.hpp"
#include "opencl/buffer.hpp"
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

}  // namespace quadedge::stages
