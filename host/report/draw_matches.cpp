#include "report/draw_matches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>

#include "data/find_sequences.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "report/canvas.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

using evaluation::FinalMatch;
using evaluation::MatchClass;

constexpr double kMatchesBrightness = 0.5, kHalfMatch = 0.6;  // px of the image to either side of an edge
constexpr int kMarkerSize = 11;                               // px of the picture
constexpr int kRegions = 3, kRegionDivisor = 6;               // a region has a sixth of the image's width and height
constexpr int kGap = 8;                                       // px of the picture between views

constexpr double kGoldenTurn = 0.618034;  // between the colours of consecutive matches, so that neighbours differ

/// The drawings of a pair: the paper's Figures 8, 9 (a) and 9 (b).
constexpr std::array<std::pair<MatchClass, const char*>, 3> kDrawings = {
    {{MatchClass::correct, "correct stereo edges, each in one colour in both views, and three regions enlarged"},
     {MatchClass::inaccurate, "inaccurate stereo edges and their true positions"},
     {MatchClass::wrong, "wrong stereo edges and their true positions"}}};

/// A match with its number among all of the frame.
struct Numbered {
  std::size_t number;
  const FinalMatch* match;
};

/// Part of an image in a picture: enlarged and darkened, at `place`.
class View {
 public:
  View(const Image& image, const cv::Rect& part, cv::Mat& picture, const cv::Rect& place)
      : part_(part), scale_(static_cast<double>(place.width) / part.width), target_(picture(place)) {
    Image pixels = to_8_bits(image.view());
    const cv::Mat grey(image.height, image.width, CV_8U, pixels.pixels.data());
    cv::Mat large;
    cv::resize(grey(part), large, place.size(), 0, 0, cv::INTER_LINEAR);
    large.convertTo(large, CV_8U, kMatchesBrightness);
    cv::cvtColor(large, target_, cv::COLOR_GRAY2BGR);
  }
  void stroke(double x, double y, double direction, const cv::Scalar& colour) {
    const double dx = kHalfMatch * std::cos(direction), dy = kHalfMatch * std::sin(direction);
    cv::line(target_, position(x - dx, y - dy), position(x + dx, y + dy), colour, scale_ > 6 ? 2 : 1, cv::LINE_AA,
             kPositionShift);
  }
  void marker(double x, double y, const cv::Scalar& colour, int shape) {
    cv::drawMarker(target_, position(x, y) / (1 << kPositionShift), colour, shape, kMarkerSize, 2, cv::LINE_AA);
  }
  void link(double x, double y, double true_x, double true_y, const cv::Scalar& colour) {
    cv::line(target_, position(x, y), position(true_x, true_y), colour, 1, cv::LINE_AA, kPositionShift);
    cv::circle(target_, position(true_x, true_y), 3 << kPositionShift, colour, 1, cv::LINE_AA, kPositionShift);
  }

 private:
  cv::Point position(double x, double y) const {
    const auto fixed = [this](double value, int start) {
      return static_cast<int>(std::lround(((value - start + 0.5) * scale_ - 0.5) * (1 << kPositionShift)));
    };
    return {fixed(x, part_.x), fixed(y, part_.y)};
  }

  cv::Rect part_;
  double scale_;
  cv::Mat target_;
};

cv::Rect whole(const Image& image) { return {0, 0, image.width, image.height}; }

bool contains(const cv::Rect& region, double x, double y) {
  return region.contains(cv::Point(static_cast<int>(x), static_cast<int>(y)));
}

