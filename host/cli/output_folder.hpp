#pragma once
/// \file output_folder.hpp  The folder that a run writes to.

#include <string>

#include "cli/folder_lock.hpp"

namespace quadedge::cli {

/// Creates the folder, checks that it can be written, and locks it. A folder with results is refused without
/// `force`; with it, the old results (and nothing else) are removed, so that no stale file stays among the new ones.
/// \throws UsageError for a refused folder and for one that another run writes to, DataError (naming the path) for one
/// that cannot be made or written.
[[nodiscard]] FolderLock prepare_output_folder(const std::string& path, bool force);

/// Before long work: refuses a file that exists, unless `force`, and one that could not be written. Nothing for an
/// empty path. \throws UsageError, DataError.
void check_output_file(const std::string& path, bool force);

/// Refuses a folder that holds anything, unless `force`. \throws UsageError.
void refuse_full_folder(const std::string& path, bool force);

/// Name of the default output folder for a sequence: quadedge_NAME in the current directory.
std::string default_output_folder(const std::string& sequence);

}  // namespace quadedge::cli
