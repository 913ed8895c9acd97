/// \file content_hash.cpp  XXH3 of the length and the bytes of every value.
#include "data/content_hash.hpp"

#include <cstdint>
#include <cstdio>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "data/text.hpp"

namespace quadedge::data {

void ContentHash::add(std::string_view bytes) {
  const std::uint64_t length = bytes.size();
  bytes_.append(reinterpret_cast<const char*>(&length), sizeof length).append(bytes);
}

void ContentHash::add(const std::vector<double>& values) {
  add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
}

std::string ContentHash::hex() const {
  const XXH128_hash_t digest = XXH3_128bits(bytes_.data(), bytes_.size());
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(digest.high64),
                static_cast<unsigned long long>(digest.low64));
  return text;
}

std::string file_hash(const std::string& path) {
  ContentHash hash;
  hash.add(read_bytes(path));
  return hash.hex();
}

}  // namespace quadedge::data