/// The regions of the left image with the most matches, apart from one another.
std::vector<cv::Rect> busiest_regions(const std::vector<Numbered>& matches, const Image& left) {
  const int width = std::max(1, left.width / kRegionDivisor), height = std::max(1, left.height / kRegionDivisor);
  std::vector<std::pair<std::ptrdiff_t, cv::Rect>> counted;
  for (int y = 0; y + height <= left.height; y += std::max(1, height / 2)) {
    for (int x = 0; x + width <= left.width; x += std::max(1, width / 2)) {
      const cv::Rect region(x, y, width, height);
      counted.emplace_back(std::count_if(matches.begin(), matches.end(),
                                         [&](const Numbered& match) {
                                           return contains(region, match.match->left_x, match.match->left_y);
                                         }),
                           region);
    }
  }
  std::stable_sort(counted.begin(), counted.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<cv::Rect> chosen;
  for (const auto& [inside, region] : counted) {
    const bool is_apart = std::none_of(chosen.begin(), chosen.end(),
                                       [&, r = region](const cv::Rect& other) { return (other & r).area() > 0; });
    if (inside > 0 && is_apart && chosen.size() < kRegions) chosen.push_back(region);
  }
  return chosen;
}

/// Where the matches of a region lead to in the right image: the region moved by their median.
cv::Rect right_region(const cv::Rect& region, const std::vector<Numbered>& matches, const Image& right) {
  std::vector<double> dx, dy;
  for (const Numbered& match : matches) {
    const FinalMatch& m = *match.match;
    if (!contains(region, m.left_x, m.left_y)) continue;
    dx.push_back(m.right_x - m.left_x);
    dy.push_back(m.right_y - m.left_y);
  }
  const cv::Size size(std::min(region.width, right.width), std::min(region.height, right.height));
  return {cv::Point(std::clamp(region.x + static_cast<int>(std::lround(median(dx))), 0, right.width - size.width),
                    std::clamp(region.y + static_cast<int>(std::lround(median(dy))), 0, right.height - size.height)),
          size};
}

std::string limit(double px) { return data::format_fixed(px, px == std::round(px) ? 0 : 2) + " px"; }

/// What the matches of a class are, with its limits.
std::string described(MatchClass kind, const evaluation::MatchingTolerance& tolerance) {
  const std::string near = limit(tolerance.position), far = limit(tolerance.wrong);
  if (kind == MatchClass::correct) return "within " + near + " of their true positions";
  if (kind == MatchClass::inaccurate) return near + " to " + far + " from their true positions (rings)";
  return "more than " + far + " from their true positions (rings), or not visible in the right view (squares)";
}

void draw_match(const Numbered& match, View& left, View& right) {
  const FinalMatch& m = *match.match;
  const cv::Scalar colour = wheel_colour(kGoldenTurn * static_cast<double>(match.number));
  if (m.kind == MatchClass::correct) {
    left.stroke(m.left_x, m.left_y, m.left_direction, colour);
    right.stroke(m.right_x, m.right_y, m.right_direction, colour);
    return;
  }
  const int shape = m.kind == MatchClass::inaccurate ? cv::MARKER_TRIANGLE_UP
                    : m.kind == MatchClass::wrong    ? cv::MARKER_TILTED_CROSS
                                                     : cv::MARKER_SQUARE;
  left.marker(m.left_x, m.left_y, colour, shape);
  right.marker(m.right_x, m.right_y, colour, shape);
  if (std::isfinite(m.true_x)) right.link(m.right_x, m.right_y, m.true_x, m.true_y, colour);
}

}  // namespace

void draw_matches(const std::string& path, const evaluation::DrawnFrame& frame, const std::string& name,
                  const evaluation::MatchingTolerance& tolerance, MatchClass kind) {
  std::vector<Numbered> matches;
  for (std::size_t i = 0; i < frame.matches.size(); ++i) {
    const MatchClass found = frame.matches[i].kind;
    if (found == kind || (kind == MatchClass::wrong && found == MatchClass::occluded))
      matches.push_back({i, &frame.matches[i]});
  }
  const int scale = Canvas(frame.left.view(), 1, 0).scale();
  const cv::Size left(frame.left.width * scale, frame.left.height * scale);
  const cv::Size right(frame.right.width * scale, frame.right.height * scale);
  const std::vector<cv::Rect> zoomed =
      kind == MatchClass::correct ? busiest_regions(matches, frame.left) : std::vector<cv::Rect>();
  const int width = left.width + right.width, height = std::max(left.height, right.height);
  const int tile = (width - (kRegions - 1) * kGap) / (2 * kRegions);  // width of one view of a region
  int tile_height = 0;
  for (const cv::Rect& region : zoomed) tile_height = std::max(tile_height, tile * region.height / region.width);
  const int legend = height + (zoomed.empty() ? 0 : tile_height + kGap);
  cv::Mat picture = cv::Mat::zeros(legend + kLegendLine + 8, width, CV_8UC3);

  View whole_left(frame.left, whole(frame.left), picture, {{0, 0}, left});
  View whole_right(frame.right, whole(frame.right), picture, {{left.width, 0}, right});
  for (const Numbered& match : matches) draw_match(match, whole_left, whole_right);
  int x = 0;
  for (const cv::Rect& region : zoomed) {
    const cv::Size size(tile, tile * region.height / region.width);
    const cv::Rect moved = right_region(region, matches, frame.right);
    View near_left(frame.left, region, picture, {{x, height + kGap}, size});
    View near_right(frame.right, moved, picture, {{x + tile, height + kGap}, size});
    for (const Numbered& match : matches) {
      if (contains(region, match.match->left_x, match.match->left_y)) draw_match(match, near_left, near_right);
    }
    for (const auto& [view, part] : {std::pair(cv::Point(0, 0), region), std::pair(cv::Point(left.width, 0), moved)}) {
      cv::rectangle(picture, cv::Rect(view + part.tl() * scale, part.size() * scale), {255, 255, 255}, 1);
    }
    x += 2 * tile + kGap;
  }
  put_text(picture,
           name + ", frame " + std::to_string(frame.number) + ": " + std::to_string(matches.size()) + " stereo edges " +
               described(kind, tolerance),
           8, legend + kLegendLine - 6, {255, 255, 255});
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
    for (const auto& [kind, caption] : kDrawings) {
      const std::string suffix = evaluation::kMatchClassNames[static_cast<std::size_t>(kind)];
      const std::string file = (std::filesystem::absolute(folder) / (name + "_" + suffix + ".png")).string();
      draw_matches(file, *result.drawn, result.name, tolerance, kind);
      written.push_back({result.name, file, result.name + ": " + caption});
    }
  }
  return written;
}

}  // namespace quadedge::report
