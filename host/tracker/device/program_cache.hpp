#pragma once
/// \file program_cache.hpp  A cache of built programs, shared by processes.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadedge::opencl {

/// One file per program, in a folder that several processes can share. Truncated, damaged and foreign files are
/// ignored, and programs that cannot be stored are built again the next time. Nothing throws.
class ProgramCache {
 public:
  using Binary = std::vector<unsigned char>;

  /// Maximum size of all files [bytes]; the least recently used ones are removed first.
  static constexpr std::uintmax_t kBound = std::uintmax_t{256} << 20U;

  /// \param folder  created when needed; empty: no cache
  explicit ProgramCache(std::string folder) : folder_(std::move(folder)) {}

  /// The binary stored under `key`. \param key  everything that the binary depends on
  std::optional<Binary> find(const std::string& key) const;
  void keep(const std::string& key, const Binary& binary) const;

  /// Path of the file for a key.
  std::string path(const std::string& key) const;

 private:
  std::string folder_;
};

}  // namespace quadedge::opencl
