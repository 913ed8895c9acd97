#include "frontend/frontend.hpp"

#include "frontend/common_view.hpp"
#include "frontend/device_frontend.hpp"
#include "frontend/memory_fit.hpp"
#include "frontend/paper_frontend.hpp"
#include "frontend/reference_frontend.hpp"
#include "opencl/variants.hpp"

namespace quadedge::frontend {

void Frontend::hide(const PixelMask& left) {
  calibration_.left_mask = joined(left_mask_of_rig_, left);
  take_left_mask();
}

std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config,
                                        std::vector<Warning>* warnings) {
  opencl::check_variants(config.variants);
  if (config.is_paper()) return std::make_unique<PaperFrontend>(rig, config);
  const StereoRig seen = within_common_view(rig);
  if (device.is_reference()) return std::make_unique<ReferenceFrontend>(seen, config);
  const MemoryFit fit = fit_memory(seen, config, device.context()->limits().memory_bytes);
  if (warnings != nullptr && !fit.message.empty()) warnings->push_back({WarningKind::device_memory, fit.message});
  return std::make_unique<DeviceFrontend>(seen, *device.context(), fit.config);
}

}  // namespace quadedge::frontend
