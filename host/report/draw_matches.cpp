#include "report/draw_matches.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "quadedge/error.hpp"
#include "report/canvas.hpp"
#include "report/disparity_colours.hpp"
#include "report/match_view.hpp"

namespace quadedge::report {
namespace {

using evaluation::DrawnFrame;
using evaluation::FinalMatch;
using evaluation::MatchClass;

const cv::Scalar kWhite(255, 255, 255), kFrame(255, 255, 255);
/// Colour and shape of every class, in the order of MatchClass: blue, orange, magenta and white, which colour-blind
/// readers can tell apart. Correct matches are too many for anything but strokes.
struct ClassMark {
  cv::Scalar colour;  ///< BGR
  int marker;         ///< of cv::drawMarker; kStroke: along the edge
};
constexpr int kStroke = -1;
const ClassMark kClassMarks[] = {{{255, 160, 60}, kStroke},
                                 {{0, 159, 255}, cv::MARKER_TRIANGLE_UP},
                                 {{220, 60, 255}, cv::MARKER_TILTED_CROSS},
                                 {{255, 255, 255}, cv::MARKER_SQUARE}};

std::string limit(double px) { return fixed(px, px == std::round(px) ? 0 : 2) + " px"; }

std::string meaning(MatchClass kind, double tolerance, double wrong) {
  switch (kind) {
    case MatchClass::correct: return "within " + limit(tolerance) + " of the true position";
    case MatchClass::inaccurate: return limit(tolerance) + " to " + limit(wrong) + " from the true position";
    case MatchClass::wrong: return "more than " + limit(wrong) + " from the true position";
    case MatchClass::occluded: return "matched although the edge is occluded in the right view";
  }
  return {};
}

/// A distinct colour for every correspondence: hues a golden section of the circle apart.
cv::Scalar own_colour(std::size_t index) {
  const double turn = static_cast<double>(index) * 0.6180339887498949;
  const double hue = 6 * (turn - std::floor(turn));
  const auto channel = [&](double shift) {
    const double k = std::fmod(shift + hue, 6.0);
    return 255 * (1 - 0.85 * std::max(0.0, std::min({k, 4 - k, 1.0})));
  };
  return {channel(1), channel(3), channel(5)};
}

/// The strokes of the chosen matches in both views of a picture.
struct Strokes {
  std::vector<std::size_t> chosen;  ///< indices into the frame's matches
  std::vector<cv::Scalar> colours;  ///< one per chosen match
  std::vector<int> markers;         ///< one per chosen match; empty: strokes
  bool with_truth = false;          ///< link the true position
  bool by_class = false;            ///< neighbours have one colour, so that thin strokes do
  double half_length = 0.6;         ///< px of the image
  int dot = 0;                      ///< radius of a dot in both views [px of the picture]; 0: none
};

void draw_strokes(const DrawnFrame& frame, const Strokes& strokes, MatchView& left, MatchView& right) {
  for (std::size_t n = 0; n < strokes.chosen.size(); ++n) {
    const FinalMatch& match = frame.matches[strokes.chosen[n]];
    const cv::Scalar& colour = strokes.colours[n];
    if (strokes.with_truth && match.kind != MatchClass::correct && std::isfinite(match.true_x)) {
      right.link(match.right_x, match.right_y, match.true_x, match.true_y, colour);
    }
    if (!strokes.markers.empty() && strokes.markers[n] != kStroke) {
      left.mark(match.left_x, match.left_y, strokes.markers[n], colour);
      right.mark(match.right_x, match.right_y, strokes.markers[n], colour);
      continue;
    }
    left.stroke(match.left_x, match.left_y, match.left_direction, strokes.half_length, strokes.dot, colour);
    right.stroke(match.right_x, match.right_y, match.right_direction, strokes.half_length, strokes.dot, colour);
  }
}

/// The whole pair above, the details below.
cv::Mat compose(const DrawnFrame& frame, Strokes strokes, const std::vector<std::string>& lines) {
  const PairLayout layout(frame.left.width, frame.left.height, frame.right.width, frame.right.height,
                          static_cast<int>(lines.size()));
  const auto regions = layout.choose_regions(frame, strokes.chosen);
  cv::Mat picture = layout.blank(!regions.empty());
  for (std::size_t i = 0; i < lines.size(); ++i)
    put_text(picture, lines[i], 8, kLegendLine * static_cast<int>(i + 1) - 8, kWhite);
  // A few matches would be overlooked as strokes.
  const std::size_t count = strokes.chosen.size();
  strokes.dot = strokes.by_class || count > 20000 ? 0 : count > 2000 ? 1 : count > 300 ? 2 : 3;
  MatchView left = layout.whole(picture, frame.left, Side::left),
            right = layout.whole(picture, frame.right, Side::right);
  draw_strokes(frame, strokes, left, right);
  strokes.dot = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::string number = std::to_string(r + 1);
    left.frame(regions[r].left, number, kFrame);
    right.frame(regions[r].right, number, kFrame);
    MatchView detail_left = layout.detail(picture, frame.left, regions[r].left, r, Side::left);
    MatchView detail_right = layout.detail(picture, frame.right, regions[r].right, r, Side::right);
    draw_strokes(frame, strokes, detail_left, detail_right);
    detail_left.label(number, kFrame);
  }
  return picture;
}

}  // namespace

