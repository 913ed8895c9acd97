#include "cli/folder_lock.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge::cli {

FolderLock::FolderLock(const std::string& file, bool shared, const std::string& what)
    : file_(open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666)) {
  if (file_ < 0) throw DataError(file + ": cannot be made: " + std::strerror(errno));
  if (flock(file_, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    close(file_);
    throw UsageError(what + ": another batch is writing there");
  }
}

FolderLock::~FolderLock() {
  if (file_ >= 0) close(file_);
}

}  // namespace quadedge::cli
