#pragma once
/// \file byte_layouts.hpp  What kernels store per edge, as host, kernels and reference read it.

#include <cstddef>

namespace quadedge {

inline constexpr int kPatchSide = 7;                           ///< samples along each axis of a patch
inline constexpr int kPatchSamples = kPatchSide * kPatchSide;  ///< samples of one patch
inline constexpr int kPatchLanes = kPatchSide + 1;             ///< bytes of one row of a patch, the last one zero
inline constexpr int kEdgePatchBytes = 128;                    ///< both patches of one edge
inline constexpr int kPatchLargest = 127;                      ///< magnitude of a patch's largest sample
inline constexpr double kFlatPatchContrast = 1e-5;  ///< grey levels: a patch that stays as close to its mean is flat

/// The descriptor's shape and the scale that OpenCV gives a key point of size 1 in octave 0.
inline constexpr int kSiftCells = 4;   ///< spatial bins along each axis
inline constexpr int kSiftAngles = 8;  ///< orientation bins
inline constexpr int kSiftBytes = kSiftCells * kSiftCells * kSiftAngles;
inline constexpr int kEdgeSiftBytes = 2 * kSiftBytes;  ///< bytes of one edge: dark side, then bright side

inline constexpr int kWideShrink = 3;  ///< pixels of the image per small pixel, each way
inline constexpr int kWideCells = 4;   ///< spatial bins along each axis
inline constexpr int kWideAngles = 8;  ///< orientation bins
inline constexpr int kWideBytes = kWideCells * kWideCells * kWideAngles;

/// Every wide_step()-th edge takes part in a wide search: about `wanted` of `count`.
inline int wide_step(std::size_t count, int wanted) {
  const int step = static_cast<int>(count) / wanted;
  return step > 1 ? step : 1;
}

}  // namespace quadedge
