#pragma once
/// \file patches.hpp  Plain C++ reference of the side patches and their similarity (doc/method.md section 2).

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "quadedge/config.hpp"
#include "quadedge/image.hpp"
#include "reference/photometric.hpp"

namespace quadedge::reference {

/// The two side patches of every edge, `kEdgePatchBytes` bytes per edge: row by row, each row of the dark patch
/// followed by the one of the bright patch, so that sixteen bytes loaded at once hold a row of both; then as two floats
/// 1 / norm of either patch, and eight zeros.
///
/// Sample (i, j) of the dark patch is byte 16 i + j, of the bright one 16 i + 8 + j; j = 7 is zero. i steps along the
/// tangent (cos t, sin t), j along the normal that points to the bright side (-sin t, cos t), kPatchRowStep
/// and 1 px per step; the middle sample (2, 3) lies `config.offset` px from the edge, on the dark side at (x + offset
/// sin t, y - offset cos t) and on the bright side opposite to it. Bilinear; coordinates outside the image are clamped
/// to its border. Each patch is made mean-free and stored by store_side(). `xs`, `ys` in pixels and `directions` in
/// radians have one entry per edge and must be finite.
std::vector<std::int8_t> side_patches(const ImageView& image, const std::vector<float>& xs,
                                      const std::vector<float>& ys, const std::vector<float>& directions,
                                      const PatchesConfig& config);

/// Stores a mean-free patch, sample (i, j) at 7 i + j, as the dark (`side` 0) or bright (1) one of the edge at `edge`:
/// scaled so that its largest sample becomes +-127, rounded to the nearest integer (halves to the even one), with 1 /
/// norm of these integers. A patch whose samples are all below `kFlatPatchContrast` becomes zeros with 0 for 1 / norm,
/// so that its NCC with anything is 0.
void store_side(const PatchValues& values, int side, std::int8_t* edge);

/// The integers that store_side() wrote.
PatchValues stored_side(const std::int8_t* edge, int side);

/// 1 / norm of those integers.
float inverse_norm(const std::int8_t* edge, int side);

/// NCC of two edges from their patches (`kEdgePatchBytes` each), the highest over the four pairings of sides: sums of
/// products in integers, which are exact, multiplied in single precision by 1 / norm of `a` and then of `b`, so that
/// the kernels give the same bits.
float patch_ncc(const std::int8_t* a, const std::int8_t* b);

}  // namespace quadedge::reference