cv::Mat draw_match_class(const DrawnFrame& frame, MatchClass kind, const std::string& name, double tolerance,
                         double wrong) {
  Strokes strokes;
  strokes.with_truth = kind != MatchClass::correct;
  std::vector<double> disparities;
  for (std::size_t i = 0; i < frame.matches.size(); ++i) {
    const FinalMatch& match = frame.matches[i];
    if (match.kind != kind) continue;
    strokes.chosen.push_back(i);
    disparities.push_back(std::hypot(match.left_x - match.right_x, match.left_y - match.right_y));
  }
  const DisparityColours scale(disparities);
  for (std::size_t n = 0; n < disparities.size(); ++n)
    strokes.colours.push_back(strokes.with_truth ? own_colour(n) : scale.of(disparities[n]));
  const std::string what = name + ": " + std::to_string(strokes.chosen.size()) + " " +
                           evaluation::kMatchClassNames[static_cast<std::size_t>(kind)] + " stereo edges, " +
                           meaning(kind, tolerance, wrong) + " (frame " + std::to_string(frame.number) + ")";
  return compose(
      frame, strokes,
      {what, strokes.with_truth ? "One colour per correspondence in both views; in the right view a line leads "
                                  "from the match to a ring at the true position."
                                : "Coloured by disparity, bright for " + fixed(scale.largest(), 1) +
                                      " px and more, the same in both views."});
}

cv::Mat draw_all_matches(const DrawnFrame& frame, const std::string& name, double tolerance, double wrong) {
  Strokes strokes;
  strokes.by_class = true;
  evaluation::MatchClassCounts counts{};
  // The rare classes on top.
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    for (std::size_t i = 0; i < frame.matches.size(); ++i) {
      if (static_cast<std::size_t>(frame.matches[i].kind) != kind) continue;
      ++counts[kind];
      strokes.chosen.push_back(i);
      strokes.colours.push_back(kClassMarks[kind].colour);
      strokes.markers.push_back(kClassMarks[kind].marker);
    }
  }
  cv::Mat picture = compose(frame, strokes,
                            {name + ": stereo edges of known truth (frame " + std::to_string(frame.number) + ")", ""});
  const std::string limits[] = {" (within " + limit(tolerance) + ")", " (up to " + limit(wrong) + ")", " (beyond)",
                                " in the right view"};
  int x = 8;
  const int y = 2 * kLegendLine - 8;
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    const std::string text = std::to_string(counts[kind]) + " " + evaluation::kMatchClassNames[kind] + limits[kind];
    const auto& [colour, marker] = kClassMarks[kind];
    if (marker == kStroke) {
      cv::line(picture, {x, y - 5}, {x + 22, y - 5}, colour, 3);
    } else {
      cv::drawMarker(picture, {x + 11, y - 5}, colour, marker, kMarkerSize, 2, cv::LINE_AA);
    }
    x = put_text(picture, text, x + 28, y, kWhite) + 22;
  }
  return picture;
}

std::vector<MatchDrawing> draw_matches(const DrawnFrame& frame, const std::string& name, double tolerance,
                                       double wrong) {
  std::vector<MatchDrawing> drawings;
  drawings.push_back({"all.png", name + ": all stereo edges of known truth, coloured by class.",
                      draw_all_matches(frame, name, tolerance, wrong)});
  for (std::size_t k = 0; k < evaluation::kMatchClassNames.size(); ++k) {
    const auto kind = static_cast<MatchClass>(k);
    const auto count = std::count_if(frame.matches.begin(), frame.matches.end(),
                                     [&](const FinalMatch& match) { return match.kind == kind; });
    if (count == 0) continue;
    const std::string what = evaluation::kMatchClassNames[k];
    drawings.push_back({what + ".png",
                        name + ": " + std::to_string(count) + " " + what + ", " + meaning(kind, tolerance, wrong) + ".",
                        draw_match_class(frame, kind, name, tolerance, wrong)});
  }
  return drawings;
}

}  // namespace quadedge::report
