#include "report/svg.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace quadedge::report::svg {

std::string escape(const std::string& text) {
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&': result += "&amp;"; break;
      case '<': result += "&lt;"; break;
      case '>': result += "&gt;"; break;
      case '"': result += "&quot;"; break;
      case '\'': result += "&#39;"; break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\n' || c == '\t') result += c;
    }
  }
  return result;
}

std::string number(double value) {
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.2f", value);
  std::string result = digits;
  result.erase(result.find_last_not_of('0') + 1);
  if (result.back() == '.') result.pop_back();
  return result == "-0" ? "0" : result;
}

double text_width(const std::string& text, double font_size) {
  double characters = 0;
  for (const char c : text) {
    if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) ++characters;  // continuation bytes of UTF-8 are no characters
  }
  return 0.53 * font_size * characters;
}

std::string text(double x, double y, const std::string& content, Anchor anchor, const std::string& attributes) {
  constexpr const char* kNames[] = {"start", "middle", "end"};
  return "<text x=\"" + number(x) + "\" y=\"" + number(y) + "\" text-anchor=\"" + kNames[static_cast<int>(anchor)] +
         "\"" + (attributes.empty() ? "" : " " + attributes) + ">" + escape(content) + "</text>";
}

std::string line(double x1, double y1, double x2, double y2, const std::string& attributes) {
  return "<line x1=\"" + number(x1) + "\" y1=\"" + number(y1) + "\" x2=\"" + number(x2) + "\" y2=\"" + number(y2) +
         "\" " + attributes + "/>";
}

std::string open(int width, int height, const std::string& title) {
  const std::string w = std::to_string(width), h = std::to_string(height);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + w + "\" height=\"" + h + "\" viewBox=\"0 0 " + w + " " +
         h +
         "\" role=\"img\" font-family=\"sans-serif\" font-size=\"11\" fill=\"#333\" "
         "style=\"max-width:100%;height:auto\"><title>" +
         escape(title) + "</title>";
}

const std::string& series_colour(std::size_t index) {
  static const std::array<std::string, 7> colours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                     "#e69f00", "#56b4e9", "#555555"};
  return colours[index % colours.size()];
}

}  // namespace quadedge::report::svg
