#include "opencl/loader_faults.hpp"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace quadedge::opencl {
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

}  // namespace

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

}  // namespace quadedge::opencl
