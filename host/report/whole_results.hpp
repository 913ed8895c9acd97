#pragma once
/// \file whole_results.hpp  Checks that the results of a run are complete.

#include <string>

namespace quadedge::report {

/// \throws DataError, naming the file, when one of the files that a finished run leaves in `folder` is missing,
/// damaged, or truncated: poses, rows and report must describe the same frames.
void check_whole(const std::string& folder);

}  // namespace quadedge::report
