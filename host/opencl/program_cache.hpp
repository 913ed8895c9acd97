#pragma once
/// \file program_cache.hpp  Built programs that outlive the process.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace quadedge::opencl {

/// One file per program in a folder that processes may share. A file that is cut, damaged or made for something else
/// counts as none, and what cannot be kept is built again the next time: nothing here throws.
class ProgramCache {
 public:
  using Binary = std::vector<unsigned char>;

  /// Bytes of all files together; what was not used for the longest time goes first.
  static constexpr std::uintmax_t kBound = std::uintmax_t{256} << 20U;

  /// \param folder  made when it is needed; empty: nothing is kept
  explicit ProgramCache(std::string folder) : folder_(std::move(folder)) {}

  /// What keep() was given for the same key. \param key  everything that decides the binary
  std::optional<Binary> find(const std::string& key) const;
  void keep(const std::string& key, const Binary& binary) const;

  /// Where the binary of a key is kept.
  std::string path(const std::string& key) const;

 private:
  void shrink() const;

  std::string folder_;
};

}  // namespace quadedge::opencl
