#pragma once
/// \file context.hpp  One OpenCL device with its in-order queue, its built programs and its bookkeeping.

#include <CL/opencl.hpp>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "opencl/fork_guard.hpp"
#include "opencl/program_cache.hpp"
#include "quadedge/device.hpp"

namespace quadedge::opencl {

/// Compile-time parameters of a program, in a fixed order.
using Defines = std::map<std::string, std::string>;

/// What the device spent on a stage between two calls of Context::take_profile() [ms]. A device that is busy with one
/// command after the other spends nothing on waits.
struct StageProfile {
  std::string stage;
  double kernel_ms = 0;    ///< running kernels
  double transfer_ms = 0;  ///< copying to, from and on the device
  double queue_ms = 0;     ///< idle although a command of the stage was enqueued: what the driver takes to start it
  double launches = 0;     ///< kernels; a fraction in a mean

  double wall_ms() const { return kernel_ms + transfer_ms + queue_ms; }
};

/// Limits of the device that launches, arrays and build options respect.
struct Limits {
  std::size_t group_items = 0, local_bytes = 0, memory_bytes = 0;
  std::size_t compute_units = 1, region_alignment = 1;
  bool exact_divide_sqrt = false;  ///< kernels are built with correctly rounded division and square root
  std::optional<std::size_t> launches;
};

/// Owns context, queue and programs. Not copyable; everything made from it must die before it.
class Context {
 public:
  /// \throws DeviceError for a device that cannot store bytes.
  Context(cl::Device device, const DeviceOptions& options);
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
  /// Bytes that the start of a region within a buffer is a multiple of.
  std::size_t region_alignment() const { return limits_.region_alignment; }
  /// Whether kernels are chosen as for a CPU.
  bool is_cpu() const { return is_cpu_; }
  const Limits& limits() const { return limits_; }
  bool profiling() const { return profiling_; }

  /// Builds (once per context and set of parameters) the program made of common.cl, layouts.cl and `files`, in that
  /// order, or takes it from the folder of kept programs.
  /// \throws DeviceError with device, options and compiler log; the log names kernel file and line.
  cl::Program program(const std::vector<std::string>& files, const Defines& defines);

  /// Every program built so far: its options, then its kernel files without common.cl, separated by spaces.
  std::vector<std::string> programs() const;

  /// Time spent on building and loading programs so far [ms].
  double build_ms() const { return build_ms_; }

  /// Options that every program is built with, before its defines.
  const std::string& build_options() const { return build_options_; }

  /// From now on kernels are compared with their host signatures when they are created. For tests and the self-test:
  /// drivers may spell types in ways that nobody foresaw, so that a difference alone does not end a run.
  void check_kernels(bool checks) { checks_kernels_ = checks; }
  bool checks_kernels() const { return checks_kernels_; }
  /// What check_kernels() has found, one sentence per fault.
  const std::vector<std::string>& kernel_faults() const { return kernel_faults_; }
  void add_kernel_faults(const std::vector<std::string>& faults) {
    kernel_faults_.insert(kernel_faults_.end(), faults.begin(), faults.end());
  }

  /// Waits until everything enqueued is done.
  void finish();
  /// Submits everything enqueued so far, so that the device starts while the host goes on.
  void flush();

  /// A copy that uses host memory was enqueued without waiting for it.
  void copy_started() { copies_in_flight_ = true; }
  /// The host has waited for everything enqueued before.
  void copies_done() { copies_in_flight_ = false; }
  /// Waits for copies that still use host memory. Destructors of that memory's owners call it; a device that fails by
  /// then has reported its fault already.
  void finish_copies() noexcept;

  /// Bytes held by buffers now and at most.
  std::size_t bytes() const { return bytes_; }
  std::size_t peak_bytes() const { return peak_bytes_; }
  void account(std::ptrdiff_t bytes);

  /// What went over the queue so far: kernels launched, copies to the device and their bytes, bytes copied to the host,
  /// and how often the host waited for the queue.
  struct Traffic {
    std::size_t launches = 0, writes = 0, to_device = 0, to_host = 0, waits = 0;
  };
  const Traffic& traffic() const { return traffic_; }
  /// \throws cl::Error where DeviceLimits::launches is used up.
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

  /// The stage that profiling books the following commands under.
  void begin_stage(const std::string& stage) { stage_ = stage; }
  const std::string& stage() const { return stage_; }
  enum class Command { kernel, transfer };
  /// The event of the command that is enqueued next; null where nothing is profiled.
  cl::Event* watch(Command kind);
  /// What the commands since the last call took, by stage in order of first appearance, from the events' times; waits
  /// for the queue.
  std::vector<StageProfile> take_profile();
  /// What take_profile() returned last.
  const std::vector<StageProfile>& last_profile() const { return last_profile_; }

 private:
  void take_limits(const DeviceLimits& wished);
  std::string kernel_text(const std::string& file) const;
  /// Compiles. \param what  the program's name in messages
  cl::Program build(const std::string& source, const std::string& options, const std::string& what) const;
  /// A kept program that the driver takes.
  std::optional<cl::Program> find_kept(const std::string& key, const std::string& options) const;

  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::string name_;
  std::string driver_;  ///< platform, device and versions of both: whose programs are alike
  std::string kernel_folder_;
  ProgramCache cache_;
  Limits limits_;
  std::string build_options_;
  bool checks_kernels_ = false;
  std::vector<std::string> kernel_faults_;
  bool copies_in_flight_ = false;
  bool profiling_ = false;
  bool is_cpu_ = false;
  double build_ms_ = 0;
  std::map<std::string, cl::Program> programs_;
  std::size_t bytes_ = 0, peak_bytes_ = 0;
  Traffic traffic_;
  std::string stage_ = "other";
  struct Watched {
    std::string stage;
    Command kind = Command::kernel;
    cl::Event event;
  };
  std::deque<Watched> watched_;  ///< in the order of the queue; events stay where they are
  std::vector<StageProfile> last_profile_;
};

/// Waits at the end of a block for copies that still use host memory, as they do when an exception is thrown before the
/// block's own wait. Declare it after the memory that it protects.
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
