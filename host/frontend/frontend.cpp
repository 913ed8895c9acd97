#include "frontend/frontend.hpp"

#include <utility>

#include "frontend/device_frontend.hpp"
#include "frontend/memory_fit.hpp"
#include "frontend/paper_frontend.hpp"
#include "frontend/reference_frontend.hpp"
#include "opencl/variants.hpp"

namespace quadedge::frontend {

void Frontend::hide(const PixelMask& left) {
  PixelMask both = left_mask_of_rig_;
  if (both.empty()) {
    both = left;
  } else if (!left.empty()) {
    for (std::size_t i = 0; i < both.hidden.size(); ++i) both.hidden[i] |= left.hidden[i];
  }
  calibration_.left_mask = std::move(both);
  take_left_mask();
}

std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config,
                                        std::vector<Warning>* warnings) {
  opencl::check_variants(config.variants);
  if (config.is_paper()) return std::make_unique<PaperFrontend>(rig, config);
  if (device.is_reference()) return std::make_unique<ReferenceFrontend>(rig, config);
  const MemoryFit fit = fit_memory(rig, config, device.context()->limits().memory_bytes);
  if (warnings != nullptr && !fit.message.empty()) warnings->push_back({WarningKind::device_memory, fit.message});
  return std::make_unique<DeviceFrontend>(rig, *device.context(), fit.config);
}

}  // namespace quadedge::frontend
