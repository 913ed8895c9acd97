#pragma once
/// \file patches.hpp  Plain C++ reference of the side patches and their similarity (SPEC section 2).

#include <vector>

#include "quadedge/config.hpp"
#include "quadedge/image.hpp"

namespace quadedge::reference {

inline constexpr int kPatchSide = 7;                           ///< samples along each axis of a patch
inline constexpr int kPatchSamples = kPatchSide * kPatchSide;  ///< floats of one patch
inline constexpr int kPatchLanes = kPatchSide + 1;             ///< floats of one row of a patch, the last one zero
inline constexpr int kEdgePatchFloats = 2 * kPatchSide * kPatchLanes;  ///< floats of one edge
inline constexpr double kFlatPatchSquares = 1e-10;             ///< below this sum of squares a patch is flat

/// The two side patches of every edge, `kEdgePatchFloats` floats per edge: row by row, each row of the dark patch followed by the one
/// of the bright patch, so that sixteen floats loaded at once hold a row of both.
///
/// Sample (i, j) of the dark patch is element 16 i + j, of the bright one 16 i + 8 + j; j = 7 is zero. i steps along the tangent (cos t, sin t), j along the normal that points
/// to the bright side (-sin t, cos t), both 1 px per step; the middle sample (3, 3) lies `config.offset` px from the edge, on the
/// dark side at (x + offset sin t, y - offset cos t) and on the bright side opposite to it. Bilinear; coordinates outside the
/// image are clamped to its border. Each patch is mean-free with unit norm; a flat one (sum of squares below
/// `kFlatPatchSquares`) is all zeros, so that its NCC with anything is 0.
/// `xs`, `ys` in pixels and `directions` in radians have one entry per edge and must be finite.
std::vector<float> side_patches(const ImageView& image, const std::vector<float>& xs, const std::vector<float>& ys,
                                const std::vector<float>& directions, const PatchesConfig& config);

/// Which sides of two edges are compared; the numbers are those of kernels/similarity.cl.
enum class SidePairing : int { dark_dark = 0, bright_bright = 1, dark_bright = 2, bright_dark = 3 };

/// Highest NCC over the four pairings of sides, and the first pairing that reaches it.
struct PatchSimilarity {
  float ncc;
  SidePairing pairing;
};

/// Similarity of two edges from their patches (`kEdgePatchFloats` each). Single precision with the summation order of the
/// kernel (eight fused multiply-add lanes over the rows, then a tree), so that both give the same bits.
PatchSimilarity patch_similarity(const float* a, const float* b);

/// Only the NCC of patch_similarity().
float patch_ncc(const float* a, const float* b);

}  // namespace quadedge::reference
