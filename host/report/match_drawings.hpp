#pragma once
/// \file match_drawings.hpp  Drawings of final stereo edges as files.

#include <string>
#include <vector>

#include "evaluation/matching_result.hpp"

namespace quadedge::report {

/// A drawing that was written.
struct WrittenDrawing {
  std::string name;     ///< of the result that it shows
  std::string file;     ///< with the folder, absolute
  std::string caption;  ///< what it shows
};

/// Writes FOLDER/NAME_all.png and FOLDER/NAME_CLASS.png for every class that occurs, of every result with a frame to
/// draw; the second result of one name gets a "_2". Makes the folder. \throws DataError.
std::vector<WrittenDrawing> write_match_drawings(const std::string& folder,
                                                 const std::vector<evaluation::MatchingResult>& results,
                                                 const evaluation::MatchingTolerance& tolerance);

}  // namespace quadedge::report
