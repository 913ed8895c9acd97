/// \file images.cpp  Bilinear interpolation by the table; binomial weights from Pascal's triangle, in integers.
#include "reference/images.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "geometry/undistortion.hpp"

namespace quadedge::reference {

Image pinhole_image(const ImageView& recorded, const UndistortionTable& table) {
  if (!table.empty()) return undistort(recorded, table);
  Image image(recorded.width, recorded.height, recorded.max_value);
  const std::ptrdiff_t row = image.view().stride;
  for (int y = 0; y < recorded.height; ++y) {
    std::copy_n(recorded.pixels + y * recorded.stride, row, image.pixels.begin() + y * row);
  }
  return image;
}

Image smoothed(const ImageView& image) {
  constexpr int kOrder = 16;
  std::vector<std::int64_t> weights = {1};  // a row of Pascal's triangle
  for (int k = 0; k < kOrder; ++k) weights.push_back(weights.back() * (kOrder - k) / (k + 1));
  Image result(image.width, image.height, image.max_value);
  const auto clamped = [](int i, int size) { return std::clamp(i, 0, size - 1); };
  const auto weight = [&](int offset) { return weights[static_cast<std::size_t>(offset + kOrder / 2)]; };
  std::vector<std::int64_t> along_y(static_cast<std::size_t>(image.width));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      std::int64_t sum = 0;
      for (int k = -kOrder / 2; k <= kOrder / 2; ++k) sum += weight(k) * image.value(x, clamped(y + k, image.height));
      along_y[static_cast<std::size_t>(x)] = sum;
    }
    for (int x = 0; x < image.width; ++x) {
      std::int64_t sum = std::int64_t{1} << (2 * kOrder - 1);  // a half
      for (int k = -kOrder / 2; k <= kOrder / 2; ++k)
        sum += weight(k) * along_y[static_cast<std::size_t>(clamped(x + k, image.width))];
      result.set(x, y, static_cast<int>(sum >> (2 * kOrder)));
    }
  }
  return result;
}

}  // namespace quadedge::reference
