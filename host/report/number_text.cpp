#include "report/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace quadedge::report {
namespace {

constexpr int kDigits = 4, kMostDecimals = 9;

int decimals_of(double value) {
  const int magnitude = value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(value))));
  return std::clamp(kDigits - 1 - magnitude, 0, kMostDecimals);
}

std::string decimal(double value, int decimals, bool with_sign) {
  char text[400];  // the largest double has 309 digits
  std::snprintf(text, sizeof text, with_sign ? "%+.*f" : "%.*f", decimals, value);
  return text;
}

/// Are all digits zero?
bool is_nothing(const std::string& text) { return text.find_first_of("123456789") == std::string::npos; }

}  // namespace

std::string significant(double value) {
  if (!std::isfinite(value)) return "-";
  const std::string text = decimal(value, decimals_of(value), false);
  return is_nothing(text) ? "0" : text;
}

std::string with_difference(double value, double baseline, const std::string& separator) {
  if (!std::isfinite(value) || !std::isfinite(baseline)) return significant(value);
  const std::string text = decimal(value - baseline, decimals_of(value), true);
  return significant(value) + separator + "(" + (is_nothing(text) ? "=" : text) + ")";
}

std::string share_text(int part, int whole) {
  if (whole == 0) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%d / %d (%.1f %%)", part, whole, 100.0 * part / whole);
  return text;
}

}  // namespace quadedge::report
