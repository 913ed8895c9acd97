#pragma once
/// \file side.hpp  The two cameras of a rig.

namespace quadedge {

enum class Side { left, right };

inline constexpr Side kSides[] = {Side::left, Side::right};

/// Index of a side in arrays of two: left 0, right 1.
constexpr int index_of(Side side) { return side == Side::left ? 0 : 1; }

}  // namespace quadedge
