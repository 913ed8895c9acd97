#pragma once
/// \file draw_matches.hpp  Final stereo edges over their image pair, as the paper's Figures 8 and 9 show them.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"

namespace quadedge::report {

/// The stereo edges of known truth of one class over both images side by side, each in a colour of its own: correct
/// ones as strokes, with the regions that hold most of them enlarged below; others as markers, from which a line leads
/// to a ring at the true position in the right image. Edges that the right view does not show are drawn with the wrong
/// ones. \throws DataError.
void draw_matches(const std::string& path, const evaluation::DrawnFrame& frame, const std::string& name,
                  const evaluation::MatchingTolerance& tolerance, evaluation::MatchClass kind);

/// A drawing that was written.
struct WrittenDrawing {
  std::string name;     ///< of the result that it shows
  std::string file;     ///< with the folder, absolute
  std::string caption;  ///< what it shows
};

/// Writes FOLDER/NAME_{correct,inaccurate,wrong}.png of every result with a frame to draw; the second result of one
/// name gets a "_2". Makes the folder. \throws DataError.
std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance);

}  // namespace quadedge::report
