#pragma once
/// \file read_back.hpp  Results that the host reads once per frame.

#include <cstddef>
#include <exception>

#include "opencl/buffer.hpp"

namespace quadedge::opencl {

/// Gives the host access to the contents of buffers. On CPUs the buffer is mapped, which copies nothing; on other
/// devices it is copied to pinned memory, which is mapped once and reused in every frame.
class ReadBack {
 public:
  ReadBack() = default;
  ~ReadBack() { release(); }
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

  /// Waits for everything enqueued before and calls use(const T*) with the first `count` elements of `buffer`.
  /// \throws DeviceError
  template <class T, class Use>
  void read(Context& context, const Buffer<T>& buffer, std::size_t count, const Use& use) {
    if (count == 0) return;
    const std::size_t bytes = count * sizeof(T);
    context.count_wait();
    context.count_to_host(bytes);
    try {
      const cl::CommandQueue& queue = context.queue();
      cl::Event* const event = context.watch(Context::Command::transfer);
      if (context.is_cpu()) {
        void* const mapped = queue.enqueueMapBuffer(buffer.memory(), CL_TRUE, CL_MAP_READ, 0, bytes, nullptr, event);
        context.copies_done();
        use(static_cast<const T*>(mapped));
        queue.enqueueUnmapMemObject(buffer.memory(), mapped);
      } else {
        reserve(context, bytes);
        queue.enqueueReadBuffer(buffer.memory(), CL_TRUE, 0, bytes, pinned_, nullptr, event);
        context.copies_done();
        use(static_cast<const T*>(pinned_));
      }
    } catch (const cl::Error& error) {
      throw_device_error("reading a result", error.err(), context.name());
    }
  }

 private:
  void reserve(Context& context, std::size_t bytes) {
    if (bytes <= capacity_) return;
    release();
    const std::size_t wanted = bytes + bytes / 8;
    context_ = &context;
    memory_ = cl::Buffer(context.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, wanted);
    pinned_ = context.queue().enqueueMapBuffer(memory_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, wanted);
    capacity_ = wanted;
  }
  void release() noexcept {
    if (pinned_ == nullptr) return;
    try {
      context_->queue().enqueueUnmapMemObject(memory_, pinned_);
      context_->queue().finish();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
      // The device is lost, or this is a forked process: the memory goes with the context.
    }
    pinned_ = nullptr;
    capacity_ = 0;
  }

  Context* context_ = nullptr;
  cl::Buffer memory_;
  void* pinned_ = nullptr;
  std::size_t capacity_ = 0;  ///< bytes
};

}  // namespace quadedge::opencl
