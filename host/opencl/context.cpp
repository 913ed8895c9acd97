#include "opencl/context.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>

#include "opencl/error.hpp"
#include "opencl/kernel_sources.hpp"

namespace quadedge::opencl {

Context::Context(cl::Device device, std::string kernel_folder, bool profiling)
    : device_(std::move(device)), kernel_folder_(std::move(kernel_folder)), profiling_(profiling) {
  try {
    name_ = device_.getInfo<CL_DEVICE_NAME>();
    is_cpu_ = (device_.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
    context_ = cl::Context(device_);
    queue_ =
        cl::CommandQueue(context_, device_, profiling ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0});
  } catch (const cl::Error& error) {
    throw_device_error(std::string("opening the device (") + error.what() + ")", error.err(), name_);
  }
}

std::string Context::kernel_text(const std::string& file) const {
  if (kernel_folder_.empty()) {
    const auto found = embedded_kernels().find(file);
    if (found == embedded_kernels().end())
      throw DeviceError("kernel file " + file + " is not embedded in this program");
    return found->second;
  }
  const std::string path = kernel_folder_ + "/" + file;
  std::ifstream stream(path);
  if (!stream)
    throw DataError(path + ": kernel file cannot be read; --kernels expects a folder that holds every kernel file");
  std::ostringstream text;
  text << "#line 1 \"" << file << "\"\n" << stream.rdbuf();
  return text.str();
}

cl::Program Context::program(const std::vector<std::string>& files, const Defines& defines) {
  std::string options = "-cl-std=CL1.2 -cl-kernel-arg-info";
  for (const auto& [key, value] : defines) options += " -D" + key + "=" + value;
  std::string key = options;
  for (const auto& file : files) key += " " + file;
  const auto known = programs_.find(key);
  if (known != programs_.end()) return known->second;

  std::string source = kernel_text("common.cl") + "\n" + kernel_text("layouts.cl");
  for (const auto& file : files) source += "\n" + kernel_text(file);
  const auto start = std::chrono::steady_clock::now();
  cl::Program program(context_, source);
  try {
    program.build({device_}, options.c_str());
  } catch (const cl::Error& error) {
    std::string log;
    try {
      log = program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device_);
    } catch (const cl::Error&) {
      log = "(the driver gives no log)";
    }
    throw DeviceError("building the kernels of " + (files.empty() ? std::string("common.cl") : files.back()) +
                      " failed: " + status_name(error.err()) + " on " + name_ + "\noptions: " + options + "\n" + log);
  }
  build_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  programs_.emplace(key, program);
  return program;
}

std::vector<std::string> Context::programs() const {
  std::vector<std::string> built;
  for (const auto& [key, program] : programs_) built.push_back(key);
  return built;
}

void Context::finish() {
  try {
    queue_.finish();
  } catch (const cl::Error& error) {
    throw_device_error("waiting for the device", error.err(), name_);
  }
}

void Context::account(std::ptrdiff_t bytes) {
  bytes_ = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(bytes_) + bytes);
  peak_bytes_ = std::max(peak_bytes_, bytes_);
}

void Context::record(const cl::Event& event) { events_.emplace_back(stage_, event); }

std::vector<std::pair<std::string, double>> Context::take_profile() {
  finish();
  std::vector<std::pair<std::string, double>> stages;
  for (const auto& [stage, event] : events_) {
    const auto nanoseconds =
        event.getProfilingInfo<CL_PROFILING_COMMAND_END>() - event.getProfilingInfo<CL_PROFILING_COMMAND_START>();
    const auto found =
        std::find_if(stages.begin(), stages.end(), [&name = stage](const auto& row) { return row.first == name; });
    if (found == stages.end()) {
      stages.emplace_back(stage, static_cast<double>(nanoseconds) * 1e-6);
    } else {
      found->second += static_cast<double>(nanoseconds) * 1e-6;
    }
  }
  events_.clear();
  return stages;
}

}  // namespace quadedge::opencl
