/// \file kept_frame_edges.cpp  Quantises evenly chosen edges' patches and descriptors to four bits per value.
#include "edges/kept_frame_edges.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/stored_patch.hpp"

namespace quadedge::frontend {
namespace {

constexpr int kLargestNibble = 7;  ///< of a sample; samples are stored as 1 to 15
constexpr int kZeroNibble = 8;
constexpr int kWideUnit = 8, kLargestWide = 15;  ///< of a descriptor's values, which clipping keeps below 128

/// Appends values of four bits, two per byte.
void append_nibbles(const std::vector<int>& values, std::vector<std::uint8_t>& bytes) {
  for (std::size_t i = 0; i < values.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(values[i] | (values[i + 1] << 4)));
}

int nibble(const std::uint8_t* bytes, std::size_t i) { return (bytes[i / 2] >> (4 * (i % 2))) & 15; }

/// The nibbles of all samples, from -kPatchLargest on.
std::array<int, 2 * kPatchLargest + 1> sample_nibbles() {
  std::array<int, 2 * kPatchLargest + 1> nibbles;
  for (int sample = -kPatchLargest; sample <= kPatchLargest; ++sample)
    nibbles[static_cast<std::size_t>(sample + kPatchLargest)] =
        kZeroNibble + static_cast<int>(std::lround(1.0 * sample * kLargestNibble / kPatchLargest));
  return nibbles;
}

/// Appends the samples of both sides.
void append_samples(const std::int8_t* edge, std::vector<int>& values) {
  static const auto nibbles = sample_nibbles();
  for (int side = 0; side < 2; ++side)
    for (const double sample : stored_side(edge, side))
      values.push_back(nibbles[static_cast<std::size_t>(static_cast<int>(sample) + kPatchLargest)]);
}

/// Restores the patches of one edge from sample `first` on.
void restore_patches(const std::uint8_t* bytes, std::size_t first, std::int8_t* edge) {
  for (int side = 0; side < 2; ++side) {
    PatchValues values;
    double sum = 0;
    for (double& value : values) sum += value = nibble(bytes, first++) - kZeroNibble;
    for (double& value : values) value -= sum / kPatchSamples;
    store_side(values, side, edge);
  }
}

}  // namespace

std::size_t KeptFrameEdges::bytes() const {
  constexpr std::size_t kColumns = 10;
  return sizeof(KeptFrameEdges) + edges.size() * kColumns * sizeof(float) + patches.size() + wide.size();
}

KeptFrameEdges keep_edges(const FrameEdges& frame_edges, const DescribedRows& described,
                          const std::vector<std::int8_t>& left_patches, const std::vector<std::int32_t>& left_entry,
                          const std::vector<std::int8_t>& right_patches) {
  const std::size_t rows = described.wide.size() / kWideBytes, count = std::min(rows, kKeptEdges);
  const auto row_of = [&](std::size_t k) { return k * rows / count; };
  const auto edge_of = [&](std::size_t k) { return row_of(k) * static_cast<std::size_t>(described.step); };
  KeptFrameEdges kept;
  kept.frame = frame_edges.frame;
  kept.edges_spacing = frame_edges.edges_spacing;
  kept.rig = frame_edges.rig();
  const auto copy = [&](const std::vector<float>& from, std::vector<float>& to) {
    for (std::size_t k = 0; k < count; ++k) to.push_back(from[edge_of(k)]);
  };
  for (const auto column : kStereoColumns) copy(frame_edges.edges.*column, kept.edges.*column);
  copy(frame_edges.edges.ncc, kept.edges.ncc);
  kept.edges.left_index.resize(count);
  std::iota(kept.edges.left_index.begin(), kept.edges.left_index.end(), 0);
  kept.edges.right_index = kept.edges.left_index;
  std::vector<int> samples, values(kWideBytes);
  for (std::size_t k = 0; k < count; ++k) {
    samples.clear();
    const auto left = static_cast<std::size_t>(left_entry[edge_of(k)]);
    append_samples(left_patches.data() + left * kEdgePatchBytes, samples);
    append_samples(right_patches.data() + edge_of(k) * kEdgePatchBytes, samples);
    append_nibbles(samples, kept.patches);
    const std::uint8_t* const descriptor = described.wide.data() + row_of(k) * kWideBytes;
    for (std::size_t i = 0; i < kWideBytes; ++i)
      values[i] = std::min((descriptor[i] + kWideUnit / 2) / kWideUnit, kLargestWide);
    append_nibbles(values, kept.wide);
  }
  return kept;
}

KeptPatches unpack_patches(const KeptFrameEdges& kept) {
  const std::size_t count = kept.edges.size();
  KeptPatches patches{std::vector<std::int8_t>(count * kEdgePatchBytes),
                      std::vector<std::int8_t>(count * kEdgePatchBytes)};
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint8_t* const bytes = kept.patches.data() + k * kKeptPatchBytes;
    restore_patches(bytes, 0, patches.left.data() + k * kEdgePatchBytes);
    restore_patches(bytes, 2 * kPatchSamples, patches.right.data() + k * kEdgePatchBytes);
  }
  return patches;
}

std::vector<std::uint8_t> unpack_wide(const KeptFrameEdges& kept) {
  std::vector<std::uint8_t> wide(kept.edges.size() * kWideBytes);
  for (std::size_t i = 0; i < wide.size(); ++i)
    wide[i] = static_cast<std::uint8_t>(kWideUnit * nibble(kept.wide.data(), i));
  return wide;
}

}  // namespace quadedge::frontend
