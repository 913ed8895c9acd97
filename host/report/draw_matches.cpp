#include "report/draw_matches.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>

#include "data/find_sequences.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/canvas.hpp"

namespace quadedge::report {
namespace {

using evaluation::FinalMatch;
using evaluation::MatchClass;

constexpr double kMatchesBrightness = 0.5, kHalfMatch = 0.6;  // px of the image to either side of an edge
constexpr int kMarkerSize = 11;                               // px of the picture
constexpr int kStroke = -1;
/// Colour and shape of every class, in the order of MatchClass: blue, orange, magenta and white, which colour-blind
/// readers can tell apart. Correct matches are too many for anything but strokes.
struct ClassMark {
  cv::Scalar colour;  ///< BGR
  int marker;         ///< of cv::drawMarker; kStroke: along the edge
};
const std::array<ClassMark, evaluation::kMatchClassNames.size()> kClassMarks = {
    {{{255, 160, 60}, kStroke},
     {{0, 159, 255}, cv::MARKER_TRIANGLE_UP},
     {{220, 60, 255}, cv::MARKER_TILTED_CROSS},
     {{255, 255, 255}, cv::MARKER_SQUARE}}};

void draw_edge(Canvas& canvas, double x, double y, double direction, const ClassMark& mark) {
  const double dx = kHalfMatch * std::cos(direction), dy = kHalfMatch * std::sin(direction);
  if (mark.marker == kStroke) {
    cv::line(canvas.picture(), canvas.position(x - dx, y - dy), canvas.position(x + dx, y + dy), mark.colour, 1,
             cv::LINE_AA, kPositionShift);
  } else {
    cv::drawMarker(canvas.picture(), canvas.position(x, y) / (1 << kPositionShift), mark.colour, mark.marker,
                   kMarkerSize, 2, cv::LINE_AA);
  }
}

void draw_match(const FinalMatch& match, const ClassMark& mark, Canvas& left, Canvas& right) {
  draw_edge(left, match.left_x, match.left_y, match.left_direction, mark);
  draw_edge(right, match.right_x, match.right_y, match.right_direction, mark);
  if (match.kind == MatchClass::correct || !std::isfinite(match.true_x)) return;
  const cv::Point truth = right.position(match.true_x, match.true_y);
  cv::line(right.picture(), right.position(match.right_x, match.right_y), truth, mark.colour, 1, cv::LINE_AA,
           kPositionShift);
  cv::circle(right.picture(), truth, 3 << kPositionShift, mark.colour, 1, cv::LINE_AA, kPositionShift);
}

std::string limit(double px) { return data::format_fixed(px, px == std::round(px) ? 0 : 2) + " px"; }

}  // namespace

void draw_matches(const std::string& path, const evaluation::DrawnFrame& frame, const std::string& name,
                  const evaluation::MatchingTolerance& tolerance) {
  Canvas left(frame.left.view(), kMatchesBrightness, 2), right(frame.right.view(), kMatchesBrightness, 2);
  const std::array<std::string, kClassMarks.size()> limits = {" (within " + limit(tolerance.position) + ")",
                                                              " (up to " + limit(tolerance.wrong) + ")", " (beyond)",
                                                              " in the right view"};
  put_text(left.picture(), name + ": stereo edges of known truth (frame " + std::to_string(frame.number) + ")", 8,
           left.legend_y(0), {255, 255, 255});
  int x = 8;
  for (std::size_t kind = 0; kind < kClassMarks.size(); ++kind) {  // the rare classes on top
    const ClassMark& mark = kClassMarks[kind];
    int count = 0;
    for (const FinalMatch& match : frame.matches) {
      if (static_cast<std::size_t>(match.kind) != kind) continue;
      draw_match(match, mark, left, right);
      ++count;
    }
    const int y = left.legend_y(1);
    if (mark.marker == kStroke) {
      cv::line(left.picture(), {x, y - 5}, {x + 22, y - 5}, mark.colour, 3);
    } else {
      cv::drawMarker(left.picture(), {x + 11, y - 5}, mark.colour, mark.marker, kMarkerSize, 2, cv::LINE_AA);
    }
    const std::string text = std::to_string(count) + " " + evaluation::kMatchClassNames[kind] + limits[kind];
    x = put_text(left.picture(), text, x + 28, y, {255, 255, 255}) + 22;
  }
  cv::Mat picture = cv::Mat::zeros(std::max(left.picture().rows, right.picture().rows),
                                   left.picture().cols + right.picture().cols, CV_8UC3);
  left.picture().copyTo(picture(cv::Rect({}, left.picture().size())));
  right.picture().copyTo(picture(cv::Rect({left.picture().cols, 0}, right.picture().size())));
  write_png(path, picture);
}

std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance) {
  std::vector<WrittenDrawing> written;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw DataError(folder + ": the folder cannot be made: " + error.message());
  std::map<std::string, int> used;
  for (const auto& result : results) {
    if (!result.drawn) continue;
    std::string name = data::plain_name(result.name);
    if (const int number = ++used[name]; number > 1) name += "_" + std::to_string(number);
    const std::string file = (std::filesystem::absolute(folder) / (name + ".png")).string();
    draw_matches(file, *result.drawn, result.name, tolerance);
    written.push_back({result.name, file, result.name + ": all stereo edges of known truth, by class."});
  }
  return written;
}

}  // namespace quadedge::report
