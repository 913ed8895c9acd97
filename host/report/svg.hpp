#pragma once
/// \file svg.hpp  Words of an SVG picture: escaped text, numbers, elements.

#include <string>

namespace quadedge::report::svg {

/// Text with the five characters that XML reserves written as entities, and control characters left out.
std::string escape(const std::string& text);

/// At most two decimals, without trailing zeros: positions in a picture [px].
std::string number(double value);

/// About how wide a text is drawn [px]; the font is the reader's, so only layout with some air may rely on it.
double text_width(const std::string& text, double font_size);

enum class Anchor { start, middle, end };

/// A text element with its baseline at (x, y). `attributes` go into the element as they are.
std::string text(double x, double y, const std::string& content, Anchor anchor, const std::string& attributes = "");

/// A straight line.
std::string line(double x1, double y1, double x2, double y2, const std::string& attributes);

/// The opening tag of a picture that never grows beyond its width and shrinks with the page; `title` is what screen
/// readers say.
std::string open(int width, int height, const std::string& title);

/// Colours of series in their order, told apart by the colour-blind too (Okabe and Ito).
const std::string& series_colour(std::size_t index);

}  // namespace quadedge::report::svg
