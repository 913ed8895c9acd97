#pragma once
/// \file draw_matches.hpp  Final stereo edges over their image pair, as the paper's Figures 8 and 9 show them.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"

namespace quadedge::report {

/// The stereo edges of known truth over both images side by side, each class with a colour and a shape. In the right
/// image a line leads from each match that is not correct to a ring at its true position.
/// \throws DataError.
void draw_matches(const std::string& path, const evaluation::DrawnFrame& frame, const std::string& name,
                  const evaluation::MatchingTolerance& tolerance);

/// A drawing that was written.
struct WrittenDrawing {
  std::string name;     ///< of the result that it shows
  std::string file;     ///< with the folder, absolute
  std::string caption;  ///< what it shows
};

/// Writes FOLDER/NAME.png of every result with a frame to draw; the second result of one name gets a "_2". Makes the
/// folder. \throws DataError.
std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance);

}  // namespace quadedge::report
