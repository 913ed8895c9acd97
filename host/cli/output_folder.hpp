#pragma once
/// \file output_folder.hpp  The folder that a run writes to.

#include <string>

namespace quadedge::cli {

/// Makes the folder and checks that it can be written. A folder that holds results is refused without `force`; with it,
/// the old results (and nothing else) are removed, so that no stale file stays among the new ones. \throws UsageError
/// for a refused folder, DataError (naming the path) for one that cannot be made or written.
void prepare_output_folder(const std::string& path, bool force);

/// Refuses a file that exists, unless `force`. \throws UsageError.
void refuse_existing_file(const std::string& path, bool force);

/// Refuses a folder that holds anything, unless `force`. \throws UsageError.
void refuse_full_folder(const std::string& path, bool force);

/// Name of the default output folder for a sequence: quadedge_NAME in the current directory.
std::string default_output_folder(const std::string& sequence);

}  // namespace quadedge::cli
