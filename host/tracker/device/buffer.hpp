#pragma once
/// \file buffer.hpp  Typed device memory that is reused across frames, and results that the host reads once per
/// frame.

#include <cstddef>
#include <exception>
#include <utility>
#include <vector>

#include "device/context.hpp"
#include "device/status.hpp"

namespace quadedge::opencl {

/// Owns an array of `T` on the device. Move-only. Grows on request and never shrinks, so that steady frames allocate
/// nothing.
template <class T>
class Buffer {
 public:
  Buffer() = default;
  Buffer(Context& context, std::size_t count) { ensure(context, count); }
  ~Buffer() { release(); }
  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    swap(other);
    return *this;
  }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;

  /// Allocates at least `count` elements; from the second allocation on, an eighth more. Growing discards the contents.
  /// \throws DeviceError if the device has not enough memory
  void ensure(Context& context, std::size_t count) {
    if (context_ != nullptr && count <= capacity_) return;
    const std::size_t spare = context_ != nullptr ? count / 8 : 0;
    release();
    const std::size_t wanted = count == 0 ? 1 : count + spare;
    try {
      memory_ = cl::Buffer(context.context(), CL_MEM_READ_WRITE, wanted * sizeof(T));
    } catch (const cl::Error& error) {
      throw_device_error("allocating " + std::to_string(wanted * sizeof(T)) + " bytes", error.err(), context.name());
    }
    context_ = &context;
    capacity_ = wanted;
    own_bytes_ = static_cast<std::ptrdiff_t>(wanted * sizeof(T));
    context.account(own_bytes_);
  }

  /// Makes this buffer a region of `block`: `count` elements from byte `offset` on, which must be a multiple of
  /// Context::region_alignment(). Arrays that are read together can so share one allocation.
  void place(Context& context, const Buffer<cl_uchar>& block, std::size_t offset, std::size_t count) {
    release();
    const cl_buffer_region region{offset, count * sizeof(T)};
    cl_int status = CL_SUCCESS;
    memory_ = cl::Buffer(
        clCreateSubBuffer(block.memory()(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &status), false);
    if (status != CL_SUCCESS) throw_device_error("placing an array in a block", status, context.name());
    context_ = &context;
    capacity_ = count;
  }

  /// The context of the memory; null if there is none.
  Context* context() const { return context_; }
  std::size_t capacity() const { return capacity_; }
  const cl::Buffer& memory() const { return memory_; }

  /// Copies from the host and returns when the host memory can be reused.
  void write(const T* values, std::size_t count) {
    if (count == 0) return;
    context_->count_wait();
    enqueue_write(values, count, CL_TRUE);
    context_->copies_done();
  }
  /// Non-blocking write(): `values` must not change before the next read() of any buffer of the context.
  void write_later(const T* values, std::size_t count) {
    if (count == 0) return;
    enqueue_write(values, count, CL_FALSE);
    context_->copy_started();
  }
  void write(Context& context, const std::vector<T>& values) {
    ensure(context, values.size());
    write(values.data(), values.size());
  }
  /// Waits for all commands enqueued before, then copies to the host.
  void read(T* values, std::size_t count, std::size_t offset = 0) const {
    if (count == 0) return;
    context_->count_wait();
    enqueue_read(values, count, offset, CL_TRUE);
    context_->copies_done();
  }
  /// Non-blocking read(): `values` are valid after the next read() of any buffer of the context and must exist until
  /// then.
  void read_later(T* values, std::size_t count, std::size_t offset = 0) const {
    if (count == 0) return;
    enqueue_read(values, count, offset, CL_FALSE);
    context_->copy_started();
  }
  std::vector<T> read(std::size_t count, std::size_t offset = 0) const {
    std::vector<T> values(count);
    read(values.data(), count, offset);
    return values;
  }
  /// Sets the first `count` elements, on the device.
  void fill(T value, std::size_t count) {
    if (count == 0) return;
    call("filling a buffer",
         [&] { context_->queue().enqueueFillBuffer(memory_, value, 0, count * sizeof(T), nullptr, watch()); });
  }

  void swap(Buffer& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(memory_, other.memory_);
    std::swap(capacity_, other.capacity_);
    std::swap(own_bytes_, other.own_bytes_);
  }

 private:
  void release() noexcept {
    if (context_ != nullptr) {
      context_->finish_copies();  // they may use host memory that is freed next
      context_->account(-own_bytes_);
    }
    memory_ = cl::Buffer();
    context_ = nullptr;
    capacity_ = 0;
    own_bytes_ = 0;
  }
  cl::Event* watch() const { return context_->watch(Context::Command::transfer); }
  void enqueue_write(const T* values, std::size_t count, cl_bool blocking) {
    context_->count_to_device(count * sizeof(T));
    call("writing a buffer", [&] {
      context_->queue().enqueueWriteBuffer(memory_, blocking, 0, count * sizeof(T), values, nullptr, watch());
    });
  }
  void enqueue_read(T* values, std::size_t count, std::size_t offset, cl_bool blocking) const {
    context_->count_to_host(count * sizeof(T));
    call("reading a buffer", [&] {
      context_->queue().enqueueReadBuffer(memory_, blocking, offset * sizeof(T), count * sizeof(T), values, nullptr,
                                          watch());
    });
  }
  template <class Function>
  void call(const char* what, Function&& function) const {
    try {
      function();
    } catch (const cl::Error& error) {
      throw_device_error(what, error.err(), context_->name());
    }
  }

  Context* context_ = nullptr;
  cl::Buffer memory_;
  std::size_t capacity_ = 0;
  std::ptrdiff_t own_bytes_ = 0;  ///< 0 for a region of a block
};

/// Host memory that devices other than CPUs copy from and to without a driver's copy of their own; mapped once.
class PinnedMemory {
 public:
  PinnedMemory() = default;
  ~PinnedMemory() { release(); }
  PinnedMemory(const PinnedMemory&) = delete;
  PinnedMemory& operator=(const PinnedMemory&) = delete;

