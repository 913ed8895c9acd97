#pragma once
/// \file kernel.hpp  Kernels whose C++ signature is checked once against the built program.

#include <string>
#include <utility>

#include "opencl/buffer.hpp"
#include "opencl/context.hpp"
#include "opencl/error.hpp"

namespace quadedge::opencl {

/// A `global const T*` argument.
template <class T>
struct In {
  In(const Buffer<T>& buffer) : memory(&buffer.memory()) {}  // NOLINT: implicit on purpose
  const cl::Buffer* memory;
};
/// A `global T*` argument.
template <class T>
struct Out {
  Out(Buffer<T>& buffer) : memory(&buffer.memory()) {}  // NOLINT: implicit on purpose
  const cl::Buffer* memory;
};

/// OpenCL C name of a host type; specialise it for a structure that is passed by value.
template <class T>
struct TypeName;
template <>
struct TypeName<cl_int> {
  static constexpr const char* value = "int";
};
template <>
struct TypeName<cl_uint> {
  static constexpr const char* value = "uint";
};
template <>
struct TypeName<cl_float> {
  static constexpr const char* value = "float";
};
template <>
struct TypeName<cl_char> {
  static constexpr const char* value = "char";
};
template <>
struct TypeName<cl_uchar> {
  static constexpr const char* value = "uchar";
};
template <>
struct TypeName<cl_ushort> {
  static constexpr const char* value = "ushort";
};

/// What a kernel argument has to look like in the built program.
struct ArgumentType {
  std::string type;
  bool global = false;
  bool constant = false;
};
template <class T>
struct Describe {
  static ArgumentType get() { return {TypeName<T>::value, false, false}; }
};
template <class T>
struct Describe<In<T>> {
  static ArgumentType get() { return {std::string(TypeName<T>::value) + "*", true, true}; }
};
template <class T>
struct Describe<Out<T>> {
  static ArgumentType get() { return {std::string(TypeName<T>::value) + "*", true, false}; }
};

/// \throws DeviceError that names kernel, argument, what the program has and what the host passes.
void check_signature(const cl::Kernel& kernel, const std::vector<ArgumentType>& expected, const Context& context);

/// \throws DeviceError where the kernel takes more local memory than the device is to have.
void check_local_memory(const cl::Kernel& kernel, const std::string& name, const Context& context);

/// How many work-items to start; the global size is rounded up to whole work-groups.
struct Range {
  std::size_t x = 1, y = 1;
  std::size_t local_x = 1, local_y = 1;
  Range(std::size_t items, std::size_t local) : x(items), local_x(local) {}
  Range(std::size_t items_x, std::size_t items_y, std::size_t group_x, std::size_t group_y)
      : x(items_x), y(items_y), local_x(group_x), local_y(group_y) {}
};

/// A kernel with the C++ argument types `Args`, in order: In<T>, Out<T>, cl_int, cl_float, or a described structure.
template <class... Args>
class Kernel {
 public:
  Kernel() = default;
  Kernel(Context& context, const cl::Program& program, const std::string& name) : context_(&context), name_(name) {
    try {
      kernel_ = cl::Kernel(program, name.c_str());
    } catch (const cl::Error& error) {
      throw_device_error("creating kernel " + name, error.err(), context.name());
    }
    check_signature(kernel_, {Describe<Args>::get()...}, context);
    check_local_memory(kernel_, name, context);
  }

  /// Enqueues the kernel. An empty range enqueues nothing. \throws DeviceError with kernel, sizes and device.
  void operator()(const Range& range, Args... args) const {
    if (range.x == 0 || range.y == 0) return;
    const std::size_t global_x = (range.x + range.local_x - 1) / range.local_x * range.local_x;
    const std::size_t global_y = (range.y + range.local_y - 1) / range.local_y * range.local_y;
    try {
      if (range.local_x * range.local_y > context_->limits().group_items) throw cl::Error(CL_INVALID_WORK_GROUP_SIZE);
      cl_uint index = 0;
      (set(index++, args), ...);
      context_->count_launch();
      context_->queue().enqueueNDRangeKernel(kernel_, cl::NullRange, cl::NDRange(global_x, global_y),
                                             cl::NDRange(range.local_x, range.local_y), nullptr,
                                             context_->watch(Context::Command::kernel));
    } catch (const cl::Error& error) {
      throw_device_error("launching kernel " + name_ + " over " + std::to_string(global_x) + "x" +
                             std::to_string(global_y) + " in groups of " + std::to_string(range.local_x) + "x" +
                             std::to_string(range.local_y),
                         error.err(), context_->name());
    }
  }

 private:
  template <class T>
  void set(cl_uint index, const In<T>& argument) const {
    mutable_kernel().setArg(index, *argument.memory);
  }
  template <class T>
  void set(cl_uint index, const Out<T>& argument) const {
    mutable_kernel().setArg(index, *argument.memory);
  }
  template <class T>
  void set(cl_uint index, const T& argument) const {
    mutable_kernel().setArg(index, argument);
  }
  cl::Kernel& mutable_kernel() const { return const_cast<cl::Kernel&>(kernel_); }

  Context* context_ = nullptr;
  std::string name_;
  cl::Kernel kernel_;
};

}  // namespace quadedge::opencl
