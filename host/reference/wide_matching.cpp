#include "reference/wide_matching.hpp"

#include "common/matching_constants.hpp"
#include "reference/wide_description.hpp"

namespace quadedge::reference {
namespace {

constexpr float kSquare = static_cast<float>(kWideNorm * kWideNorm);

float similarity(const WideEdges& a, std::size_t i, const WideEdges& b, std::size_t j) {
  int sum = 0;
  for (std::size_t k = 0; k < kWideBytes; ++k)
    sum += a.descriptors[i * kWideBytes + k] * b.descriptors[j * kWideBytes + k];
  return static_cast<float>(sum);  // whole numbers below 2^24
}

bool apart(const WideEdges& set, std::size_t i, std::size_t j, float distance) {
  const auto step = static_cast<std::size_t>(set.step);
  const float dx = set.edges.left_x[i * step] - set.edges.left_x[j * step],
              dy = set.edges.left_y[i * step] - set.edges.left_y[j * step];
  return dx * dx + dy * dy > distance * distance;
}

}  // namespace

TemporalMatches wide_matches(const WideEdges& earlier, const WideEdges& current) {
  const std::size_t rows = earlier.descriptors.size() / kWideBytes, columns = current.descriptors.size() / kWideBytes;
  const float neighbourhood = static_cast<float>(kWideNeighbourhood), ratio = static_cast<float>(kWideRatio);
  TemporalMatches matches;
  for (std::size_t row = 0; row < rows; ++row) {
    std::size_t winner = columns;
    float highest = 0;
    for (std::size_t column = 0; column < columns; ++column) {
      const float value = similarity(earlier, row, current, column);
      if (value > highest) {
        winner = column;
        highest = value;
      }
    }
    if (winner == columns) continue;
    const float limit = kSquare - (kSquare - highest) / (ratio * ratio);
    bool unique = true;
    for (std::size_t other = 0; other < rows && unique; ++other) {
      unique = !(apart(earlier, other, row, neighbourhood) && similarity(earlier, other, current, winner) >= highest);
    }
    for (std::size_t column = 0; column < columns && unique; ++column) {
      unique = !(apart(current, column, winner, neighbourhood) && similarity(earlier, row, current, column) > limit);
    }
    if (!unique) continue;
    matches.append(static_cast<std::int32_t>(row) * earlier.step, static_cast<std::int32_t>(winner) * current.step,
                   current.edges, highest / kSquare, 0);
  }
  return matches;
}

}  // namespace quadedge::reference
