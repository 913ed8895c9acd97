#include "stages/frontend.hpp"

#include "opencl/variants.hpp"
#include "stages/device_frontend.hpp"
#include "stages/reference_frontend.hpp"

namespace quadedge::stages {

std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config) {
  opencl::check_variants(config.variants);
  if (device.is_reference()) return std::make_unique<ReferenceFrontend>(rig, config);
  return std::make_unique<DeviceFrontend>(rig, *device.context(), config);
}

}  // namespace quadedge::stages
