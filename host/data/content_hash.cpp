#include "data/content_hash.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <set>

#define XXH_INLINE_ALL  // header-only
#include <xxhash.h>

#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr std::uintmax_t kSample = 4096;  // bytes at each end of an image

void add_camera(ContentHash& hash, const PinholeCamera& camera) {
  hash.add({camera.fx, camera.fy, camera.cx, camera.cy, static_cast<double>(camera.width),
            static_cast<double>(camera.height)});
}

void add_pose(ContentHash& hash, const Eigen::Isometry3d& pose) {
  const Eigen::Matrix4d& matrix = pose.matrix();
  hash.add(std::vector<double>(matrix.data(), matrix.data() + matrix.size()));
}

void add_table(ContentHash& hash, const UndistortionTable& table) {
  hash.add({static_cast<double>(table.width), static_cast<double>(table.height)});
  for (const auto* source : {&table.source_x, &table.source_y}) {
    hash.add({reinterpret_cast<const char*>(source->data()), source->size() * sizeof(float)});
  }
}

void add_mask(ContentHash& hash, const PixelMask& mask) {
  hash.add({static_cast<double>(mask.width), static_cast<double>(mask.height)});
  hash.add({reinterpret_cast<const char*>(mask.hidden.data()), mask.hidden.size()});
}

/// Adds name, size and both ends of an image or video file.
void add_image(ContentHash& hash, const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) fail(path, "a file that cannot be read", "an image");
  const auto size = static_cast<std::uintmax_t>(file.tellg());
  hash.add(std::filesystem::path(path).filename().string());
  hash.add({static_cast<double>(size)});
  std::string sample(static_cast<std::size_t>(std::min(size, kSample)), '\0');
  for (const std::uintmax_t place : {std::uintmax_t{0}, size - sample.size()}) {
    file.seekg(static_cast<std::streamoff>(place));
    file.read(sample.data(), static_cast<std::streamsize>(sample.size()));
    if (!file) fail(path, "a file that cannot be read", "an image");
    hash.add(sample);
  }
}

}  // namespace

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

std::string dataset_hash(const Dataset& dataset) {
  ContentHash hash;
  hash.add(dataset.format);
  hash.add(dataset.name);
  add_camera(hash, dataset.rig.left);
  add_camera(hash, dataset.rig.right);
  add_pose(hash, dataset.rig.right_from_left);
  add_table(hash, dataset.rig.left_undistortion);
  add_table(hash, dataset.rig.right_undistortion);
  add_mask(hash, dataset.rig.left_mask);
  add_mask(hash, dataset.rig.right_mask);
  hash.add({dataset.rig.disparity_range()});
  std::set<std::string> added;  // videos are listed with every frame
  for (const auto& frame : dataset.frames) {
    hash.add(std::to_string(frame.stamp_ns));
    for (const auto& file : {frame.left, frame.right})
      if (!dataset.stream || added.insert(file).second) add_image(hash, file);
  }
  for (const auto& pose : dataset.truth) {
    hash.add(std::to_string(pose.stamp_ns));
    add_pose(hash, pose.world_from_left);
  }
  return hash.hex();
}

std::string file_hash(const std::string& path) {
  ContentHash hash;
  hash.add(read_bytes(path));
  return hash.hex();
}

}  // namespace quadedge::data
