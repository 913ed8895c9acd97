#pragma once
/// \file content_hash.hpp  Fingerprints that show whether a result belongs to its input.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "quadedge/dataset.hpp"

namespace quadedge::data {

/// A 128-bit XXH3 fingerprint of a sequence of values. The length of each value is included, so that ("ab", "c") and
/// ("a", "bc") differ. Not cryptographically secure.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  void add(std::string_view bytes);
  void add(const std::vector<double>& values);
  /// 32 hexadecimal digits for all values added so far.
  std::string hex() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Fingerprint of everything in a recording that determines the result of a run: layout, cameras, undistortion,
/// timestamps and ground-truth poses, as read from the text files, and for every image or video its file name, size and
/// first and last 4 KiB, because the images of a long sequence take gigabytes, and a PNG ends with checksums of all its
/// pixels. (Only changes of equal size deep inside a JPEG, a video or an uncompressed image go unnoticed.) Modification
/// times and the location of the folder are not included. \throws DataError for an image that cannot be read
std::string dataset_hash(const Dataset& dataset);

/// Fingerprint of a whole file. \throws DataError
std::string file_hash(const std::string& path);

}  // namespace quadedge::data
