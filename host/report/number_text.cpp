#include "report/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "data/text.hpp"

namespace quadedge::report {
namespace {

constexpr int kDigits = 4, kMostDecimals = 9;

int decimals_of(double value) {
  const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  return std::clamp(kDigits - 1 - magnitude, 0, kMostDecimals);
}

}  // namespace

std::string significant(double value) {
  if (!std::isfinite(value)) return "-";
  const std::string text = data::format_fixed(value, decimals_of(value));
  return text.find_first_of("123456789") == std::string::npos ? "0" : text;
}

std::string share_text(int part, int whole) {
  if (whole == 0) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%d / %d (%.1f %%)", part, whole, 100.0 * part / whole);
  return text;
}

}  // namespace quadedge::report
