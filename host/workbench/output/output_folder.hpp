#pragma once
/// \file output_folder.hpp  The folder that a run writes to, and the lock that keeps others out of it.

#include <string>
#include <utility>
#include <vector>

namespace quadedge::report {

/// Beginning of the names of files with the trajectory of one segment, before its number and ".txt".
constexpr const char* kSegmentFile = "trajectory_segment_";

/// A lock that ends with its object or its process, and removes its file.
class FolderLock {
 public:
  /// `what`: the folder, for the message. \throws UsageError when another process holds it, DataError when the file
  /// cannot be created. On file systems without locks it does nothing.
  FolderLock(std::string file, const std::string& what);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : name_(std::move(other.name_)), file_(std::exchange(other.file_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

  /// The program that replaces this one in its process holds the lock as well; its file then remains.
  void keep_in_next_program() const;

 private:
  bool is_removed() const;

  std::string name_;
  int file_ = -1;
};

/// Creates the folder, checks that it can be written, and locks it. A folder with results is refused without
/// `force`; with it, the old results (and nothing else) are removed, so that no stale file stays among the new ones.
/// \throws UsageError for a refused folder and for one that another run writes to, DataError (naming the path) for one
/// that cannot be made or written.
[[nodiscard]] FolderLock prepare_output_folder(const std::string& path, bool force);

/// Before long work: refuses a folder that prepare_output_folder() would refuse for its results. \throws UsageError.
void refuse_results(const std::string& path, bool force);

/// Refuses outputs that name the same file, and one that names a file of `inputs`; folders, devices and empty names
/// aside. \throws UsageError.
void refuse_shared_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Refuses output files that a run's own results in `folder` would replace, and those that would replace a file of the
/// recording in `input`; an empty name counts as none. \throws UsageError.
void check_beside_results(const std::vector<std::string>& outputs, const std::string& folder, const std::string& input);

/// Before long work: refuses a file that exists, unless `force`, and one that could not be written. Nothing for an
/// empty path. \throws UsageError, DataError.
void check_output_file(const std::string& path, bool force);

/// Name of the default output folder for a sequence: quadedge_NAME in the current directory.
std::string default_output_folder(const std::string& sequence);

}  // namespace quadedge::report
