/// \file content_hash.cpp  Streams the length and the bytes of every value into XXH3.
#include "data/content_hash.hpp"

#include <cstdint>
#include <cstdio>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "data/text.hpp"

namespace quadedge::data {

struct ContentHash::State {
  XXH3_state_t value;
};

ContentHash::ContentHash() : state_(std::make_unique<State>()) { XXH3_128bits_reset(&state_->value); }
ContentHash::~ContentHash() = default;

void ContentHash::add(std::string_view bytes) {
  const std::uint64_t length = bytes.size();
  XXH3_128bits_update(&state_->value, &length, sizeof length);
  XXH3_128bits_update(&state_->value, bytes.data(), bytes.size());
}

void ContentHash::add(const std::vector<double>& values) {
  add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
}

std::string ContentHash::hex() const {
  const XXH128_hash_t digest = XXH3_128bits_digest(&state_->value);
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
