/// \file drawing.cpp  Strokes coloured by direction, dots by disparity (viridis), motion of one quad per cell. Enlarges
/// by whole factors; positions in fixed point, so that OpenCV draws between pixels.
#include "output/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/image_file.hpp"
#include "data/text.hpp"
#include "output/statistics.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::report {
namespace {

/// Height of one line of text in a legend [px].
constexpr int kLegendLine = 26;
constexpr int kPositionShift = 4;     ///< fractional bits of Canvas::position
constexpr int kSmallestWidth = 1000;  // px; narrower images are enlarged so that strokes can be distinguished
constexpr int kLargestScale = 4;

int scale_for(int width) {
  int scale = 1;
  while (scale < kLargestScale && width * scale < kSmallestWidth) ++scale;
  return scale;
}

/// A colour picture of a grey image: enlarged to at least 1000 px width by a whole factor, darkened to `brightness`,
/// with `legend_lines` black lines below it.
class Canvas {
 public:
  Canvas(const ImageView& image, double brightness, int legend_lines)
      : scale_(scale_for(image.width)), image_height_(image.height * scale_) {
    const Image grey = to_8_bits(image);
    cv::Mat large;
    cv::resize(data::matrix_of(grey), large, {}, scale_, scale_, cv::INTER_LINEAR);
    large.convertTo(large, CV_8UC1, brightness);
    picture_ =
        cv::Mat::zeros(large.rows + legend_lines * kLegendLine + 8, std::max(large.cols, kSmallestWidth), CV_8UC3);
    cv::Mat target = picture_(cv::Rect(0, 0, large.cols, large.rows));
    cv::cvtColor(large, target, cv::COLOR_GRAY2BGR);
  }

  cv::Mat& picture() { return picture_; }
  /// Position in the picture of image coordinates, in units of 1/16 px as OpenCV expects with `shift` = 4.
  cv::Point position(double x, double y) const {
    // Pixel centres are whole numbers on both sides of the enlargement.
    const auto fixed_point = [this](double value) {
      return static_cast<int>(std::lround(((value + 0.5) * scale_ - 0.5) * (1 << kPositionShift)));
    };
    return {fixed_point(x), fixed_point(y)};
  }
  /// Picture pixels per image pixel.
  int scale() const { return scale_; }
  /// Baseline of legend line `line` from 0 on [px].
  int legend_y(int line) const { return image_height_ + (line + 1) * kLegendLine - 6; }

 private:
  int scale_;
  int image_height_;  ///< of the enlarged image [px]
  cv::Mat picture_;
};

/// Writes text with its baseline at (x, y); returns the x after its end.
int put_text(cv::Mat& picture, const std::string& text, int x, int y, const cv::Scalar& colour) {
  constexpr double kSize = 0.5;
  cv::putText(picture, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, kSize, colour, 1, cv::LINE_AA);
  int baseline = 0;
  return x + cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kSize, 1, &baseline).width;
}

/// The colour of a direction [rad] on the colour wheel, of full saturation, in 180 steps [BGR].
cv::Scalar direction_colour(double direction) {
  static const std::vector<cv::Scalar> wheel = [] {
    cv::Mat hsv(1, 180, CV_8UC3), bgr;
    for (int i = 0; i < 180; ++i) hsv.at<cv::Vec3b>(0, i) = {static_cast<unsigned char>(i), 220, 255};
    cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
    std::vector<cv::Scalar> colours;
    for (int i = 0; i < 180; ++i) colours.emplace_back(bgr.at<cv::Vec3b>(0, i));
    return colours;
  }();
  const double turn = direction / (2 * kPi);
  return wheel[static_cast<std::size_t>(std::min(static_cast<int>((turn - std::floor(turn)) * 180.0), 179))];
}

void write_png(const std::string& path, const cv::Mat& picture) {
  data::write_atomically(path, data::encode_png(picture));
}

void write_jpeg(const std::string& path, const cv::Mat& picture) {
  constexpr int kQuality = 75;
  data::write_atomically(path, data::encode_jpeg(picture, kQuality));
}

constexpr double kEdgesBrightness = 0.35;
constexpr double kHalfStroke = 0.6;  // px of the image to either side of the edge

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
           std::to_string(edges.size()) + " third-order edges, coloured by direction (the bright side is on the right)",
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
    const Image pixels = to_8_bits(*image);
    const int height = std::max(1, kThumbnailWidth * image->height / image->width);
    cv::resize(data::matrix_of(pixels), *view, {kThumbnailWidth, height}, 0, 0, cv::INTER_AREA);
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
  int x = put_text(picture, "motion of quads since the keyframe, one per cell of 16 px (dot: now):", 10, y, kText) + 10;
  cv::line(picture, {x, y - 5}, {x + 30, y - 5}, kInlier, 2);
  x = put_text(picture, std::to_string(inliers) + " inliers", x + 38, y, kInlier) + 16;
  cv::line(picture, {x, y - 5}, {x + 30, y - 5}, kOutlier, 2);
  put_text(picture, std::to_string(static_cast<std::ptrdiff_t>(details.quads.size()) - inliers) + " others", x + 38, y,
           kOutlier);
  write_png(path, picture);
}

}  // namespace quadedge::report
