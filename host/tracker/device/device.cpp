/// \file device.cpp  Listing and choosing devices (include/quadedge/device.hpp).
#include "quadedge/device.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>

#include "device/context.hpp"
#include "device/oracle.hpp"
#include "device/status.hpp"

namespace quadedge {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVendors = "/etc/OpenCL/vendors";

std::string value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

/// A fault of a driver's library that `from` names.
std::string library_fault(const std::string& from, const std::string& library) {
  if (dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL) != nullptr) return {};
  const char* reason = dlerror();
  return from + " names a driver that cannot be loaded (" + (reason == nullptr ? library : reason) + ")\n";
}

/// A fault of an .icd file, whose first line names a library.
std::string icd_fault(const std::string& from, const fs::path& file) {
  std::ifstream stream(file);
  std::string library;
  if (!std::getline(stream, library)) return from + file.string() + " is empty or cannot be read\n";
  library.erase(library.find_last_not_of(" \t\r") + 1);
  return library_fault(from + file.string(), library);
}

/// Faults of a folder of .icd files, of one such file, or of a library.
std::string place_faults(const std::string& from, const fs::path& place) {
  std::error_code ignored;
  if (!fs::is_directory(place, ignored)) {
    if (place.extension() != ".icd") return library_fault(from, place.string());
    const fs::path file = place.is_absolute() || fs::exists(place, ignored) ? place : fs::path(kVendors) / place;
    return fs::exists(file, ignored) ? icd_fault(from + " names ", file)
                                     : from + " names " + place.string() + ", which does not exist\n";
  }
  std::string faults;
  bool has_any = false;
  for (const auto& entry : fs::directory_iterator(place, ignored)) {
    if (entry.path().extension() != ".icd") continue;
    has_any = true;
    faults += icd_fault("", entry.path());
  }
  return has_any ? faults : from + " names the folder " + place.string() + ", which holds no .icd file\n";
}

/// Sentences about environment variables (OCL_ICD_VENDORS, OCL_ICD_FILENAMES) and .icd files that name what does not
/// exist or cannot be loaded; empty if there is none. For messages only: it loads the drivers.
std::string loader_faults() {
  std::string faults;
  const std::string vendors = value_of("OCL_ICD_VENDORS");
  if (!vendors.empty()) {
    faults = place_faults("OCL_ICD_VENDORS=" + vendors, vendors);
  } else if (std::error_code ignored; fs::is_directory(kVendors, ignored)) {
    faults = place_faults(kVendors, kVendors);
  }
  std::istringstream libraries(value_of("OCL_ICD_FILENAMES"));
  for (std::string library; std::getline(libraries, library, ':');)
    if (!library.empty()) faults += place_faults("OCL_ICD_FILENAMES", library);
  return faults;
}

struct FoundDevice {
  DeviceInfo info;
  cl::Device device;
};

std::string type_name(cl_device_type type) {
  if (type & CL_DEVICE_TYPE_GPU) return "gpu";
  if (type & CL_DEVICE_TYPE_CPU) return "cpu";
  return "accelerator";
}

FloatSupport float_support(const cl::Device& device) {
  const cl_device_fp_config config = device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>();
  FloatSupport support;
  support.fma = (config & CL_FP_FMA) != 0;
  support.denormals = (config & CL_FP_DENORM) != 0;
  support.rounds_to_nearest = (config & CL_FP_ROUND_TO_NEAREST) != 0;
  support.rounds_to_zero = (config & CL_FP_ROUND_TO_ZERO) != 0;
  support.rounds_to_infinity = (config & CL_FP_ROUND_TO_INF) != 0;
  support.exact_divide_sqrt = (config & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) != 0;
  return support;
}

