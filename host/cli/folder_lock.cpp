#include "cli/folder_lock.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge::cli {

FolderLock::FolderLock(std::string file, bool shared, const std::string& what)
    : name_(std::move(file)), shared_(shared) {
  do {
    if (file_ >= 0) close(file_);
    file_ = open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw DataError(name_ + ": cannot be created: " + std::strerror(errno));
    if (flock(file_, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(file_);
      throw UsageError(what + ": another run or batch is writing to this folder");
    }
  } while (is_removed());
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  if (!shared_) unlink(name_.c_str());  // before the lock ends, so no other process holds it yet
  close(file_);
}

/// Whether its last holder removed the file between open() and flock(); other processes then lock a new file.
bool FolderLock::is_removed() const {
  struct stat held {
  }, named{};
  if (fstat(file_, &held) != 0) return false;
  return stat(name_.c_str(), &named) != 0 || held.st_ino != named.st_ino || held.st_dev != named.st_dev;
}

}  // namespace quadedge::cli
