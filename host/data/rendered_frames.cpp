#include "data/rendered_frames.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>
#include <thread>

#include "data/atomic_file.hpp"
#include "data/content_hash.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace fs = std::filesystem;
namespace {

constexpr std::chrono::milliseconds kPoll{50};

/// Key of the pixels of all frames with these options.
std::string key_of(const SyntheticOptions& options) {
  // Naming every member causes a compile error when one is added. The pixels do not depend on the number of threads,
  // and on the number of frames only for the loop, which closes with the last frame.
  const auto& [scene, path, frames, width, height, focal, baseline, lens, right_rotation, noise, gain, right_gain,
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
  hash.add(lens);
  hash.add({right_rotation.x(), right_rotation.y(), right_rotation.z()});
  return hash.hex();
}

std::string view_file(const std::string& folder, int frame, Side side) {
  char name[32];
  std::snprintf(name, sizeof name, "/%06d_%s.pgm", frame, side == Side::right ? "right" : "left");
  return folder + name;
}

/// Header of a binary PGM file, with the checksum of its pixels as a comment. Pixels are in native byte order, because
/// the file is only read by this program on this machine.
std::string pgm_head(const Image& image) {
  ContentHash hash;
  hash.add({reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size()});
  return "P5\n# XXH3 " + hash.hex() + "\n" + std::to_string(image.width) + " " + std::to_string(image.height) + "\n" +
         std::to_string(image.max_value) + "\n";
}

std::string pgm(const Image& image) {
  std::string bytes = pgm_head(image);
  bytes.append(reinterpret_cast<const char*>(image.pixels.data()), image.pixels.size());
  return bytes;
}

/// Reads a view of the image's size. Returns false if it is missing, incomplete or modified.
bool read_view(const std::string& file, Image& image) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return false;
  std::ostringstream buffer;
  buffer << stream.rdbuf();
  const std::string bytes = buffer.str();
  if (bytes.size() < image.pixels.size()) return false;
  const std::size_t head = bytes.size() - image.pixels.size();
  std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(head), bytes.end(), image.pixels.begin());
  return bytes.compare(0, head, pgm_head(image)) == 0;
}

struct KeptSequence {
  fs::path folder;
  fs::file_time_type used;
  std::uintmax_t bytes = 0;
};

/// Removes the least recently used sequences, except `current`, until at most `bound` bytes remain. Other processes may
/// use the folder concurrently; they render missing frames again.
void bound_folders(const std::string& all_folders, const fs::path& current, std::uintmax_t bound) {
  std::vector<KeptSequence> kept;
  std::uintmax_t sum = 0;
  std::error_code ignored;
  for (const auto& folder : fs::directory_iterator(all_folders, ignored)) {
    KeptSequence sequence{folder.path(), fs::last_write_time(folder.path(), ignored)};
    for (const auto& file : fs::directory_iterator(folder.path(), ignored)) {
      const auto size = file.file_size(ignored);
      if (size != static_cast<std::uintmax_t>(-1)) sequence.bytes += size;
    }
    sum += sequence.bytes;
    if (sequence.folder.filename() != current.filename()) kept.push_back(std::move(sequence));
  }
  std::sort(kept.begin(), kept.end(), [](const auto& one, const auto& other) { return one.used < other.used; });
  for (const auto& sequence : kept) {
    if (sum <= bound) return;
    fs::remove_all(sequence.folder, ignored);
    sum -= sequence.bytes;
  }
}

int thread_count(const SyntheticOptions& options) {
  if (options.threads > 0) return options.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// Views are rendered in parallel; the threads share a view only if there are more threads than views.
SyntheticOptions with_threads_per_view(SyntheticOptions options) {
  options.threads = std::clamp(thread_count(options) / (2 * std::max(1, options.frames)), 1, 1024);
  return options;
}

}  // namespace

RenderedFrames::RenderedFrames(const SyntheticOptions& options, const std::string& folder, Watch watch,
                               std::uintmax_t bound)
    : sequence_(with_threads_per_view(options)),
      all_folders_(folder),
      folder_(folder.empty() ? "" : folder + "/" + key_of(options)),
      watch_(std::move(watch)),
      bound_(bound),
      threads_(thread_count(options)),
      keeps_(!folder.empty()) {
  progress_.frames = options.frames;
}

