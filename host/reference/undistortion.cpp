#include "reference/undistortion.hpp"

#include <algorithm>

namespace quadedge::reference {

Image undistort(const ImageView& recorded, const UndistortionTable& table) {
  Image image(table.width, table.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const float x = std::clamp(table.source_x[i], 0.0f, static_cast<float>(recorded.width - 1));
    const float y = std::clamp(table.source_y[i], 0.0f, static_cast<float>(recorded.height - 1));
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const int x1 = std::min(x0 + 1, recorded.width - 1), y1 = std::min(y0 + 1, recorded.height - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const float top = (1.0f - fx) * recorded.at(x0, y0) + fx * recorded.at(x1, y0);
    const float bottom = (1.0f - fx) * recorded.at(x0, y1) + fx * recorded.at(x1, y1);
    // Never negative, and rounded as the kernel rounds.
    image.pixels[i] = static_cast<std::uint8_t>((1.0f - fy) * top + fy * bottom + 0.5f);  // NOLINT(bugprone-*)
  }
  return image;
}

}  // namespace quadedge::reference
