#pragma once
/// \file folder_lock.hpp  Keeps two runs or batches from writing to the same place.

#include <string>
#include <utility>

namespace quadedge::cli {

/// A lock that ends with its object or its process. An exclusive lock removes its file.
class FolderLock {
 public:
  /// `shared`: other processes may hold it shared as well. `what`: the folder, for the message. \throws UsageError when
  /// another process holds it, DataError when the file cannot be created. On file systems without locks it does
  /// nothing.
  FolderLock(std::string file, bool shared, const std::string& what);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept
      : name_(std::move(other.name_)), shared_(other.shared_), file_(std::exchange(other.file_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  bool is_removed() const;

  std::string name_;
  bool shared_;
  int file_ = -1;
};

}  // namespace quadedge::cli
