#pragma once
/// \file whole_results.hpp  Are the results of a run all there?

#include <string>

namespace quadedge::report {

/// \throws DataError, naming the file, when one of the files that a finished run leaves in `folder` is missing,
/// damaged, or ends early: poses, rows and report have to tell of the same frames.
void check_whole(const std::string& folder);

}  // namespace quadedge::report
