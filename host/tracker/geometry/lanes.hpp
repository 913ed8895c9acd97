#pragma once
/// \file lanes.hpp  Structs of numbers as columns, one per member, so that loops over rows vectorise.

#include <cstddef>
#include <tuple>

namespace quadedge::pose {

/// Number of rows computed at once.
constexpr std::size_t kLanes = 8;

/// The struct `Row` whose members are row `i` of `columns`. Its Row::members() returns all members, which are doubles,
/// as std::tie() does.
template <class Row, class Columns>
[[gnu::always_inline]] inline Row row_of(const Columns& columns, std::size_t i) {
  Row row;
  std::size_t k = 0;
  std::apply([&](auto&... member) { ((member = columns[k++][i]), ...); }, Row::members(row));
  return row;
}

template <class Row, class Columns>
[[gnu::always_inline]] inline void set_row(Columns& columns, std::size_t i, const Row& row) {
  std::size_t k = 0;
  std::apply([&](const auto&... member) { ((columns[k++][i] = member), ...); }, Row::members(row));
}

/// kLanes rows side by side.
template <class Row>
struct Lanes {
  double columns[sizeof(Row) / sizeof(double)][kLanes];

  [[gnu::always_inline]] double* operator[](std::size_t column) { return columns[column]; }
  [[gnu::always_inline]] const double* operator[](std::size_t column) const { return columns[column]; }
};

}  // namespace quadedge::pose
