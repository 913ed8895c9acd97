#pragma once
/// \file kept_frame_edges.hpp  A frame's edges in a compact form on the host, from which a front end restores them.

#include <cstdint>
#include <vector>

#include "common/layouts.hpp"
#include "edges/frame_edges.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// Columns of StereoEdges that describe the two edges, in the order in which devices and maps hold them.
inline constexpr std::vector<float> StereoEdges::*kStereoColumns[] = {
    &StereoEdges::left_x,  &StereoEdges::left_y,          &StereoEdges::left_direction,  &StereoEdges::right_x,
    &StereoEdges::right_y, &StereoEdges::right_direction, &StereoEdges::left_scale_shift};

/// Maximum number of stereo edges of a kept frame: 0.42 MB.
constexpr std::size_t kKeptEdges = 2400;

/// A subset of a frame's stereo edges, evenly from the list, with what matching needs of them. Samples of patches and
/// values of descriptors have four bits.
struct KeptFrameEdges {
  int frame = -1;
  double edges_spacing = 0;                          ///< see FrameEdges
  std::shared_ptr<const StereoRig> own_calibration;  ///< see FrameEdges
  RigEstimate rig;                                   ///< see FrameEdges
  StereoEdges edges;                                 ///< left_index and right_index count from 0
  std::vector<std::uint8_t> patches;                 ///< kKeptPatchBytes per edge: left, then right
  std::vector<std::uint8_t> wide;                    ///< kKeptWideBytes per edge

  std::size_t bytes() const;
};

/// Two values per byte: both patches of both images, and the descriptor.
constexpr std::size_t kKeptPatchBytes = 2 * kPatchSamples, kKeptWideBytes = kWideBytes / 2;

/// Every `step`-th stereo edge of a frame with its wide descriptor, kWideBytes each.
struct DescribedRows {
  int step;
  std::vector<std::uint8_t> wide;
};

/// Keeps at most kKeptEdges of the described edges, evenly. \param left_patches kEdgePatchBytes per entry \param
/// left_entry the entry of every stereo edge in it \param right_patches kEdgePatchBytes per stereo edge
KeptFrameEdges keep_edges(const FrameEdges& frame_edges, const DescribedRows& described,
                          const std::vector<std::int8_t>& left_patches, const std::vector<std::int32_t>& left_entry,
                          const std::vector<std::int8_t>& right_patches);

/// Patches as the stages lay them out, kEdgePatchBytes per edge.
struct KeptPatches {
  std::vector<std::int8_t> left, right;
};
KeptPatches unpack_patches(const KeptFrameEdges& kept);

/// Wide descriptors, kWideBytes per edge.
std::vector<std::uint8_t> unpack_wide(const KeptFrameEdges& kept);

}  // namespace quadedge::frontend
