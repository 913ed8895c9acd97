/// \file output_folder.cpp  A lock by flock(), taken again if its file has been removed; deletes only known results.
#include "output/output_folder.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
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
    "trajectory.txt", "trajectory_kitti.txt", "groundtruth.txt", "errors.csv",         "frames.csv",
    "poses.csv",      "report.json",          "config.toml",     "trajectory_map.txt", "loops.csv",
    "locations.csv",  "localisation.json",    "edges.csv"};

bool is_result(const fs::path& file) {
  const std::string name = file.string();
  return name.rfind(kSegmentFile, 0) == 0 ||
         std::find(std::begin(kResultFiles), std::end(kResultFiles), name) != std::end(kResultFiles);
}

/// In alphabetical order; none for a folder that does not exist.
std::vector<fs::path> results_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (is_result(entry.path().filename())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

bool is_picture(const fs::path& file) {
  const std::string name = file.filename().string();
  if (file.extension() == ".jpg") return name.rfind("thumbnail_", 0) == 0 || name.rfind("pair_", 0) == 0;
  return file.extension() == ".png" &&
         (name == "trajectory.png" || name.rfind("edges_", 0) == 0 || name.rfind("quads_", 0) == 0);
}

/// Where a path leads, whether or not there is something.
fs::path place_of(const std::string& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(path, error);
  return error ? fs::absolute(path, error).lexically_normal() : place;
}

/// Whether both paths lead to one file. Only a file can be replaced.
bool are_one_file(const std::string& one, const std::string& other) {
  if (one.empty() || other.empty()) return false;
  std::error_code error;
  const auto is_no_file = [&](const std::string& path) {
    return fs::exists(path, error) && !fs::is_regular_file(path, error);
  };
  if (is_no_file(one) || is_no_file(other)) return false;
  return place_of(one) == place_of(other) || fs::equivalent(one, other, error);
}

/// The part of a path below a folder; empty if it does not lie there.
fs::path part_below(const std::string& folder, const std::string& path) {
  const fs::path part = place_of(path).lexically_relative(place_of(folder));
  return part.empty() || *part.begin() == ".." || *part.begin() == "." ? fs::path() : part;
}

}  // namespace

void refuse_shared_files(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  for (auto output = outputs.begin(); output != outputs.end(); ++output) {
    for (auto other = outputs.begin(); other != output; ++other)
      if (are_one_file(*output, *other))
        throw UsageError(*output + ": two outputs would be written to this file, expected a file for each");
    for (const auto& input : inputs)
      if (are_one_file(*output, input))
        throw UsageError(*output + ": an output would replace this file, which is read; expected another name");
  }
}

void check_beside_results(const std::vector<std::string>& outputs, const std::string& folder,
                          const std::string& input) {
  std::error_code error;
  if (!input.empty() && fs::equivalent(folder, input, error))
    throw UsageError(folder +
                     ": the results would be written among the files of the recording, expected another folder");
  for (const auto& output : outputs) {
    if (output.empty()) continue;
    const fs::path part = part_below(folder, output);
    if (is_result(part) || part == ".lock" || (!part.empty() && *part.begin() == "pictures"))
      throw UsageError(output + ": the run writes its own results to this file, expected another name");
    if (part.empty() && !input.empty() && !part_below(input, output).empty() && fs::exists(output, error))
      throw UsageError(output + ": this file belongs to the recording, expected another name");
  }
}

FolderLock::FolderLock(std::string file, const std::string& what) : name_(std::move(file)) {
  do {
    if (file_ >= 0) close(file_);
    file_ = open(name_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file_ < 0) throw DataError(name_ + ": cannot be created: " + std::strerror(errno));
    if (flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      close(file_);
      throw UsageError(what + ": another run or batch is writing to this folder");
    }
  } while (is_removed());
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  unlink(name_.c_str());  // before the lock ends, so no other process holds it yet
  close(file_);
}

void FolderLock::keep_in_next_program() const {
  if (file_ >= 0) fcntl(file_, F_SETFD, fcntl(file_, F_GETFD) & ~FD_CLOEXEC);
}

/// Whether its last holder removed the file between open() and flock(); other processes then lock a new file.
bool FolderLock::is_removed() const {
  struct stat held {
  }, named{};
  if (fstat(file_, &held) != 0) return false;
  return stat(name_.c_str(), &named) != 0 || held.st_ino != named.st_ino || held.st_dev != named.st_dev;
}

void refuse_results(const std::string& path, bool force) {
  const std::vector<fs::path> old = results_in(path);
  if (force || old.empty()) return;
  throw UsageError(path + ": the folder holds results (" + old.front().filename().string() +
                   "); choose another folder with -o, or replace them with --force");
}

FolderLock prepare_output_folder(const std::string& path, bool force) {
  const fs::path folder(path);
  data::make_folder(folder / "pictures");
  std::error_code error;
  FolderLock lock((folder / ".lock").string(), path);
  refuse_results(path, force);
  for (const fs::path& file : results_in(folder)) data::remove_all(file);
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

std::string default_output_folder(const std::string& sequence) { return "quadedge_" + data::plain_name(sequence); }

}  // namespace quadedge::report