/// Serialised: while one thread initialises PoCL (pocl_init_devices), clGetDeviceIDs returns at once in other threads,
/// with no devices or with half-initialised ones.
std::vector<FoundDevice> find_devices() {
  opencl::require_not_forked();
  static std::mutex discovery;
  const std::lock_guard<std::mutex> lock(discovery);
  opencl::watch_for_forks();
  std::vector<FoundDevice> found;
  std::vector<cl::Platform> platforms;
  try {
    cl::Platform::get(&platforms);
  } catch (const cl::Error&) {
    return found;  // the loader reports a missing driver as an error
  }
  for (const auto& platform : platforms) {
    std::vector<cl::Device> devices;
    try {
      platform.getDevices(CL_DEVICE_TYPE_ALL, &devices);
    } catch (const cl::Error&) {
      continue;  // a platform without devices
    }
    for (const auto& device : devices) {
      try {
        DeviceInfo info;
        info.index = static_cast<int>(found.size());
        info.platform = platform.getInfo<CL_PLATFORM_NAME>();
        info.name = device.getInfo<CL_DEVICE_NAME>();
        info.driver = device.getInfo<CL_DRIVER_VERSION>();
        info.opencl = device.getInfo<CL_DEVICE_VERSION>();
        info.type = type_name(device.getInfo<CL_DEVICE_TYPE>());
        info.compute_units = device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
        info.memory_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
        info.single_precision = float_support(device);
        found.push_back({info, device});
      } catch (const cl::Error&) {
        continue;  // a device that cannot be queried cannot be used
      }
    }
  }
  return found;
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::optional<std::size_t> first_of_type(const std::vector<FoundDevice>& devices, const std::string& type) {
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (devices[i].info.type == type) return i;
  return std::nullopt;
}

std::optional<std::size_t> choose(const std::vector<FoundDevice>& devices, const std::string& choice) {
  if (devices.empty()) return std::nullopt;
  if (choice == "auto") {
    std::vector<DeviceInfo> infos;
    for (const auto& device : devices) infos.push_back(device.info);
    return static_cast<std::size_t>(by_preference(infos).front().index);
  }
  if (choice == "cpu" || choice == "gpu") return first_of_type(devices, choice);
  if (!choice.empty() && std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c); })) {
    const unsigned long index = choice.size() > 6 ? devices.size() : std::stoul(choice);
    return index < devices.size() ? std::optional<std::size_t>(index) : std::nullopt;
  }
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string text = lower(devices[i].info.platform + " " + devices[i].info.name);
    if (text.find(lower(choice)) != std::string::npos) return i;
  }
  return std::nullopt;
}

std::string no_match_message(const std::vector<FoundDevice>& devices, const std::string& choice) {
  if (devices.empty()) {
    const std::string faults = loader_faults();
    return "no OpenCL device was found: "
           "`pip install intel-opencl-rt intel-cmplr-lib-rt` beside the Python package (x86-64) or, on Debian, "
           "`apt-get install pocl-opencl-icd ocl-icd-libopencl1` installs one for CPUs, a GPU needs its vendor's "
           "driver, and "
           "`--device reference` (device=\"reference\" in Python) runs without OpenCL, slowly. PoCL has no devices "
           "where it cannot write to its cache: set POCL_CACHE_DIR to a writable folder (default: $XDG_CACHE_HOME or "
           "~/.cache, pocl/kcache)" +
           (faults.empty() ? "" : "\nWhat the loader found: " + faults);
  }
  std::string message = "no OpenCL device matches '" + choice + "'; there are:";
  for (const auto& device : devices) {
    message += "\n  " + std::to_string(device.info.index) + ": " + device.info.type + ", " + device.info.name + " (" +
               device.info.platform + ")";
  }
  return message;
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> infos;
  for (const auto& device : find_devices()) infos.push_back(device.info);
  return infos;
}

std::vector<DeviceInfo> by_preference(std::vector<DeviceInfo> devices) {
  const auto rank = [](const DeviceInfo& device) { return device.type == "gpu" ? 0 : device.type == "cpu" ? 1 : 2; };
  std::stable_sort(devices.begin(), devices.end(),
                   [&](const DeviceInfo& a, const DeviceInfo& b) { return rank(a) < rank(b); });
  return devices;
}

namespace {
std::optional<Oracle>& oracle() {
  static std::optional<Oracle> registered;
  return registered;
}
}  // namespace

const Oracle* registered_oracle() { return oracle() ? &*oracle() : nullptr; }
void register_oracle(const Oracle& registered) { oracle() = registered; }

Device::Device(const std::string& choice, const DeviceOptions& options) : Device(choice, options, {}) {}

Device::Device(const std::string& choice, const DeviceOptions& options, const opencl::DeviceLimits& limits) {
  if (choice == "reference") {
    if (registered_oracle() == nullptr)
      throw DeviceError(
          "the device 'reference' is part of the library quadedge: link quadedge::quadedge instead of "
          "quadedge::quadedge_core");
    info_ = registered_oracle()->info;
    return;
  }
  const auto devices = find_devices();
  const auto chosen = choose(devices, choice);
  if (!chosen) throw DeviceError(no_match_message(devices, choice));
  info_ = devices[*chosen].info;
  context_ = std::make_unique<opencl::Context>(devices[*chosen].device, options, limits);
  if (limits.type) info_.type = *limits.type;
  info_.memory_bytes = context_->limits().memory_bytes;
  info_.single_precision.exact_divide_sqrt = context_->limits().exact_divide_sqrt;
}

Device opencl::open_limited(const std::string& choice, const DeviceOptions& options, const DeviceLimits& limits) {
  return Device(choice, options, limits);
}

std::unique_lock<std::recursive_mutex> Device::use() const {
  return context_ == nullptr ? std::unique_lock<std::recursive_mutex>() : std::unique_lock(context_->in_use());
}

Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;

}  // namespace quadedge