  /// At least `bytes`, with what was there before if it is large enough. \throws cl::Error
  void* reserve(Context& context, std::size_t bytes) {
    if (bytes <= capacity_) return mapped_;
    release();
    const std::size_t wanted = bytes + bytes / 8;
    context_ = &context;
    memory_ = cl::Buffer(context.context(), CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR, wanted);
    mapped_ = context.queue().enqueueMapBuffer(memory_, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0, wanted);
    capacity_ = wanted;
    return mapped_;
  }

 private:
  void release() noexcept {
    if (mapped_ == nullptr) return;
    try {
      context_->queue().enqueueUnmapMemObject(memory_, mapped_);
      context_->queue().finish();
    } catch (const std::exception&) {  // NOLINT(bugprone-empty-catch)
      // The device is lost, or this is a forked process: the memory goes with the context.
    }
    mapped_ = nullptr;
    capacity_ = 0;
  }

  Context* context_ = nullptr;
  cl::Buffer memory_;
  void* mapped_ = nullptr;
  std::size_t capacity_ = 0;  ///< bytes
};

// Results that the host reads once per frame.

/// Gives the host access to the contents of buffers. On CPUs the buffer is mapped, which copies nothing; on other
/// devices it is copied to pinned memory.
class ReadBack {
 public:
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
        void* const copied = copied_.reserve(context, bytes);
        queue.enqueueReadBuffer(buffer.memory(), CL_TRUE, 0, bytes, copied, nullptr, event);
        context.copies_done();
        use(static_cast<const T*>(copied));
      }
    } catch (const cl::Error& error) {
      throw_device_error("reading a result", error.err(), context.name());
    }
  }

 private:
  PinnedMemory copied_;
};

}  // namespace quadedge::opencl
