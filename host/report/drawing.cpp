#include "report/drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>

#include "data/atomic_file.hpp"
#include "data/find_sequences.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"
#include "report/canvas.hpp"
#include "report/statistics.hpp"

namespace quadedge::report {
namespace {

constexpr double kEdgesBrightness = 0.35;
constexpr double kHalfStroke = 0.6;  // px of the image to either side of the edge

cv::Scalar direction_colour(double direction) { return wheel_colour(direction / (2 * kPi)); }

constexpr double kQuadsBrightness = 0.45;
constexpr int kThumbnailWidth = 480;  // px
constexpr int kCell = 16;             // px of the image; one motion is drawn per cell
const cv::Scalar kText(255, 255, 255), kInlier(255, 255, 255), kOutlier(60, 60, 255);

constexpr int kLevels = 256;  // colours of a disparity

/// Matplotlib's viridis, which colour-blind readers can read as well, from 0 to the largest disparity.
class DisparityColours {
 public:
  /// The scale for these disparities [px]; a few wrong matches do not stretch it.
  explicit DisparityColours(const std::vector<double>& disparities)
      : largest_(disparities.empty() ? 1.0 : std::max(percentile(disparities, 0.98), 1e-3)) {
    cv::Mat levels(1, kLevels, CV_8UC1), bgr;
    for (int i = 0; i < kLevels; ++i) levels.at<unsigned char>(0, i) = static_cast<unsigned char>(i);
    cv::applyColorMap(levels, bgr, cv::COLORMAP_VIRIDIS);
    for (int i = 0; i < kLevels; ++i) colours_.emplace_back(bgr.at<cv::Vec3b>(0, i));
  }

  cv::Scalar of(double disparity) const {
    return colours_[static_cast<std::size_t>(std::clamp(disparity / largest_, 0.0, 1.0) * (kLevels - 1))];
  }
  /// Writes the legend at a position: what is coloured, the scale as a bar, and how many.
  void draw_legend(cv::Mat& picture, int y, std::size_t count) const {
    int x = put_text(picture, "stereo edges by disparity: 0", 10, y, kText) + 6;
    for (const auto& colour : colours_) {
      cv::line(picture, {x, y - 12}, {x, y + 2}, colour);
      ++x;
    }
    put_text(picture, data::format_fixed(largest_, 1) + " px   (" + std::to_string(count) + " stereo edges)", x + 6, y,
             kText);
  }

 private:
  std::vector<cv::Scalar> colours_;
  double largest_;
};

/// Length of the way between the two positions of a stereo edge, which is the disparity for a rectified rig [px].
double disparity(const StereoEdges& stereo, std::size_t i) {
  return std::hypot(stereo.left_x[i] - stereo.right_x[i], stereo.left_y[i] - stereo.right_y[i]);
}

/// The first quad of every cell of the image: all of them would cover the picture, and this keeps the ratio of the
/// kinds.
std::vector<std::size_t> one_per_cell(const TemporalMatches& quads) {
  std::set<std::pair<int, int>> taken;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < quads.size(); ++i) {
    const std::pair<int, int> cell(static_cast<int>(quads.left_x[i]) / kCell,
                                   static_cast<int>(quads.left_y[i]) / kCell);
    if (taken.insert(cell).second) chosen.push_back(i);
  }
  return chosen;
}

/// The colours of stereo edges.
DisparityColours colours_of(const StereoEdges& stereo) {
  std::vector<double> disparities;
  for (std::size_t i = 0; i < stereo.size(); ++i) disparities.push_back(disparity(stereo, i));
  return DisparityColours(disparities);
}

void paint(Canvas& canvas, const StereoEdges& stereo, const DisparityColours& colours, int radius) {
  for (std::size_t i = 0; i < stereo.size(); ++i) {
    cv::circle(canvas.picture(), canvas.position(stereo.left_x[i], stereo.left_y[i]), radius << kPositionShift,
               colours.of(disparity(stereo, i)), cv::FILLED, cv::LINE_AA, kPositionShift);
  }
}

/// Stereo edges and quads into the image part of the canvas.
void paint(Canvas& canvas, const FrameDetails& details, const DisparityColours& colours) {
  paint(canvas, details.stereo, colours, std::max(1, canvas.scale() / 2));
  for (const std::size_t i : one_per_cell(details.quads)) {
    const auto previous = static_cast<std::size_t>(details.quads.previous[i]);
    const cv::Scalar& colour = details.quad_inlier.at(i) != 0 ? kInlier : kOutlier;
    const cv::Point start =
        canvas.position(details.previous_stereo.left_x.at(previous), details.previous_stereo.left_y.at(previous));
    const cv::Point end = canvas.position(details.quads.left_x[i], details.quads.left_y[i]);
    cv::line(canvas.picture(), start, end, colour, 1, cv::LINE_AA, kPositionShift);
    cv::circle(canvas.picture(), end, 5 << (kPositionShift - 1), colour, cv::FILLED, cv::LINE_AA, kPositionShift);
  }
}

}  // namespace

