/// \file list_programs.cpp  Prints every program that the stages build, for lint_kernels.sh: options and kernel files,
/// one program per line. The list comes from the stages themselves, with every variant, so it is complete.
///   list_programs KERNEL_FOLDER

#include <cstdio>
#include <map>
#include <set>
#include <string>

#include "device/context.hpp"
#include "device/stage.hpp"
#include "device/variants.hpp"
#include "edges/frontend.hpp"
#include "quadedge/device.hpp"
#include "quadedge/synthetic.hpp"

namespace {

using namespace quadedge;

/// A configuration that uses every kernel.
Config every_stage() {
  Config config;
  config.stereo.max_disparity = 64;
  config.stereo.sift_max = 500;
  return config;
}

/// The same with variant number `wanted` of every stage that has that many.
Config config_with(std::size_t wanted) {
  Config config = every_stage();
  std::map<std::string, std::size_t> seen;
  for (const auto& variant : opencl::all_variants())
    if (seen[variant.stage]++ == wanted) config.variants[variant.stage] = variant.name;
  return config;
}

std::size_t most_variants() {
  std::map<std::string, std::size_t> counts;
  std::size_t most = 0;
  for (const auto& variant : opencl::all_variants()) most = std::max(most, ++counts[variant.stage]);
  return most;
}

}  // namespace

int main(int count, char** arguments) {
  const std::string kernels = count > 1 ? arguments[1] : "";
  StereoRig rig = SyntheticSequence(SyntheticOptions()).rig();
  const auto pixels = static_cast<std::size_t>(rig.left.width) * static_cast<std::size_t>(rig.left.height);
  // Undistortion kernels are built only for cameras with lens distortion.
  rig.left_undistortion = {rig.left.width, rig.left.height, std::vector<float>(pixels), std::vector<float>(pixels)};
  rig.right_undistortion = rig.left_undistortion;
  rig.left_mask = {rig.left.width, rig.left.height,
                   std::vector<std::uint8_t>(pixels)};  // and mask kernels only with a mask

  std::set<std::string> programs;
  for (std::size_t number = 0; number < most_variants(); ++number) {
    DeviceOptions options;
    options.kernel_folder = kernels;
    options.profiling = true;
    Device device("auto", options);
    const Config config = config_with(number);
    Config paper = config;
    paper.method = "paper";
    for (const Config& each : {config, paper}) frontend::make_frontend(rig, device, each);
    stages::long_loop_difference(*device.context());
    for (const auto& program : device.context()->programs()) programs.insert(program);
  }
  for (const auto& program : programs) std::puts(program.c_str());
}
