#pragma once
/// \file nearest_word.hpp  Suggestions for mistyped words.

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

namespace quadedge {

/// Number of edits (insertion, deletion, substitution, transposition of neighbours) from `a` to `b`: optimal string
/// alignment.
inline std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  std::iota(above.begin(), above.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(above);
    above.swap(row);
  }
  return above[b.size()];
}

/// The word nearest to `typed`, or an empty string if more than a third of its letters would have to change.
inline std::string nearest_word(const std::string& typed, const std::vector<std::string>& words) {
  std::string nearest;
  std::size_t least = typed.size() / 3 + 1;
  if (typed.size() > 100) return nearest;
  for (const auto& word : words) {
    const std::size_t distance = edit_distance(typed, word);
    if (distance < least || (distance == least && nearest.empty())) {
      least = distance;
      nearest = word;
    }
  }
  return nearest;
}

/// "; did you mean 'run'?", or an empty string.
inline std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words) {
  const std::string nearest = nearest_word(typed, words);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

}  // namespace quadedge
