#pragma once
/// \file kernel.hpp  Kernels with a C++ signature, which tests and the self-test compare with the built program.

#include <cstddef>
#include <string>
#include <type_traits>
#include <utility>

#include "common/layouts.hpp"
#include "device/buffer.hpp"
#include "device/context.hpp"
#include "device/status.hpp"

// The structures of kernels/layouts.cl as kernel arguments.

/// Every structure of kernels/layouts.cl; tests/test_layouts.cpp verifies that the list is complete.
#define QUADEDGE_KERNEL_STRUCTS(VISIT) \
  VISIT(PackedPositions)               \
  VISIT(PackedPointIndex)              \
  VISIT(EpipolarGeometry)              \
  VISIT(AlignmentSettings)             \
  VISIT(ThresholdArguments)            \
  VISIT(DetectionArguments)            \
  VISIT(EpipolarRows)                  \
  VISIT(SelectionArguments)            \
  VISIT(PatchArguments)                \
  VISIT(SiftArguments)                 \
  VISIT(DisparityProbe)                \
  VISIT(StereoCandidateArguments)      \
  VISIT(FilterLimits)                  \
  VISIT(FilterArguments)               \
  VISIT(StereoRefinementArguments)     \
  VISIT(StereoClusterArguments)        \
  VISIT(PaperRefinementArguments)      \
  VISIT(PaperClusterArguments)         \
  VISIT(PaperSimilarityArguments)      \
  VISIT(PaperQuadArguments)            \
  VISIT(CoarseDisparityArguments)      \
  VISIT(StereoRelaxationArguments)     \
  VISIT(StereoMutualArguments)         \
  VISIT(PointIndexArguments)           \
  VISIT(TemporalCandidateArguments)    \
  VISIT(QuadChoice)                    \
  VISIT(TemporalMatchArguments)        \
  VISIT(TemporalAgreementArguments)    \
  VISIT(TemporalBestArguments)         \
  VISIT(WideSelection)                 \
  VISIT(GlobalMatchingArguments)

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

/// OpenCL C name of a number or a structure of kernels/layouts.cl.
template <class T>
constexpr const char* type_name() {
  if constexpr (std::is_same_v<T, cl_int>) return "int";
  if constexpr (std::is_same_v<T, cl_uint>) return "uint";
  if constexpr (std::is_same_v<T, cl_float>) return "float";
  if constexpr (std::is_same_v<T, cl_char>) return "char";
  if constexpr (std::is_same_v<T, cl_uchar>) return "uchar";
  if constexpr (std::is_same_v<T, cl_ushort>) return "ushort";
#define QUADEDGE_DESCRIBE(NAME) \
  if constexpr (std::is_same_v<T, NAME>) return #NAME;
  QUADEDGE_KERNEL_STRUCTS(QUADEDGE_DESCRIBE)
#undef QUADEDGE_DESCRIBE
}

/// The type that a kernel argument is expected to have in the built program.
struct ArgumentType {
  std::string type;
  bool global = false;
  bool constant = false;
};
template <class T>
struct Describe {
  static ArgumentType get() { return {type_name<T>(), false, false}; }
};
template <class T>
struct Describe<In<T>> {
  static ArgumentType get() { return {std::string(type_name<T>()) + "*", true, true}; }
};
template <class T>
struct Describe<Out<T>> {
  static ArgumentType get() { return {std::string(type_name<T>()) + "*", true, false}; }
};

/// What a driver reports of a kernel argument. An empty type was not reported.
struct ReportedArgument {
  std::string name, type;
  bool global = false, constant = false;
};

/// Normalises the spelling of a type: "const unsigned int *" and "uint*" become "uint*", "struct FilterArguments"
/// becomes "FilterArguments".
std::string canonical_type(const std::string& spelling);

/// The difference between an argument and the type that the host passes; empty if they agree or the driver reports
/// none.
std::string argument_difference(const ReportedArgument& reported, const ArgumentType& expected);

/// The largest work-group of a kernel, and whether its source requires a size (reqd_work_group_size). Only kernels
/// without a required size can run in smaller groups.
struct GroupLimit {
  std::size_t items = 1;
  bool required = true;
};

/// \throws DeviceError if the query fails
GroupLimit group_limit(const cl::Kernel& kernel, const std::string& name, const Context& context);

/// Differences between a kernel and its host signature, one sentence each with kernel and argument.
std::vector<std::string> kernel_faults(const cl::Kernel& kernel, const std::string& name,
                                       const std::vector<ArgumentType>& expected);

/// \throws DeviceError if the kernel needs more local memory than the device has, or the query fails
void check_local_memory(const cl::Kernel& kernel, const std::string& name, const Context& context);

/// Global and local size of a launch; the global size is rounded up to whole work-groups.
struct Range {
  std::size_t x = 1, y = 1;
  std::size_t local_x = 1, local_y = 1;
  Range(std::size_t items, std::size_t local) : x(items), local_x(local) {}
  Range(std::size_t items_x, std::size_t items_y, std::size_t group_x, std::size_t group_y)
      : x(items_x), y(items_y), local_x(group_x), local_y(group_y) {}
};

/// How the host passes a parameter of a kernel: buffers for pointers, anything else by value.
template <class T>
struct Passed {
  using Type = T;
};
template <class T>
struct Passed<const T*> {
  using Type = In<T>;
};
template <class T>
struct Passed<T*> {
  using Type = Out<T>;
};

/// A kernel with the C++ form of its declaration: Kernel<void(cl_int count, const cl_float* in, cl_float* out)>.
/// Parameters are pointers to global memory, numbers, and structures that type_name() knows.
template <class Signature>
class Kernel;
template <class... Parameters>
class Kernel<void(Parameters...)> {
 public:
  Kernel() = default;
  Kernel(Context& context, const cl::Program& program, const std::string& name) : context_(&context), name_(name) {
    try {
      kernel_ = cl::Kernel(program, name.c_str());
    } catch (const cl::Error& error) {
      throw_device_error("creating kernel " + name, error.err(), context.name());
    }
    check_local_memory(kernel_, name, context);
    group_ = group_limit(kernel_, name, context);
    if (context.checks_kernels())
      context.add_kernel_faults(kernel_faults(kernel_, name, {Describe<typename Passed<Parameters>::Type>::get()...}));
  }

  /// Enqueues the kernel; an empty range enqueues nothing. If the device cannot run groups of this size and the source
  /// requires none, the groups become smaller. \throws DeviceError with kernel, sizes and device
  void operator()(Range range, typename Passed<Parameters>::Type... args) const {
    if (range.x == 0 || range.y == 0) return;
    while (!group_.required && range.local_x > 1 && range.local_x * range.local_y > group_.items)
      range.local_x = (range.local_x + 1) / 2;
    const std::size_t global_x = (range.x + range.local_x - 1) / range.local_x * range.local_x;
    const std::size_t global_y = (range.y + range.local_y - 1) / range.local_y * range.local_y;
    try {
      if (range.local_x * range.local_y > group_.items) throw cl::Error(CL_INVALID_WORK_GROUP_SIZE);
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
  GroupLimit group_;
};

}  // namespace quadedge::opencl
