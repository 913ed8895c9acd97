#include "data/atomic_file.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <unistd.h>

#include "quadedge/error.hpp"

namespace quadedge::data {

void write_atomically(const std::string& path, std::string_view bytes) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  const bool replace = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
  const std::string name = replace ? path + ".part" + std::to_string(getpid()) : path;
  const auto give_up = [&](const char* step, int reason) {
    if (replace) std::filesystem::remove(name, ignored);
    throw DataError(path + ": cannot " + step + ": " + std::strerror(reason) +
                    "; expected a place that can be written");
  };
  std::FILE* stream = std::fopen(name.c_str(), "wb");
  if (stream == nullptr) give_up("open the file for writing", errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size() && std::fflush(stream) == 0;
  const int write_reason = errno;
  const bool closed = std::fclose(stream) == 0;
  if (!written) give_up("write the file", write_reason);
  if (!closed) give_up("close the file", errno);
  if (replace && std::rename(name.c_str(), path.c_str()) != 0) give_up("rename the finished file", errno);
}

}  // namespace quadedge::data
