#pragma once
/// \file canvas.hpp  Shared parts of the pictures: enlarged backgrounds, text, legends, PNG output.

#include <opencv2/core.hpp>
#include <string>

#include "quadedge/image.hpp"

namespace quadedge::report {

/// Height of one line of text in a legend [px].
constexpr int kLegendLine = 26;

/// A colour picture of a grey image: enlarged to at least 1000 px width by a whole factor, darkened to `brightness`,
/// with `legend_lines` black lines below it.
class Canvas {
 public:
  Canvas(const ImageView& image, double brightness, int legend_lines);

  cv::Mat& picture() { return picture_; }
  /// Position in the picture of image coordinates, in units of 1/16 px as OpenCV expects with `shift` = 4.
  cv::Point position(double x, double y) const;
  /// Picture pixels per image pixel.
  int scale() const { return scale_; }
  /// Baseline of legend line `line` from 0 on [px].
  int legend_y(int line) const;

 private:
  int scale_;
  int image_height_;  ///< of the enlarged image [px]
  cv::Mat picture_;
};
/// Fractional bits of Canvas::position.
constexpr int kPositionShift = 4;

/// Writes text with its baseline at (x, y); returns the x after its end.
int put_text(cv::Mat& picture, const std::string& text, int x, int y, const cv::Scalar& colour, double size = 0.5);

/// The colour at a share of a turn of the colour wheel, of full saturation, in 180 steps [BGR].
cv::Scalar wheel_colour(double turn);

/// Encodes and writes atomically. \throws DataError.
void write_png(const std::string& path, const cv::Mat& picture);
void write_jpeg(const std::string& path, const cv::Mat& picture);

}  // namespace quadedge::report
