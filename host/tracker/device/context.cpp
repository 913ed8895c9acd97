/// \file context.cpp  Reads the device's limits, builds programs or loads cached binaries, sums up profiling events.
#include "device/context.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <locale>
#include <sstream>

#include "device/kernel_sources.hpp"
#include "device/status.hpp"

namespace quadedge::opencl {

Context::Context(cl::Device device, const DeviceOptions& options, const DeviceLimits& limits)
    : device_(std::move(device)),
      kernel_folder_(options.kernel_folder),
      cache_(options.program_folder),
      profiling_(options.profiling) {
  try {
    name_ = device_.getInfo<CL_DEVICE_NAME>();
    const cl::Platform platform(device_.getInfo<CL_DEVICE_PLATFORM>());
    driver_ = platform.getInfo<CL_PLATFORM_NAME>() + "\n" + platform.getInfo<CL_PLATFORM_VERSION>() + "\n" + name_ +
              "\n" + device_.getInfo<CL_DEVICE_VERSION>() + "\n" + device_.getInfo<CL_DRIVER_VERSION>() + "\n";
    // PoCL has a cache of its own, and for a binary compiles every kernel once more, for groups of any size.
    keeps_binaries_ = !options.program_folder.empty() && driver_.rfind("Portable Computing Language", 0) != 0;
    take_limits(limits);
    context_ = cl::Context(device_);
    queue_ =
        cl::CommandQueue(context_, device_, profiling_ ? CL_QUEUE_PROFILING_ENABLE : cl_command_queue_properties{0});
  } catch (const cl::Error& error) {
    throw_device_error(std::string("opening the device (") + error.what() + ")", error.err(), name_);
  }
}

void Context::take_limits(const DeviceLimits& wished) {
  const bool cpu = (device_.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU) != 0;
  is_cpu_ = wished.type ? *wished.type == "cpu" : cpu;
  constexpr const char* kByteStores = "cl_khr_byte_addressable_store";
  const bool stores = device_.getInfo<CL_DEVICE_EXTENSIONS>().find(kByteStores) != std::string::npos;
  if (!wished.stores_bytes.value_or(stores)) {
    throw DeviceError(name_ + " lacks " + kByteStores + ": its kernels cannot store single bytes, which every OpenCL " +
                      "1.2 device of the full profile can and QuadEdge needs. Expected another device (`quadedge "
                      "devices`)");
  }
  const bool has_local = cpu || device_.getInfo<CL_DEVICE_LOCAL_MEM_TYPE>() == CL_LOCAL;
  limits_.group_items = wished.group_items.value_or(device_.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
  limits_.local_bytes = wished.local_bytes.value_or(has_local ? device_.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>() : 0);
  limits_.memory_bytes = wished.memory_bytes.value_or(device_.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>());
  limits_.compute_units = device_.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
  limits_.region_alignment = std::max<std::size_t>(device_.getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>() / 8, 1);
  limits_.launches = wished.launches;
  const auto single = device_.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  limits_.exact_divide_sqrt = wished.exact_divide_sqrt.value_or((single & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0);
  build_options_ =
      "-cl-std=CL1.2 -cl-kernel-arg-info -w";  // a compiler's warnings are for developers: the lint shows them
  if (limits_.exact_divide_sqrt) build_options_ += " -cl-fp32-correctly-rounded-divide-sqrt";
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
  text.imbue(std::locale::classic());
  text << "#line 1 \"" << file << "\"\n" << stream.rdbuf();
  return text.str();
}

/// NVIDIA's messages count lines from the first file on, whatever #line says: file and line of the first one.
static std::string place_of_error(const std::string& log, const std::string& source) {
  const std::string before = "<kernel>:", marker = "#line 1 \"";
  const std::size_t at = log.find(before);
  if (at == std::string::npos) return {};
  std::istringstream lines(source);
  std::string line, file;
  int in_file = 0;
  for (int left = std::atoi(log.c_str() + at + before.size()); left > 0 && std::getline(lines, line); --left, ++in_file)
    if (line.rfind(marker, 0) == 0) file = line.substr(marker.size(), line.size() - marker.size() - 1), in_file = -1;
  return file + ":" + std::to_string(in_file) + "\n";
}

cl::Program Context::build(const std::string& source, const std::string& options, const std::string& what) const {
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
    const bool is_error_of_source = log.find("error:") != std::string::npos;
    throw DeviceError("building the kernels of " + what + " failed: " + status_name(error.err()) + " on " + name_ +
                      (is_error_of_source ? "" : "; can the driver write its files? (disk space, `ulimit -f`)") +
                      "\noptions: " + options + "\n" + place_of_error(log, source) + log);
  }
  return program;
}

std::optional<cl::Program> Context::find_kept(const std::string& key, const std::string& options) const {
  const auto binary = cache_.find(key);
  if (!binary) return std::nullopt;
  try {
    cl::Program program(context_, {device_}, {*binary});
    program.build({device_}, options.c_str());
    return program;
  } catch (const cl::Error&) {
    return std::nullopt;  // made by another driver, or the driver accepts no binaries: build from source
  }
}

cl::Program Context::program(const std::vector<std::string>& files, const Defines& defines) {
  std::string options = build_options_;
  for (const auto& [key, value] : defines) options += " -D" + key + "=" + value;
  std::string key = options;
  for (const auto& file : files) key += " " + file;
  const auto known = programs_.find(key);
  if (known != programs_.end()) return known->second;

  std::string source = kernel_text("common.cl") + "\n" + kernel_text("layouts.cl");
  for (const auto& file : files) source += "\n" + kernel_text(file);
  const auto start = std::chrono::steady_clock::now();
  const std::string kept_as = driver_ + options + "\n" + source;
  std::optional<cl::Program> program;
  if (keeps_binaries_) program = find_kept(kept_as, options);
  if (!program) {
    program = build(source, options, files.empty() ? "common.cl" : files.back());
    if (keeps_binaries_) {
      const auto binaries = program->getInfo<CL_PROGRAM_BINARIES>();
      if (!binaries.empty() && !binaries.front().empty()) cache_.keep(kept_as, binaries.front());
    }
  }
  build_ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  programs_.emplace(key, *program);
  return *program;
}

std::vector<std::string> Context::programs() const {
  std::vector<std::string> built;
  for (const auto& [key, program] : programs_) built.push_back(key);
  return built;
}

void Context::finish() {
  count_wait();
  try {
    queue().finish();
  } catch (const cl::Error& error) {
    throw_device_error("waiting for the device", error.err(), name_);
  }
  copies_done();
}

void Context::flush() {
  try {
    queue_.flush();
  } catch (const cl::Error& error) {
    throw_device_error("submitting commands", error.err(), name_);
  }
}

void Context::finish_copies() noexcept {
  if (!copies_in_flight_) return;
  copies_done();
  try {
    queue().finish();
  } catch (const std::exception&) {
    return;  // the device is lost, or this is a forked process
  }
}

void Context::account(std::ptrdiff_t bytes) {
  const std::size_t now = bytes_ += static_cast<std::size_t>(bytes);  // a negative one wraps around to the difference
  for (std::size_t peak = peak_bytes_; now > peak && !peak_bytes_.compare_exchange_weak(peak, now);) {
  }
}

cl::Event* Context::watch(Command kind) {
  if (!profiling_) return nullptr;
  return &watched_.emplace_back(Watched{stage_, kind, cl::Event()}).event;
}

std::vector<StageProfile> Context::take_profile() {
  finish();
  constexpr double kMilliseconds = 1e-6;  // per nanosecond
  last_profile_.clear();
  cl_ulong idle_since = 0;
  for (const auto& [stage, kind, event] : watched_) {
    if (event() == nullptr) continue;  // it could not be enqueued
    const auto found = std::find_if(last_profile_.begin(), last_profile_.end(),
                                    [&name = stage](const StageProfile& row) { return row.stage == name; });
    StageProfile& row = found == last_profile_.end() ? last_profile_.emplace_back() : *found;
    row.stage = stage;
    const auto queued = event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>(),
               start = event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
               end = event.getProfilingInfo<CL_PROFILING_COMMAND_END>();
    const auto ready = std::max(queued, idle_since);
    if (start > ready) row.queue_ms += static_cast<double>(start - ready) * kMilliseconds;
    (kind == Command::kernel ? row.kernel_ms : row.transfer_ms) += static_cast<double>(end - start) * kMilliseconds;
    row.launches += kind == Command::kernel ? 1 : 0;
    idle_since = end;
  }
  watched_.clear();
  return last_profile_;
}

}  // namespace quadedge::opencl
