#pragma once
/// \file damaged_sequence.hpp  A copy of the small rendered sequence for tests of bad input.

#include "program.hpp"

/// A copy of the small sequence that a test may damage.
class DamagedSequence {
 public:
  DamagedSequence() {
    std::filesystem::copy(small_sequence(), folder_ / "room", std::filesystem::copy_options::recursive);
  }
  std::string path() const { return folder_ / "room"; }
  std::string operator/(const std::string& name) const { return path() + "/" + name; }
  /// The n-th image of a folder in order of names.
  std::filesystem::path image(const std::string& name, std::size_t n) const {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path() + "/" + name)) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files.at(n);
  }

 private:
  TemporaryFolder folder_;
};
