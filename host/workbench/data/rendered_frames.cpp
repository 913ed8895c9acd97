/// \file rendered_frames.cpp  Renders blocks of frames in parallel; cached views are named by a hash of all options.
#include "data/rendered_frames.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <tbb/parallel_for.h>
#include <thread>
#include <utility>
#include <vector>

#include "common/bounded_folder.hpp"
#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "data/image_file.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace fs = std::filesystem;
namespace {

/// Key of the pixels of all frames with these options.
std::string key_of(const SyntheticOptions& options) {
  // Naming every member causes a compile error when one is added. The pixels do not depend on the number of threads,
  // and on the number of frames only for the loop, which closes with the last frame.
  const auto& [scene, path, frames, rig, width, height, focal, baseline, lens, right_rotation, noise, gain, right_gain,
               light, gamma, bits, contrast, blur, mover, supersampling, seed, threads] = options;
  static_cast<void>(threads);
  ContentHash hash;
  hash.add(renderer_version());
  hash.add(scene);
  hash.add(path);
  hash.add(std::to_string(path == "loop" ? frames : 0));
  hash.add({static_cast<double>(width), static_cast<double>(height), focal, baseline, noise, gain, right_gain, light,
            gamma, static_cast<double>(bits), contrast, blur, mover, static_cast<double>(supersampling)});
  hash.add(std::to_string(seed));
  hash.add(rig + "," + lens);
  hash.add({right_rotation.x(), right_rotation.y(), right_rotation.z()});
  return hash.hex();
}

/// Views are rendered in parallel; threads share a view only if there are more threads than views.
SyntheticOptions with_threads_per_view(SyntheticOptions options) {
  const int threads =
      options.threads > 0 ? options.threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  options.threads = std::clamp(threads / (2 * std::max(1, options.frames)), 1, 1024);
  return options;
}

}  // namespace

/// Makes blocks of frames, as many at once as the bound allows.
class RenderedFrames::Reader : public PairReader {
 public:
  explicit Reader(std::shared_ptr<const RenderedFrames> all) : all_(std::move(all)) {
    all_->views_ = 0;
    const auto& camera = all_->sequence_.rig().left;
    const auto pair = 2 * static_cast<std::uintmax_t>(camera.width) * static_cast<std::uintmax_t>(camera.height);
    block_size_ = static_cast<int>(std::clamp<std::uintmax_t>(all_->bound_ / pair, 1, 1 << 20));
  }

  std::optional<StereoPair> next() override {
    const SyntheticSequence& sequence = all_->sequence_;
    if (next_ == sequence.frames()) return std::nullopt;
    if (next_ % block_size_ == 0) make_block(std::min(block_size_, sequence.frames() - next_));
    if (stopped_) return std::nullopt;
    StereoPair& pair = block_[static_cast<std::size_t>(next_ % block_size_)];
    pair.number = next_;
    pair.stamp_ns = sequence.stamp_ns(next_++);
    return std::move(pair);
  }
  void stop() override { stopped_ = true; }

 private:
  void make_block(int count) {
    block_ = std::vector<StereoPair>(static_cast<std::size_t>(count));
    tbb::parallel_for(0, 2 * count, [&](int i) {
      if (stopped_) return;
      StereoPair& pair = block_[static_cast<std::size_t>(i / 2)];
      (i % 2 == 0 ? pair.left : pair.right) = all_->view(next_ + i / 2, kSides[i % 2]);
      ++all_->views_;
    });
    if (!all_->folder_.empty()) remove_oldest_files(all_->folder_, ".png", all_->bound_);
  }

  std::shared_ptr<const RenderedFrames> all_;
  std::vector<StereoPair> block_;
  int next_ = 0, block_size_ = 1;
  std::atomic<bool> stopped_{false};
};

RenderedFrames::RenderedFrames(const SyntheticOptions& options, const std::string& folder, std::uintmax_t bound)
    : sequence_(with_threads_per_view(options)),
      folder_(folder),
      start_(folder + "/" + key_of(options)),
      bound_(bound),
      caches_(!folder.empty()) {}

std::unique_ptr<PairReader> RenderedFrames::open() const { return std::make_unique<Reader>(shared_from_this()); }

/// From the cache, or rendered and put there.
Image RenderedFrames::view(int frame, Side side) const {
  char number[32];
  std::snprintf(number, sizeof number, "_%06d_%s.png", frame, side == Side::right ? "right" : "left");
  const std::string file = start_ + number;
  std::error_code problem;
  fs::last_write_time(file, fs::file_time_type::clock::now(), problem);  // time of the last use
  if (caches_ && !problem) {
    try {
      Image image = read_grey_image(file);
      image.max_value = sequence_.rig().max_value;  // a PNG of 12 bits has 16
      return image;
    } catch (const DataError&) {  // NOLINT(bugprone-empty-catch): a damaged file is replaced
    }
  }
  ++rendered_;
  Image image = sequence_.render(frame, side).image;
  if (!caches_) return image;
  try {
    fs::create_directories(folder_, problem);
    write_atomically(file, encode_png(matrix_of(image)));
  } catch (const DataError& error) {
    if (caches_.exchange(false)) cache_error_ = error.what();
  }
  return image;
}

}  // namespace quadedge::data
