#include "cli/saved_variants.hpp"

#include "benchmark/variants_file.hpp"
#include "data/user_folder.hpp"

namespace quadedge::cli {

std::string saved_variants_path(const DeviceInfo& device) {
  const std::string folder = data::configuration_folder();
  return folder.empty() ? folder : folder + "/" + bench::variants_file_name(device);
}

void add_saved_variants(const Device& device, Config& config) {
  if (device.is_reference()) return;
  const std::string path = saved_variants_path(device.info());
  if (path.empty()) return;
  const auto saved = bench::read_variants_file(path, device.info());
  config.variants.insert(saved.begin(), saved.end());  // what is there already stays
}

}  // namespace quadedge::cli
