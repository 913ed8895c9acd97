#pragma once
/// \file quad_rows.hpp  Rows that temporal_match.cl and temporal_quads.cl write: kQuadRowInts ints each.

#include <cstring>

#include "common/layouts.hpp"
#include "opencl/context.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::stages {

/// The float whose bits a kernel wrote among ints.
inline float from_bits(cl_int bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// Adds the quad of a row, if it has one. \param base_edge that the row belongs to \param edges the current ones
inline void append_row(const cl_int* row, std::int32_t base_edge, const StereoEdges& edges, TemporalMatches& matches) {
  if (row[0] >= 0) matches.append(base_edge, row[0], edges, from_bits(row[2]), row[1]);
}

}  // namespace quadedge::stages
