#pragma once
/// \file context.hpp  One OpenCL device with its in-order queue, its built programs and its bookkeeping.

#include <CL/opencl.hpp>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace quadedge::opencl {

/// Compile-time parameters of a program, in a fixed order.
using Defines = std::map<std::string, std::string>;

/// Owns context, queue and programs. Not copyable; everything made from it must die before it.
class Context {
 public:
  /// `kernel_folder`: when not empty, kernel files are read from there instead of the embedded ones.
  Context(cl::Device device, std::string kernel_folder, bool profiling);
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const cl::Context& context() const { return context_; }
  const cl::Device& device() const { return device_; }
  const cl::CommandQueue& queue() const { return queue_; }
  const std::string& name() const { return name_; }
  bool is_cpu() const { return is_cpu_; }
  bool profiling() const { return profiling_; }

  /// Builds (once per process and set of parameters) the program made of common.cl, layouts.cl and `files`, in that
  /// order.
  /// \throws DeviceError with device, options and compiler log; the log names kernel file and line.
  cl::Program program(const std::vector<std::string>& files, const Defines& defines);

  /// Every program built so far: its options, then its kernel files without common.cl, separated by spaces.
  std::vector<std::string> programs() const;

  /// Time spent in program builds so far [ms].
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

  /// The stage that the following launches belong to (profiling).
  void begin_stage(const std::string& stage) { stage_ = stage; }
  void record(const cl::Event& event);
  /// Milliseconds of kernel time (START to END) per stage since the last call, in order of first launch; waits for the
  /// queue.
  std::vector<std::pair<std::string, double>> take_profile();

 private:
  std::string kernel_text(const std::string& file) const;

  cl::Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  std::string name_;
  std::string kernel_folder_;
  bool profiling_ = false;
  bool is_cpu_ = false;
  double build_ms_ = 0;
  std::map<std::string, cl::Program> programs_;
  std::size_t bytes_ = 0, peak_bytes_ = 0;
  Traffic traffic_;
  std::string stage_ = "other";
  std::vector<std::pair<std::string, cl::Event>> events_;
};

}  // namespace quadedge::opencl
