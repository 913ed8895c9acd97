/// \file prefetcher.cpp  FramePrefetcher: one thread decodes, a bounded queue in between.

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "data/image_file.hpp"
#include "data/text.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge {
namespace {

Image read_checked(const std::string& file, const PinholeCamera& camera, int white) {
  Image image = read_grey_image(file);
  if (image.width != camera.width || image.height != camera.height) {
    data::fail(file, data::to_string({image.width, image.height}) + " pixels",
               data::to_string({camera.width, camera.height}) + " as the calibration and the other frames");
  }
  if (image.white != white) {
    data::fail(file, "values to " + std::to_string(image.white),
               "to " + std::to_string(white) + " as in the first left image");
  }
  return image;
}

}  // namespace

class FramePrefetcher::Implementation {
 public:
  Implementation(const Dataset& dataset, int ahead)
      : frames_(dataset.frames),
        left_(dataset.rig.left),
        right_(dataset.rig.right),
        white_(dataset.rig.white),
        ahead_(static_cast<std::size_t>(std::max(1, ahead))),
        reader_([this] { read_all(); }) {}

  ~Implementation() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    reader_.join();
  }

  std::optional<Frame> next() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !queue_.empty() || finished_; });
    if (queue_.empty()) return std::nullopt;
    Item item = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    changed_.notify_all();
    if (item.problem) std::rethrow_exception(item.problem);
    return std::move(item.frame);
  }

 private:
  /// A frame, or what went wrong in its place.
  struct Item {
    Frame frame;
    std::exception_ptr problem;
  };

  Item read(std::size_t number) const {
    Item item;
    try {
      const FrameFiles& files = frames_[number];
      item.frame = {static_cast<int>(number), files.stamp_ns, read_checked(files.left, left_, white_),
                    read_checked(files.right, right_, white_)};
    } catch (...) {
      item.problem = std::current_exception();
    }
    return item;
  }

  void read_all() {
    bool good = true;
    for (std::size_t number = 0; good && number < frames_.size(); ++number) {
      Item item = read(number);
      good = !item.problem;
      std::unique_lock<std::mutex> lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || queue_.size() < ahead_; });
      if (stop_) return;
      queue_.push_back(std::move(item));
      lock.unlock();
      changed_.notify_all();
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    finished_ = true;
    changed_.notify_all();
  }

  const std::vector<FrameFiles> frames_;
  const PinholeCamera left_, right_;
  const int white_;
  const std::size_t ahead_;
  std::mutex mutex_;
  std::condition_variable changed_;  ///< the queue, finished_ or stop_
  std::deque<Item> queue_;
  bool finished_ = false;
  bool stop_ = false;
  std::thread reader_;  ///< last member: everything that it uses exists before it starts
};

FramePrefetcher::FramePrefetcher(const Dataset& dataset, int ahead)
    : implementation_(std::make_unique<Implementation>(dataset, ahead)) {}
FramePrefetcher::~FramePrefetcher() = default;
std::optional<FramePrefetcher::Frame> FramePrefetcher::next() { return implementation_->next(); }

}  // namespace quadedge
