#include "reference/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace quadedge::reference {
namespace {

double bilinear(const ImageView& image, double x, double y) {
  x = std::clamp(x, 0.0, image.width - 1.0);
  y = std::clamp(y, 0.0, image.height - 1.0);
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  const int x1 = std::min(x0 + 1, image.width - 1), y1 = std::min(y0 + 1, image.height - 1);
  const double fx = x - x0, fy = y - y0;
  const double top = image.at(x0, y0) + fx * (image.at(x1, y0) - image.at(x0, y0));
  const double bottom = image.at(x0, y1) + fx * (image.at(x1, y1) - image.at(x0, y1));
  return top + fy * (bottom - top);
}

/// Position of sample k = kPatchSide i + j.
int position(int side, int k) { return kPatchLanes * (2 * (k / kPatchSide) + side) + k % kPatchSide; }

/// One mean-free patch around (x, y) with its unit tangent (c, s).
PatchValues sample_patch(const ImageView& image, double x, double y, double c, double s) {
  PatchValues values;
  for (int i = 0; i < kPatchRows; ++i) {
    for (int j = 0; j < kPatchSide; ++j) {
      const double along = kPatchRowStep * static_cast<float>(i - kPatchRows / 2), across = j - kPatchSide / 2;
      values[i * kPatchSide + j] = bilinear(image, x + along * c - across * s, y + along * s + across * c);
    }
  }
  // Subtracting the middle sample first makes a constant patch exactly zero.
  const double middle = values[kPatchSamples / 2];
  double mean = 0;
  for (double& value : values) mean += value -= middle;
  mean /= kPatchSamples;
  for (double& value : values) value -= mean;
  return values;
}

float side_ncc(const std::int8_t* a, int side_a, const std::int8_t* b, int side_b) {
  int products = 0;
  for (int k = 0; k < kPatchSamples; ++k) products += a[position(side_a, k)] * b[position(side_b, k)];
  return static_cast<float>(products) * inverse_norm(a, side_a) * inverse_norm(b, side_b);
}

}  // namespace

void store_side(const PatchValues& values, int side, std::int8_t* edge) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const double scale = largest < kFlatPatchContrast ? 0.0 : kPatchLargest / largest;
  int squares = 0;
  for (int k = 0; k < kPatchSamples; ++k) {
    const int sample = static_cast<int>(std::nearbyint(values[k] * scale));
    edge[position(side, k)] = static_cast<std::int8_t>(sample);
    squares += sample * sample;
  }
  const float inverse = squares == 0 ? 0.0f : 1.0f / std::sqrt(static_cast<float>(squares));
  std::memcpy(edge + kInverseNorms + side * sizeof(float), &inverse, sizeof(float));
}

PatchValues stored_side(const std::int8_t* edge, int side) {
  PatchValues values;
  for (int k = 0; k < kPatchSamples; ++k) values[k] = edge[position(side, k)];
  return values;
}

float inverse_norm(const std::int8_t* edge, int side) {
  float inverse;
  std::memcpy(&inverse, edge + kInverseNorms + side * sizeof(float), sizeof(float));
  return inverse;
}

std::vector<std::int8_t> side_patches(const ImageView& image, const std::vector<float>& xs,
                                      const std::vector<float>& ys, const std::vector<float>& directions,
                                      const PatchesConfig& config) {
  std::vector<std::int8_t> patches(xs.size() * kEdgePatchBytes);
  for (std::size_t e = 0; e < xs.size(); ++e) {
    const double c = std::cos(static_cast<double>(directions[e])), s = std::sin(static_cast<double>(directions[e]));
    const double to_dark_x = config.offset * s, to_dark_y = -config.offset * c;
    std::int8_t* edge = patches.data() + e * kEdgePatchBytes;
    store_side(sample_patch(image, xs[e] + to_dark_x, ys[e] + to_dark_y, c, s), 0, edge);
    store_side(sample_patch(image, xs[e] - to_dark_x, ys[e] - to_dark_y, c, s), 1, edge);
  }
  return patches;
}

float patch_ncc(const std::int8_t* a, const std::int8_t* b) {
  return std::max({side_ncc(a, 0, b, 0), side_ncc(a, 1, b, 1), side_ncc(a, 0, b, 1), side_ncc(a, 1, b, 0)});
}

}  // namespace quadedge::reference
