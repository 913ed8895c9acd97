#include "report/output_folder.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "data/atomic_file.hpp"
#include "data/find_sequences.hpp"
#include "quadedge/error.hpp"

namespace quadedge::report {
namespace fs = std::filesystem;
namespace {

constexpr const char* kResultFiles[] = {
    "trajectory.txt", "trajectory_kitti.txt", "groundtruth.txt",    "errors.csv", "frames.csv",    "poses.csv",
    "report.json",    "config.toml",          "trajectory_map.txt", "loops.csv",  "locations.csv", "localisation.json"};

bool is_picture(const fs::path& file) {
  const std::string name = file.filename().string();
  if (file.extension() == ".jpg") return name.rfind("thumbnail_", 0) == 0 || name.rfind("pair_", 0) == 0;
  return file.extension() == ".png" &&
         (name == "trajectory.png" || name.rfind("edges_", 0) == 0 || name.rfind("quads_", 0) == 0);
}

}  // namespace

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

FolderLock prepare_output_folder(const std::string& path, bool force) {
  const fs::path folder(path);
  std::error_code error;
  fs::create_directories(folder / "pictures", error);
  if (error) throw DataError(path + ": cannot create the output folder: " + error.message());
  FolderLock lock((folder / ".lock").string(), false, path);
  for (const char* name : kResultFiles) {
    if (!fs::exists(folder / name, error)) continue;
    if (!force)
      throw UsageError(path + ": the folder holds results (" + name +
                       "); choose another folder with -o, or replace them with --force");
    fs::remove(folder / name, error);
    if (error) throw DataError((folder / name).string() + ": cannot remove the old result: " + error.message());
  }
  for (const auto& entry : fs::directory_iterator(folder / "pictures", error)) {
    if (is_picture(entry.path())) fs::remove(entry.path(), error);
  }
  if (error) throw DataError((folder / "pictures").string() + ": cannot remove old pictures: " + error.message());
  return lock;
}

void check_output_file(const std::string& path, bool force) {
  if (path.empty()) return;
  std::error_code error;
  if (!force && fs::is_regular_file(path, error)) {
    throw UsageError(path + ": the file exists; choose another name, or overwrite it with --force");
  }
  data::check_writable(path);
}

void refuse_full_folder(const std::string& path, bool force) {
  std::error_code error;
  if (force || path.empty() || !std::filesystem::is_directory(path, error) || std::filesystem::is_empty(path, error))
    return;
  throw UsageError(path + ": the folder is not empty; choose another one, or overwrite files in it with --force");
}

std::string default_output_folder(const std::string& sequence) { return "quadedge_" + data::plain_name(sequence); }

}  // namespace quadedge::report
