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

/// What the kernels' launches and arrays have to keep to.
struct Limits {
  std::size_t group_items = 0, local_bytes = 0, memory_bytes = 0;
};

/// Owns context, queue and programs. Not copyable; everything made from it must die before it.
class Context {
 public:
  /// \throws DeviceError for a device that cannot store bytes.
  Context(cl::Device device, const DeviceOptions& options);
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

  /// Waits until everything enqueued is done.
  void finish();

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
  void count_launch() { ++traffic_.launches; }
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

}  // namespace quadedge::opencl
