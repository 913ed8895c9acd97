#include "reference/patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

/// One patch around (x, y) with its unit tangent (c, s); `patch`: its first row.
void sample_patch(const ImageView& image, double x, double y, double c, double s, float* patch) {
  constexpr int kHalf = kPatchSide / 2;
  std::array<double, kPatchSamples> values;
  for (int i = 0; i < kPatchSide; ++i) {
    for (int j = 0; j < kPatchSide; ++j) {
      const double along = i - kHalf, across = j - kHalf;
      values[i * kPatchSide + j] = bilinear(image, x + along * c - across * s, y + along * s + across * c);
    }
  }
  // Taking the middle sample away first makes a constant patch exactly zero.
  const double middle = values[kPatchSamples / 2];
  double mean = 0;
  for (double& value : values) mean += value -= middle;
  mean /= kPatchSamples;
  double squares = 0;
  for (double& value : values) {
    value -= mean;
    squares += value * value;
  }
  const double scale = squares < kFlatPatchSquares ? 0.0 : 1.0 / std::sqrt(squares);
  for (int i = 0; i < kPatchSide; ++i) {
    for (int j = 0; j < kPatchSide; ++j) patch[2 * kPatchLanes * i + j] = static_cast<float>(values[i * kPatchSide + j] * scale);
  }
}

float dot(const float* a, const float* b) {
  std::array<float, kPatchLanes> lane{};
  for (int i = 0; i < kPatchSide; ++i) {
    for (int l = 0; l < kPatchLanes; ++l) lane[l] = std::fma(a[2 * kPatchLanes * i + l], b[2 * kPatchLanes * i + l], lane[l]);
  }
  return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

}  // namespace

std::vector<float> side_patches(const ImageView& image, const std::vector<float>& xs, const std::vector<float>& ys,
                                const std::vector<float>& directions, const PatchesConfig& config) {
  std::vector<float> patches(xs.size() * kEdgePatchFloats);
  for (std::size_t e = 0; e < xs.size(); ++e) {
    const double c = std::cos(static_cast<double>(directions[e])), s = std::sin(static_cast<double>(directions[e]));
    const double to_dark_x = config.offset * s, to_dark_y = -config.offset * c;
    float* edge = patches.data() + e * kEdgePatchFloats;
    sample_patch(image, xs[e] + to_dark_x, ys[e] + to_dark_y, c, s, edge);
    sample_patch(image, xs[e] - to_dark_x, ys[e] - to_dark_y, c, s, edge + kPatchLanes);
  }
  return patches;
}

PatchSimilarity patch_similarity(const float* a, const float* b) {
  const float* a_bright = a + kPatchLanes;
  const float* b_bright = b + kPatchLanes;
  const std::array<float, 4> scores = {dot(a, b), dot(a_bright, b_bright), dot(a, b_bright), dot(a_bright, b)};
  const auto best = std::max_element(scores.begin(), scores.end());
  return {*best, static_cast<SidePairing>(best - scores.begin())};
}

float patch_ncc(const float* a, const float* b) { return patch_similarity(a, b).ncc; }

}  // namespace quadedge::reference
