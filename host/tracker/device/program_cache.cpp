/// \file program_cache.cpp  Key, length and checksum precede the binary; files are written aside and renamed.
#include "device/program_cache.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string_view>
#include <thread>
#include <unistd.h>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "common/bounded_folder.hpp"

namespace quadedge::opencl {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kContent = "quadedge program 2\n";
constexpr const char* kSuffix = ".program";

/// Detects damage, not manipulation.
std::uint64_t checksum(std::string_view bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

std::string number(std::uint64_t value) {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx\n", static_cast<unsigned long long>(value));
  return text;
}

/// Header before the binary. It contains the whole key, because two keys may have the same file name.
std::string head(const std::string& key, std::string_view binary) {
  return std::string(kContent) + number(key.size()) + number(binary.size()) + number(checksum(binary)) + key;
}

}  // namespace

std::string ProgramCache::path(const std::string& key) const {
  return folder_ + "/" + number(checksum(key)).substr(0, 16) + kSuffix;
}

std::optional<ProgramCache::Binary> ProgramCache::find(const std::string& key) const {
  if (folder_.empty()) return std::nullopt;
  std::ifstream stream(path(key), std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(stream), {}};
  const std::size_t front = head(key, {}).size();
  if (!stream || file.size() < front) return std::nullopt;
  const std::string_view binary = std::string_view(file).substr(front);
  if (file.compare(0, front, head(key, binary)) != 0) return std::nullopt;
  std::error_code ignored;
  fs::last_write_time(path(key), fs::file_time_type::clock::now(), ignored);  // time of the last use
  return Binary(binary.begin(), binary.end());
}

void ProgramCache::keep(const std::string& key, const Binary& binary) const {
  if (folder_.empty()) return;
  std::error_code failed;
  fs::create_directories(folder_, failed);
  // Named as a program, so that what a crash leaves is removed as the oldest file some day.
  const auto thread = std::hash<std::thread::id>()(std::this_thread::get_id());
  const std::string unfinished = path(key) + "." + std::to_string(getpid()) + "." + std::to_string(thread) + kSuffix;
  {
    std::ofstream stream(unfinished, std::ios::binary);
    const std::string_view bytes(reinterpret_cast<const char*>(binary.data()), binary.size());
    stream << head(key, bytes) << bytes;
    if (!stream.flush()) failed = std::make_error_code(std::errc::io_error);
  }
  if (!failed) fs::rename(unfinished, path(key), failed);
  std::error_code ignored;
  if (failed) fs::remove(unfinished, ignored);
  remove_oldest_files(folder_, kSuffix, kBound);
}

}  // namespace quadedge::opencl
