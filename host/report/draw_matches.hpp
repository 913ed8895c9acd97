#pragma once
/// \file draw_matches.hpp  Final stereo edges over their image pair, as the paper's Figures 8 and 9 show them.

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evaluation/final_match.hpp"

namespace quadedge::report {

/// The correspondences of one class over both images side by side, with up to three zoomed details below, whose
/// positions the images show as numbered frames. Correct ones are coloured by their disparity; of the others every one
/// has its own colour, the same in both views, and is linked, in the right view, with a ring at their true
/// position. `tolerance` and `wrong`: limits of the classes [px].
cv::Mat draw_match_class(const evaluation::DrawnFrame& frame, evaluation::MatchClass kind, const std::string& name,
                         double tolerance, double wrong);

/// All correspondences of known truth the same way, each class with a colour and a shape.
cv::Mat draw_all_matches(const evaluation::DrawnFrame& frame, const std::string& name, double tolerance, double wrong);

/// Files and their pictures of one frame: all classes in one, and each class that occurs.
struct MatchDrawing {
  std::string file;  ///< ends in ".png"
  std::string caption;
  cv::Mat picture;
};
std::vector<MatchDrawing> draw_matches(const evaluation::DrawnFrame& frame, const std::string& name, double tolerance,
                                       double wrong);

}  // namespace quadedge::report
