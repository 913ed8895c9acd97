#pragma once
/// \file context.hpp  An OpenCL device with its in-order queue, built programs and counters.

#include <CL/opencl.hpp>
#include <atomic>
#include <cstddef>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "device/program_cache.hpp"
#include "device/status.hpp"
#include "quadedge/device.hpp"

namespace quadedge::opencl {

/// Compile-time parameters of a program, in a fixed order.
using Defines = std::map<std::string, std::string>;

/// Device time of a stage between two calls of Context::take_profile() [ms].
struct StageProfile {
  std::string stage;
  double kernel_ms = 0;    ///< execution of kernels
  double transfer_ms = 0;  ///< copies to, from and on the device
  double queue_ms = 0;     ///< idle time while a command of the stage was waiting: launch overhead of the driver
  double launches = 0;     ///< number of kernel launches; fractional in means

  double wall_ms() const { return kernel_ms + transfer_ms + queue_ms; }
};

/// Restricts a device, for tests and for lists of programs. Unset members keep the value of the device.
struct DeviceLimits {
  std::optional<std::string> type;         ///< cpu | gpu | accelerator
  std::optional<std::size_t> group_items;  ///< maximum number of work-items of a work-group
  /// Local memory of a work-group [bytes]; 0: local memory is emulated in global memory.
  std::optional<std::size_t> local_bytes;
  std::optional<std::size_t> memory_bytes;
  std::optional<bool> stores_bytes;       ///< cl_khr_byte_addressable_store
  std::optional<bool> exact_divide_sqrt;  ///< CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT
  std::optional<std::size_t> launches;    ///< kernel launches that succeed before the device is lost
};

/// Limits of the device that launches, arrays and build options respect.
struct Limits {
  std::size_t group_items = 0, local_bytes = 0, memory_bytes = 0;
  std::size_t compute_units = 1, region_alignment = 1;
  bool exact_divide_sqrt = false;  ///< kernels are built with correctly rounded division and square root
  std::optional<std::size_t> launches;
};

/// Owns context, queue and programs. Not copyable; must outlive all buffers and kernels made from it.
class Context {
 public:
  /// \throws DeviceError if the device cannot store single bytes
  Context(cl::Device device, const DeviceOptions& options, const DeviceLimits& limits);
  ~Context() { finish_copies(); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const cl::Context& context() const { return context_; }
  const cl::Device& device() const { return device_; }
  /// \throws DeviceError in a child process, where the queue's threads do not exist.
  const cl::CommandQueue& queue() const {
    require_not_forked();
    return queue_;
  }
  const std::string& name() const { return name_; }
  /// See Device::use().
  std::recursive_mutex& in_use() { return in_use_; }
  /// Alignment of regions within a buffer [bytes].
  std::size_t region_alignment() const { return limits_.region_alignment; }
  /// True if the variants for CPUs are the default.
  bool is_cpu() const { return is_cpu_; }
  const Limits& limits() const { return limits_; }
  bool profiling() const { return profiling_; }

  /// Returns the program made of common.cl, layouts.cl and `files`, in that order. It is built once per context and set
  /// of defines, or loaded from the program cache or the driver's own.
  /// \throws DeviceError with device, options and compiler log, which names kernel file and line
  cl::Program program(const std::vector<std::string>& files, const Defines& defines);

  /// All programs built so far: options, then kernel files without common.cl, separated by spaces.
  std::vector<std::string> programs() const;

  /// Time spent on building and loading programs so far [ms].
  double build_ms() const { return build_ms_; }

  /// Options that every program is built with, before its defines.
  const std::string& build_options() const { return build_options_; }

  /// Turns the comparison of new kernels with their host signatures on or off. Only tests and the self-test use it,
  /// since drivers may spell types in unexpected ways.
  void check_kernels(bool checks) { checks_kernels_ = checks; }
  bool checks_kernels() const { return checks_kernels_; }
  /// Differences found so far, one sentence each.
  const std::vector<std::string>& kernel_faults() const { return kernel_faults_; }
  void add_kernel_faults(const std::vector<std::string>& faults) {
    kernel_faults_.insert(kernel_faults_.end(), faults.begin(), faults.end());
  }

  /// Waits until all enqueued commands are complete.
  void finish();
  /// Submits all enqueued commands, so that the device starts while the host continues.
  void flush();

  /// To be called after a non-blocking copy that uses host memory was enqueued.
  void copy_started() { copies_in_flight_ = true; }
  /// To be called after the host has waited for all commands enqueued before.
  void copies_done() { copies_in_flight_ = false; }
  /// Waits for copies that still use host memory. For destructors: ignores errors, which other calls report.
  void finish_copies() noexcept;

  /// Bytes allocated by buffers, now and at the peak.
  std::size_t bytes() const { return bytes_; }
  std::size_t peak_bytes() const { return peak_bytes_; }
  void account(std::ptrdiff_t bytes);

  /// Counts since construction: kernel launches, copies to the device and their bytes, bytes copied to the host, and
  /// waits of the host for the queue.
  struct Traffic {
    std::size_t launches = 0, writes = 0, to_device = 0, to_host = 0, waits = 0;
  };
  const Traffic& traffic() const { return traffic_; }
  /// \throws cl::Error if DeviceLimits::launches is exceeded
  void count_launch() {
    if (limits_.launches && traffic_.launches >= *limits_.launches) throw cl::Error(CL_OUT_OF_RESOURCES);
    ++traffic_.launches;
  }
  void count_to_device(std::size_t bytes) {
    ++traffic_.writes;
    traffic_.to_device += bytes;
  }
  void count_to_host(std::size_t bytes) { traffic_.to_host += bytes; }
  void count_wait() { ++traffic_.waits; }

  /// Sets the stage that the following commands are profiled under.
  void begin_stage(const std::string& stage) { stage_ = stage; }
  const std::string& stage() const { return stage_; }
  enum class Command { kernel, transfer };
  /// The event for the next command; null without profiling.
  cl::Event* watch(Command kind);
  /// Times of the commands since the last call, by stage in order of first appearance; waits for the queue.
  std::vector<StageProfile> take_profile();
  /// The last result of take_profile().
  const std::vector<StageProfile>& last_profile() const { return last_profile_; }

 private:
  void take_limits(const DeviceLimits& wished);
  std::string kernel_text(const std::string& file) const;
  /// Compiles a program. \param what  its name in messages
  cl::Program build(const std::string& source, const std::string& options, const std::string& what) const;
  /// A cached program that the driver accepts.
  std::optional<cl::Program> find_kept(const std::string& key, const std::string& options) const;

  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::string name_;
  std::string driver_;  ///< platform, device and their versions; part of the cache key
  std::string kernel_folder_;
  ProgramCache cache_;
  Limits limits_;
  std::string build_options_;
  bool keeps_binaries_ = false;
  bool checks_kernels_ = false;
  std::vector<std::string> kernel_faults_;
  bool copies_in_flight_ = false;
  bool profiling_ = false;
  bool is_cpu_ = false;
  double build_ms_ = 0;
  std::map<std::string, cl::Program> programs_;
  std::recursive_mutex in_use_;
  std::atomic<std::size_t> bytes_ = 0, peak_bytes_ = 0;  ///< atomic, as objects are destroyed in any thread
  Traffic traffic_;
  std::string stage_ = "other";
  struct Watched {
    std::string stage;
    Command kind = Command::kernel;
    cl::Event event;
  };
  std::deque<Watched> watched_;  ///< in queue order; a deque, since pointers to events must stay valid
  std::vector<StageProfile> last_profile_;
};

/// Waits at the end of a scope for copies that still use host memory, which happens if an exception is thrown before
/// the regular wait. Declare it after the memory that it protects.
class CopyGuard {
 public:
  explicit CopyGuard(Context& context) : context_(context) {}
  ~CopyGuard() { context_.finish_copies(); }
  CopyGuard(const CopyGuard&) = delete;
  CopyGuard& operator=(const CopyGuard&) = delete;

 private:
  Context& context_;
};

}  // namespace quadedge::opencl
