#include "cli/saved_variants.hpp"

#include <cstdlib>

#include "benchmark/variants_file.hpp"

namespace quadedge::cli {

std::string saved_variants_path(const DeviceInfo& device) {
  const char* configuration = std::getenv("XDG_CONFIG_HOME");
  const char* home = std::getenv("HOME");
  std::string folder;
  if (configuration != nullptr && configuration[0] == '/') {  // the specification wants relative ones ignored
    folder = configuration;
  } else if (home != nullptr && home[0] != '\0') {
    folder = std::string(home) + "/.config";
  } else {
    return {};
  }
  return folder + "/quadedge/" + bench::variants_file_name(device);
}

void add_saved_variants(const Device& device, Config& config) {
  if (device.is_reference()) return;
  const std::string path = saved_variants_path(device.info());
  if (path.empty()) return;
  const auto saved = bench::read_variants_file(path, device.info());
  config.variants.insert(saved.begin(), saved.end());  // what is there already stays
}

}  // namespace quadedge::cli
