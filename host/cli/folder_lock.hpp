#pragma once
/// \file folder_lock.hpp  Keeps two batches from writing to the same place.

#include <string>
#include <utility>

namespace quadedge::cli {

/// A lock that ends with its object or its process. The file stays.
class FolderLock {
 public:
  /// `shared`: others may hold it shared as well. \throws UsageError when somebody else holds it, DataError when the
  /// file cannot be made. A file system without locks is used without.
  FolderLock(const std::string& file, bool shared, const std::string& what);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  int file_ = -1;
};

}  // namespace quadedge::cli
