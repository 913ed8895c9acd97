#pragma once
/// \file match_view.hpp  The parts of a drawing of matches: views of image regions, and their place in the
/// picture.

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evaluation/final_match.hpp"
#include "quadedge/image.hpp"
#include "quadedge/side.hpp"

namespace quadedge::report {

constexpr int kMarkerSize = 11;  // px of the picture

/// A region of an image, enlarged and darkened, within a picture. Positions are those of the whole image [px].
class MatchView {
 public:
  /// Draws the part `region` of the image into the rectangle `area` of the picture.
  MatchView(cv::Mat& picture, const cv::Rect& area, const Image& image, const cv::Rect2d& region, double brightness);

  /// An edge: a stroke along its direction [rad], `half_length` px of the image to either side, or a dot of `dot` px
  /// where the view is too small for strokes.
  void stroke(double x, double y, double direction, double half_length, int dot, const cv::Scalar& colour);
  /// A marker of cv::drawMarker, kMarkerSize wide.
  void mark(double x, double y, int marker, const cv::Scalar& colour);
  /// From a match to a ring at its true position.
  void link(double x, double y, double true_x, double true_y, const cv::Scalar& colour);
  /// The outline of a region of the image, with a number beside it.
  void frame(const cv::Rect2d& region, const std::string& number, const cv::Scalar& colour);
  /// Text in the upper left corner.
  void label(const std::string& text, const cv::Scalar& colour);

 private:
  cv::Point position(double x, double y) const;  ///< units of 1/16 px of the view
  cv::Mat view_;
  cv::Rect2d region_;
  double scale_;
};

/// Places of the two images of a pair and of the details below them.
class PairLayout {
 public:
  PairLayout(int left_width, int left_height, int right_width, int right_height, int text_lines);

  /// A part of the left image and the part of the right one that shows the same.
  struct Region {
    cv::Rect2d left, right;
  };
  /// The regions (at most three, apart from one another) that hold most of the chosen matches.
  std::vector<Region> choose_regions(const evaluation::DrawnFrame& frame, const std::vector<std::size_t>& chosen) const;
  cv::Mat blank(bool with_details) const;
  MatchView whole(cv::Mat& picture, const Image& image, Side side) const;
  MatchView detail(cv::Mat& picture, const Image& image, const cv::Rect2d& region, std::size_t number, Side side) const;

 private:
  int left_width_, left_height_, right_width_, right_height_;  ///< of the images [px]
  int scale_, top_, detail_top_, width_, pair_bottom_;
  cv::Size detail_;  ///< of one detail [px of the picture]
};

}  // namespace quadedge::report
