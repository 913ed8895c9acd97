#include "reference/undistortion.hpp"

#include <algorithm>

namespace quadedge::reference {

Image undistort(const ImageView& recorded, const UndistortionTable& table) {
  Image image(table.width, table.height, recorded.max_value);
  for (std::size_t i = 0; i < table.source_x.size(); ++i) {
    const float x = std::clamp(table.source_x[i], 0.0f, static_cast<float>(recorded.width - 1));
    const float y = std::clamp(table.source_y[i], 0.0f, static_cast<float>(recorded.height - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, recorded.width - 1), y1 = std::min(y0 + 1, recorded.height - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const float top =
        (1.0f - fx) * static_cast<float>(recorded.value(x0, y0)) + fx * static_cast<float>(recorded.value(x1, y0));
    const float bottom =
        (1.0f - fx) * static_cast<float>(recorded.value(x0, y1)) + fx * static_cast<float>(recorded.value(x1, y1));
    // Never negative, and rounded as the kernel rounds.
    const int value = static_cast<int>((1.0f - fy) * top + fy * bottom + 0.5f);  // NOLINT(bugprone-*)
    const auto width = static_cast<std::size_t>(table.width);
    image.set(static_cast<int>(i % width), static_cast<int>(i / width), value);
  }
  return image;
}

Image pinhole_image(const ImageView& recorded, const UndistortionTable& table) {
  if (!table.empty()) return undistort(recorded, table);
  Image image(recorded.width, recorded.height, recorded.max_value);
  const std::ptrdiff_t row = image.view().stride;
  for (int y = 0; y < recorded.height; ++y) {
    std::copy_n(recorded.pixels + y * recorded.stride, row, image.pixels.begin() + y * row);
  }
  return image;
}

}  // namespace quadedge::reference