void draw_edges(const std::string& path, const ImageView& image, const EdgeSet& edges) {
  Canvas canvas(image, kEdgesBrightness, 2);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const double dx = kHalfStroke * std::cos(edges.direction[i]), dy = kHalfStroke * std::sin(edges.direction[i]);
    cv::line(canvas.picture(), canvas.position(edges.x[i] - dx, edges.y[i] - dy),
             canvas.position(edges.x[i] + dx, edges.y[i] + dy), direction_colour(edges.direction[i]), 1, cv::LINE_AA,
             kPositionShift);
  }
  const cv::Scalar white(255, 255, 255);
  put_text(canvas.picture(),
           std::to_string(edges.size()) +
               " third-order edges, coloured by direction, "
               "which has the bright side on its right",
           10, canvas.legend_y(0), white);
  const int y = canvas.legend_y(1);
  int x = put_text(canvas.picture(), "-180 deg", 10, y, white) + 8;
  for (int i = 0; i < 360; ++i, ++x) {
    cv::line(canvas.picture(), {x, y - 12}, {x, y + 2}, direction_colour((i - 180) * kPi / 180));
  }
  put_text(canvas.picture(), "+180 deg   (0: to the right, 90: down)", x + 8, y, white);
  write_png(path, canvas.picture());
}

void draw_stereo(const std::string& path, const ImageView& left, const StereoEdges& edges) {
  Canvas canvas(left, kEdgesBrightness, 1);
  const DisparityColours colours = colours_of(edges);
  paint(canvas, edges, colours, 1);
  colours.draw_legend(canvas.picture(), canvas.legend_y(0), edges.size());
  write_png(path, canvas.picture());
}

void draw_pair(const std::string& path, const ImageView& left, const ImageView& right) {
  cv::Mat views[2];
  for (const auto& [image, view] : {std::pair(&left, &views[0]), std::pair(&right, &views[1])}) {
    Image pixels = to_8_bits(*image);
    const int height = std::max(1, kThumbnailWidth * image->height / image->width);
    cv::resize(cv::Mat(pixels.height, pixels.width, CV_8U, pixels.pixels.data()), *view, {kThumbnailWidth, height}, 0,
               0, cv::INTER_AREA);
  }
  cv::Mat pair = cv::Mat::zeros(std::max(views[0].rows, views[1].rows), 2 * kThumbnailWidth, CV_8U);
  views[0].copyTo(pair(cv::Rect({}, views[0].size())));
  views[1].copyTo(pair(cv::Rect({kThumbnailWidth, 0}, views[1].size())));
  write_jpeg(path, pair);
}

void draw_quads_thumbnail(const std::string& path, const ImageView& left, const FrameDetails& details) {
  Canvas canvas(left, kQuadsBrightness, 0);
  paint(canvas, details, colours_of(details.stereo));
  const cv::Mat image = canvas.picture()(cv::Rect(0, 0, left.width * canvas.scale(), left.height * canvas.scale()));
  const double reduction = static_cast<double>(kThumbnailWidth) / image.cols;
  cv::Mat small;
  cv::resize(image, small, {kThumbnailWidth, std::max(1, static_cast<int>(std::lround(image.rows * reduction)))}, 0, 0,
             cv::INTER_AREA);
  write_jpeg(path, small);
}

void draw_quads(const std::string& path, const ImageView& left, const FrameDetails& details) {
  Canvas canvas(left, kQuadsBrightness, 2);
  const DisparityColours colours = colours_of(details.stereo);
  paint(canvas, details, colours);
  const auto inliers =
      std::count_if(details.quad_inlier.begin(), details.quad_inlier.end(), [](auto flag) { return flag != 0; });

  cv::Mat& picture = canvas.picture();
  colours.draw_legend(picture, canvas.legend_y(0), details.stereo.size());
  const int y = canvas.legend_y(1);
  int x = put_text(picture, "motion of quads since the key rig, one per cell of 16 px (dot: now):", 10, y, kText) + 10;
  cv::line(picture, {x, y - 5}, {x + 30, y - 5}, kInlier, 2);
  x = put_text(picture, std::to_string(inliers) + " inliers", x + 38, y, kInlier) + 16;
  cv::line(picture, {x, y - 5}, {x + 30, y - 5}, kOutlier, 2);
  put_text(picture, std::to_string(static_cast<std::ptrdiff_t>(details.quads.size()) - inliers) + " others", x + 38, y,
           kOutlier);
  write_png(path, picture);
}

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
  data::make_folder(folder);
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
