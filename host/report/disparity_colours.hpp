#pragma once
/// \file disparity_colours.hpp  Disparities as colours, from dark (far) to bright (near).

#include <opencv2/core.hpp>
#include <vector>

namespace quadedge::report {

/// Matplotlib's viridis, which colour-blind readers can read as well.
class DisparityColours {
 public:
  /// The scale for these disparities [px]; a few wrong matches do not stretch it.
  explicit DisparityColours(const std::vector<double>& disparities);

  cv::Scalar of(double disparity) const;
  /// The disparity of the brightest colour [px]; larger ones share it.
  double largest() const { return largest_; }
  /// Draws the scale as a bar that begins at `x` with its lower edge at `y`; returns the x after its end.
  int draw_bar(cv::Mat& picture, int x, int y) const;

 private:
  std::vector<cv::Scalar> colours_;
  double largest_;
};

}  // namespace quadedge::report
