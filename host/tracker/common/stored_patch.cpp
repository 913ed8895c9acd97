/// \file stored_patch.cpp  Scales a patch to its largest sample and rounds it.
#include "common/stored_patch.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace quadedge {

void store_side(const PatchValues& values, int side, std::int8_t* edge) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  const double scale = largest < kFlatPatchContrast ? 0.0 : kPatchLargest / largest;
  int squares = 0;
  for (int k = 0; k < kPatchSamples; ++k) {
    const int sample = static_cast<int>(std::nearbyint(values[k] * scale));
    edge[sample_position(side, k)] = static_cast<std::int8_t>(sample);
    squares += sample * sample;
  }
  const float inverse = squares == 0 ? 0.0f : 1.0f / std::sqrt(static_cast<float>(squares));
  std::memcpy(edge + kInverseNorms + side * sizeof(float), &inverse, sizeof(float));
}

PatchValues stored_side(const std::int8_t* edge, int side) {
  PatchValues values;
  for (int k = 0; k < kPatchSamples; ++k) values[k] = edge[sample_position(side, k)];
  return values;
}

float inverse_norm(const std::int8_t* edge, int side) {
  float inverse;
  std::memcpy(&inverse, edge + kInverseNorms + side * sizeof(float), sizeof(float));
  return inverse;
}

}  // namespace quadedge
