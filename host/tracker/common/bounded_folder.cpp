/// \file bounded_folder.cpp  Sorts files by the time of their last use and deletes from the oldest on.
#include "common/bounded_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

namespace quadedge {
namespace fs = std::filesystem;

void remove_oldest_files(const std::string& folder, const std::string& suffix, std::uintmax_t bound) {
  std::vector<std::pair<fs::file_time_type, fs::directory_entry>> files;
  std::uintmax_t bytes = 0;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto size = entry.file_size(ignored);
    if (ignored || entry.path().extension() != suffix) continue;
    bytes += size;
    files.emplace_back(entry.last_write_time(ignored), entry);
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [used, entry] : files) {
    if (bytes <= bound) return;
    bytes -= entry.file_size(ignored);
    fs::remove(entry.path(), ignored);
  }
}

}  // namespace quadedge
