#pragma once
/// \file content_hash.hpp  Fingerprints that tell whether a result still belongs to its input.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quadedge/dataset.hpp"

namespace quadedge::data {

/// A 128-bit XXH3 fingerprint of a row of values. Each value goes in with its length, so that ("ab", "c") and ("a",
/// "bc") differ. Not for keeping secrets.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  void add(std::string_view bytes);
  void add(const std::vector<double>& values);
  /// 32 hexadecimal digits for everything added so far.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// What of a recording decides the outcome of its run: layout, cameras, undistortion, stamps and ground-truth poses,
/// all as read from the text files, and of every image or video its file name, size and first and last 4 KiB: the
/// images of a long sequence are gigabytes, and a PNG ends with checksums of all its pixels. (Only a change of equal
/// size deep inside a JPEG, a video or an uncompressed image goes unnoticed.) Times of modification and the place of
/// the folder do not count. \throws DataError for an image that cannot be read.
std::string dataset_hash(const Dataset& dataset);

/// Fingerprint of a whole file. \throws DataError.
std::string file_hash(const std::string& path);

}  // namespace quadedge::data
