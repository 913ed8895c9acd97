#pragma once
/// \file content_hash.hpp  Fingerprints that show whether a kept result belongs to what is asked for.

#include <string>
#include <string_view>
#include <vector>

namespace quadedge::data {

/// A 128-bit XXH3 fingerprint of a sequence of values. The length of each value is included, so that ("ab", "c") and
/// ("a", "bc") differ. Not cryptographically secure.
class ContentHash {
 public:
  void add(std::string_view bytes);
  void add(const std::vector<double>& values);
  /// 32 hexadecimal digits for all values added so far.
  std::string hex() const;

 private:
  std::string bytes_;
};

/// Fingerprint of a whole file. \throws DataError
std::string file_hash(const std::string& path);

}  // namespace quadedge::data
