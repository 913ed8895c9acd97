/// \file frame_mask.cpp  Takes the nearest recorded pixel of every pinhole pixel, from offsets that are kept.
#include "geometry/frame_mask.hpp"

#include <algorithm>
#include <cmath>

namespace quadedge {

bool hides(const PixelMask& mask, double x, double y) {
  if (mask.empty()) return false;
  const auto column = std::clamp(static_cast<int>(std::lround(x)), 0, mask.width - 1),
             row = std::clamp(static_cast<int>(std::lround(y)), 0, mask.height - 1);
  return mask.hidden[static_cast<std::size_t>(row) * static_cast<std::size_t>(mask.width) +
                     static_cast<std::size_t>(column)] != 0;
}

void MaskTransfer::run(const ImageView& mask, const PinholeCamera& view, const UndistortionTable& table,
                       PixelMask& hidden) {
  if (mask.empty()) {
    hidden = {};
    return;
  }
  hidden.width = view.width;
  hidden.height = view.height;
  hidden.hidden.resize(static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
  std::uint8_t* to = hidden.hidden.data();
  if (table.empty()) {
    for (int y = 0; y < view.height; ++y, to += view.width) {
      const std::uint8_t* row = mask.pixels + y * mask.stride;
      for (int x = 0; x < view.width; ++x) to[x] = row[x] == 0 ? 1 : 0;
    }
    return;
  }
  if (source_.empty() || stride_ != mask.stride) find_sources(mask, table);
  for (const std::int32_t offset : source_) *to++ = mask.pixels[offset] == 0 ? 1 : 0;
}

/// Positions beyond the recorded image count as its border.
void MaskTransfer::find_sources(const ImageView& mask, const UndistortionTable& table) {
  stride_ = mask.stride;
  source_.resize(table.source_x.size());
  const auto nearest = [](float position, int last) {
    return std::isnan(position)
               ? 0
               : static_cast<std::int32_t>(std::clamp(std::round(position), 0.0F, static_cast<float>(last)));
  };
  for (std::size_t i = 0; i < source_.size(); ++i)
    source_[i] = nearest(table.source_y[i], mask.height - 1) * static_cast<std::int32_t>(stride_) +
                 nearest(table.source_x[i], mask.width - 1);
}

}  // namespace quadedge
