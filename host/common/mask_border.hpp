#pragma once
/// \file mask_border.hpp  Extends masks by a margin.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// A mask that also hides pixels up to `margin` pixels away along a row, a column, or both. This is the extent of an
/// edge's neighbourhood and equals the margin at the image border.
inline PixelMask with_border(const PixelMask& mask, int margin) {
  const auto spread = [&](const std::vector<std::uint8_t>& from, int lines, int length, int line_step, int step) {
    std::vector<std::uint8_t> to(from.size());
    for (int line = 0; line < lines; ++line) {
      const auto at = [&](int i) { return static_cast<std::size_t>(line * line_step + i * step); };
      int last = -margin - 1;  // last hidden pixel so far; then, from the other end, the next one
      for (int i = 0; i < length; ++i) {
        if (from[at(i)] != 0) last = i;
        if (i - last <= margin) to[at(i)] = 1;
      }
      last = length + margin;
      for (int i = length - 1; i >= 0; --i) {
        if (from[at(i)] != 0) last = i;
        if (last - i <= margin) to[at(i)] = 1;
      }
    }
    return to;
  };
  const auto along_rows = spread(mask.hidden, mask.height, mask.width, mask.width, 1);
  return {mask.width, mask.height, spread(along_rows, mask.width, mask.height, 1, mask.width)};
}

}  // namespace quadedge
