/// \file prefetcher.cpp  FramePrefetcher: one thread decodes frames into a bounded queue.

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "data/image_file.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge {
namespace data {

void check_image(const Image& image, const std::string& source, const PinholeCamera& camera, int max_value) {
  if (size_of(image) != size_of(camera))
    fail(source, to_string(size_of(image)) + " pixels",
         to_string(size_of(camera)) + " as the calibration and the other frames");
  if (image.max_value != max_value) {
    fail(source, "values to " + std::to_string(image.max_value),
         "to " + std::to_string(max_value) + " as in the first left image");
  }
}

}  // namespace data

namespace {

constexpr std::chrono::milliseconds kStopPollInterval{50};  // between two calls of `stop`

}  // namespace

class FramePrefetcher::Implementation {
 public:
  Implementation(const Dataset& dataset, int ahead, std::function<bool()> stop)
      : stream_(dataset.stream ? dataset.stream->open() : nullptr),
        frames_(dataset.stream ? std::vector<FrameFiles>() : dataset.frames),
        path_(dataset.path),
        left_(dataset.rig.left),
        right_(dataset.rig.right),
        max_value_(dataset.rig.max_value),
        longest_queue_(static_cast<std::size_t>(dataset.stream ? std::max(0, dataset.stream->longest_queue()) : 0)),
        ahead_(static_cast<std::size_t>(std::max(1, ahead))),
        asked_to_stop_(std::move(stop)),
        reader_([this] { read_all(); }) {}

  ~Implementation() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    if (stream_) stream_->stop();
    reader_.join();
  }

  std::optional<Frame> next() {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto is_ready = [this] { return !queue_.empty() || finished_; };
    while (!changed_.wait_for(lock, kStopPollInterval, is_ready)) {
      if (!asked_to_stop_) continue;
      lock.unlock();  // the caller's function may ask this object something
      if (asked_to_stop_()) return std::nullopt;
      lock.lock();
    }
    if (queue_.empty()) return std::nullopt;
    Item item = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    changed_.notify_all();
    if (item.problem) std::rethrow_exception(item.problem);
    return std::move(item.frame);
  }

  int dropped() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return dropped_;
  }

 private:
  /// A frame, or the error that occurred instead.
  struct Item {
    Frame frame;
    std::exception_ptr problem;
  };

  /// Name of an image in messages.
  std::string source_of(const StereoPair& pair, Side side) const {
    const auto number = static_cast<std::size_t>(pair.number);
    if (number < frames_.size()) return side == Side::left ? frames_[number].left : frames_[number].right;
    return path_ + ", " + (side == Side::left ? "left" : "right") + " image " + std::to_string(pair.number);
  }

  std::optional<StereoPair> next_pair() {
    if (stream_) return stream_->next();
    if (next_ == frames_.size()) return std::nullopt;
    const FrameFiles& files = frames_[next_];
    return StereoPair{static_cast<int>(next_++),   files.stamp_ns,
                      read_grey_image(files.left), read_grey_image(files.right),
                      read_mask(files.left_mask),  read_mask(files.right_mask)};
  }

  static Image read_mask(const std::string& file) { return file.empty() ? Image() : data::read_mask(file); }

  void check_mask(const Image& mask, const Image& image, const StereoPair& pair, Side side) const {
    if (mask.pixels.empty()) return;
    const FrameFiles& files = frames_[static_cast<std::size_t>(pair.number)];
    const std::string& file = side == Side::left ? files.left_mask : files.right_mask;
    if (data::size_of(mask) != data::size_of(image))
      data::fail(file, "a mask of " + data::to_string(data::size_of(mask)) + " pixels",
                 data::to_string(data::size_of(image)) + ", the size of its image");
    if (mask.max_value != kMaxValue8) data::fail(file, "a mask of more than 8 bits", "8 bits: black, or anything else");
  }

  /// Reads the next frame; nothing at the end.
  std::optional<Item> read() {
    Item item;
    try {
      auto pair = next_pair();
      if (!pair) return std::nullopt;
      data::check_image(pair->left, source_of(*pair, Side::left), left_, max_value_);
      data::check_image(pair->right, source_of(*pair, Side::right), right_, max_value_);
      check_mask(pair->left_mask, pair->left, *pair, Side::left);
      check_mask(pair->right_mask, pair->right, *pair, Side::right);
      item.frame = std::move(*pair);
    } catch (...) {
      item.problem = std::current_exception();
    }
    return item;
  }

  void read_all() {
    bool good = true;
    while (good) {
      std::optional<Item> item = read();
      if (!item) break;
      good = !item->problem;
      std::unique_lock<std::mutex> lock(mutex_);
      if (longest_queue_ == 0) {
        changed_.wait(lock, [this] { return stop_ || queue_.size() < ahead_; });
      } else if (good && queue_.size() >= longest_queue_) {
        queue_.pop_front();
        ++dropped_;
      }
      if (stop_) return;
      queue_.push_back(std::move(*item));
      lock.unlock();
      changed_.notify_all();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    finished_ = true;
    changed_.notify_all();
  }

  const std::unique_ptr<PairReader> stream_;  ///< null for image files
  const std::vector<FrameFiles> frames_;      ///< image files; empty for a stream
  std::size_t next_ = 0;                      ///< of frames_
  const std::string path_;
  const PinholeCamera left_, right_;
  const int max_value_;
  const std::size_t longest_queue_;  ///< 0: the stream waits for its reader
  const std::size_t ahead_;
  const std::function<bool()> asked_to_stop_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;  ///< the queue, finished_ or stop_
  std::deque<Item> queue_;
  int dropped_ = 0;
  bool finished_ = false;
  bool stop_ = false;
  std::thread reader_;  ///< last member, so that the other members exist before it starts
};

FramePrefetcher::FramePrefetcher(const Dataset& dataset, int ahead, std::function<bool()> stop)
    : implementation_(std::make_unique<Implementation>(dataset, ahead, std::move(stop))) {}
FramePrefetcher::~FramePrefetcher() = default;
std::optional<FramePrefetcher::Frame> FramePrefetcher::next() { return implementation_->next(); }
int FramePrefetcher::dropped() const { return implementation_->dropped(); }

}  // namespace quadedge
