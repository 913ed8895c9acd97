#pragma once
/// \file stored_patch.hpp  The bytes in which the side patches of an edge are stored: kEdgePatchBytes per edge.

#include <array>
#include <cstdint>

#include "common/layouts.hpp"

namespace quadedge {

/// Samples of one patch; sample (i, j) at kPatchSide i + j.
using PatchValues = std::array<double, kPatchSamples>;

/// Place of sample k of the dark (`side` 0) or the bright (1) patch among an edge's bytes.
constexpr int sample_position(int side, int k) { return kPatchLanes * (2 * (k / kPatchSide) + side) + k % kPatchSide; }

/// Stores a mean-free patch as the dark (`side` 0) or bright (1) one of the edge at `edge`: scaled so that its largest
/// sample becomes +-127, rounded to the nearest integer (halves to the even one), with 1 / norm of these integers. A
/// patch whose samples are all below `kFlatPatchContrast` becomes zeros with 0 for 1 / norm, so that its NCC with
/// anything is 0.
void store_side(const PatchValues& values, int side, std::int8_t* edge);

/// The integers that store_side() wrote.
PatchValues stored_side(const std::int8_t* edge, int side);

/// 1 / norm of those integers.
float inverse_norm(const std::int8_t* edge, int side);

}  // namespace quadedge
