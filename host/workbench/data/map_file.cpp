/// \file map_file.cpp  Map files: a header in front of SavedMap::bytes(). All numbers are little-endian.
///
///   bytes   content
///   8       kMagic
///   4       kVersion
///   8       number of bytes of the map
///   16      their XXH3-128, canonical
#include <cstdint>
#include <cstring>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "quadedge/error.hpp"
#include "quadedge/map.hpp"

namespace quadedge {
namespace {

/// Starts like PNG's: what transfers in text mode destroy is not taken for a map.
constexpr std::string_view kMagic("\x89QEMAP\r\n", 8);
/// Of the whole format, including the forms of kept rigs, signatures and descriptors.
constexpr std::uint32_t kVersion = 2;
constexpr std::size_t kHeader = 36;
constexpr std::uintmax_t kLargestMap = std::uintmax_t{1} << 31;  // data::read_bytes()

template <class T>
std::string raw(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string checksum(std::string_view bytes) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(bytes.data(), bytes.size()));
  return raw(canonical);
}

template <class T>
T value_at(const std::string& text, std::size_t place) {
  T value;
  std::memcpy(&value, text.data() + place, sizeof value);
  return value;
}

}  // namespace

void write_map(const std::string& file, const SavedMap& map) {
  const std::string bytes = map.bytes();
  if (bytes.size() > kLargestMap - kHeader)
    data::fail(file, "a map of " + std::to_string(bytes.size()) + " bytes",
               "at most 2 GiB; map.max_memory_mb below 2000 keeps fewer keyframes");
  data::write_atomically(file, std::string(kMagic) + raw(kVersion) + raw(static_cast<std::uint64_t>(bytes.size())) +
                                   checksum(bytes) + bytes);
}

SavedMap read_map(const std::string& file) {
  const std::string text = data::read_bytes(file);
  if (text.size() < kHeader || text.compare(0, kMagic.size(), kMagic) != 0)
    data::fail(file, "a file of another kind", "a map of `quadedge run --save-map`");
  if (const auto version = value_at<std::uint32_t>(text, 8); version != kVersion)
    data::fail(file, "version " + std::to_string(version) + " of the format",
               "version " + std::to_string(kVersion) + "; save the map again with this program");
  const std::string_view bytes = std::string_view(text).substr(kHeader);
  if (const auto size = value_at<std::uint64_t>(text, 12); size != bytes.size())
    data::fail(file, std::to_string(bytes.size()) + " bytes of the map", std::to_string(size));
  if (checksum(bytes) != text.substr(20, 16))
    data::fail(file, "a map that does not match its checksum", "an undamaged file");
  return SavedMap::from_bytes(bytes, file);
}

}  // namespace quadedge