std::uintmax_t RenderedFrames::frames_within_bound() const {
  const auto& camera = sequence_.rig().left;
  return bound_ / (2 * static_cast<std::uintmax_t>(camera.width) * static_cast<std::uintmax_t>(camera.height));
}

int RenderedFrames::kept() const {
  return keeps_ ? static_cast<int>(
                      std::min<std::uintmax_t>(frames_within_bound(), static_cast<std::uintmax_t>(progress_.ready)))
                : 0;
}

void RenderedFrames::make_folder() {
  if (!keeps_) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) {
    keeps_ = false;
    cache_error_ = folder_ + ": cannot be made: " + error.message();
    return;
  }
  fs::last_write_time(folder_, fs::file_time_type::clock::now(),
                      error);  // marks the folder as used; errors are harmless
}

/// Returns true if the view had to be rendered.
bool RenderedFrames::make_view(int frame, Side side, Image& image) {
  const auto& camera = sequence_.rig().left;
  image = Image(camera.width, camera.height, sequence_.rig().max_value);
  const std::string file = view_file(folder_, frame, side);
  if (!folder_.empty() && read_view(file, image)) return false;
  image = sequence_.render(frame, side).image;
  if (!keeps_ || static_cast<std::uintmax_t>(frame) >= frames_within_bound()) return true;
  try {
    write_atomically(file, pgm(image));
  } catch (const DataError& error) {
    if (keeps_.exchange(false)) cache_error_ = error.what();  // read only when no other thread is running
  }
  return true;
}

bool RenderedFrames::tell(int ready, int rendered_views) {
  progress_.ready = ready;
  progress_.rendered = (rendered_views + 1) / 2;
  return !watch_ || watch_(progress_);
}

bool RenderedFrames::prepare() {
  if (ended_) return false;
  const int frames = sequence_.frames();
  if (next_ == frames || next_ < first_ + static_cast<int>(block_.size())) return true;
  make_folder();
  const auto count = std::clamp<std::uintmax_t>(frames_within_bound(), 1, static_cast<std::uintmax_t>(frames - next_));
  first_ = next_;
  block_ = std::vector<FramePrefetcher::Frame>(count);
  const int views = 2 * static_cast<int>(count), rendered_before = 2 * progress_.rendered;
  std::atomic<int> claimed{0}, made{0}, rendered{rendered_before};
  std::atomic<bool> stop{false};
  const auto work = [&] {
    for (int view = claimed++; view < views && !stop; view = claimed++) {
      auto& frame = block_[static_cast<std::size_t>(view / 2)];
      const Side side = kSides[view % 2];
      if (make_view(first_ + view / 2, side, side == Side::right ? frame.right : frame.left)) ++rendered;
      ++made;
    }
  };
  std::vector<std::future<void>> workers;
  for (int i = 0; i < std::min(threads_, views); ++i) workers.push_back(std::async(std::launch::async, work));
  for (const auto& worker : workers) {
    while (worker.wait_for(kPoll) != std::future_status::ready) {
      if (!stop && made < views) stop = !tell(first_ + made / 2, rendered);
    }
  }
  for (auto& worker : workers) worker.get();
  if (keeps_ && rendered > rendered_before) bound_folders(all_folders_, folder_, bound_);
  ended_ = !tell(first_ + made / 2, rendered) || stop;
  return !ended_;
}

std::optional<FramePrefetcher::Frame> RenderedFrames::next() {
  if (!prepare() || next_ == sequence_.frames()) return std::nullopt;
  FramePrefetcher::Frame frame = std::move(block_[static_cast<std::size_t>(next_ - first_)]);
  frame.number = next_++;
  frame.stamp_ns = sequence_.stamp_ns(frame.number);
  return frame;
}

void RenderedFrames::rewind() {
  next_ = first_ = 0;
  block_.clear();
}

}  // namespace quadedge::data
