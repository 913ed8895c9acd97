/// \file atomic_file.cpp  Writes NAME.partPID and renames it, also behind links; writes pipes and devices directly.
#include "data/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// Whether the file is written to a temporary name and renamed. Devices and pipes are written directly.
bool is_replaced(const std::string& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  return !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
}

std::string unfinished_name(const std::string& path) { return path + ".part" + std::to_string(getpid()); }

[[noreturn]] void refuse(const std::string& path, const char* step, int reason) {
  throw DataError(path + ": cannot " + step + ": " + std::strerror(reason) + "; expected a writable location");
}

constexpr const char* kOpen = "open the file for writing";

/// Where a path leads that may be a symbolic link: links stay, and what they point to is replaced. \throws DataError
/// for a link to nothing, of which only its owner knows whether a file is wanted there
std::string target_of(const std::string& path) {
  if (path.empty()) throw DataError("found an empty name of an output file, expected a path");
  std::error_code error;
  if (!std::filesystem::is_symlink(path, error)) return path;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  if (error) refuse(path, "follow the symbolic link", error.value());
  return target.string();
}

std::string user_folder(const char* variable, const char* below_home) {
  const char* base = std::getenv(variable);
  if (base != nullptr && base[0] == '/')
    return std::string(base) + "/quadedge";  // the specification requires relative paths to be ignored
  const char* home = std::getenv("HOME");
  if (home != nullptr && home[0] != '\0') return std::string(home) + below_home + "/quadedge";
  return {};
}

}  // namespace

void check_writable(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) refuse(path, kOpen, EISDIR);
  if (!is_replaced(path)) return;  // opening a pipe may block, opening a device may have side effects
  const std::string name = unfinished_name(target_of(path));
  std::FILE* stream = std::fopen(name.c_str(), "wb");
  if (stream == nullptr) refuse(path, kOpen, errno);
  std::fclose(stream);
  std::filesystem::remove(name, error);
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) refuse(path.string(), "make the folder", error.value());
}

void remove_all(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::remove_all(path, error);
  if (error) refuse(path.string(), "remove what is there", error.value());
}

void write_atomically(const std::string& path, std::string_view bytes) {
  const bool replace = is_replaced(path);
  const std::string target = target_of(path), name = replace ? unfinished_name(target) : target;
  const auto give_up = [&](const char* step, int reason) {
    std::error_code ignored;
    if (replace) std::filesystem::remove(name, ignored);
    refuse(path, step, reason);
  };
  std::FILE* stream = std::fopen(name.c_str(), "wb");
  if (stream == nullptr) give_up(kOpen, errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size() && std::fflush(stream) == 0;
  const int write_reason = errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written) give_up("write the file", write_reason);
  if (!closed) give_up("close the file", errno);
  if (replace && std::rename(name.c_str(), target.c_str()) != 0) give_up("rename the finished file", errno);
}

std::string configuration_folder() { return user_folder("XDG_CONFIG_HOME", "/.config"); }

std::string cache_folder() { return user_folder("XDG_CACHE_HOME", "/.cache"); }

}  // namespace quadedge::data
