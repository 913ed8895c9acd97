/// \file frontend.cpp  Joins the masks of rig and frame; chooses the paper's, the reference or the device front end.
#include "edges/frontend.hpp"

#include "common/images.hpp"
#include "device/oracle.hpp"
#include "device/variants.hpp"
#include "edges/common_view.hpp"
#include "edges/device_frontend.hpp"
#include "edges/memory_fit.hpp"
#include "edges/paper_device_frontend.hpp"

namespace quadedge::frontend {

void Frontend::hide(const PixelMask& left) {
  calibration_.left_mask = masks_.left = joined(left_mask_of_rig_, left);
  masks_changed();
}

std::shared_ptr<const PixelMask> Frontend::take_masks(const StereoFrame& frame) {
  const bool was_masked = !of_frame_.empty();
  to_left_.run(frame.left_mask, calibration_.left, calibration_.left_undistortion, of_frame_.left);
  to_right_.run(frame.right_mask, calibration_.right, calibration_.right_undistortion, of_frame_.right);
  if (!was_masked && of_frame_.empty()) return nullptr;
  masks_ = {joined(calibration_.left_mask, of_frame_.left), joined(calibration_.right_mask, of_frame_.right)};
  masks_changed();
  return of_frame_.left.empty() ? nullptr : std::make_shared<const PixelMask>(with_border(of_frame_.left, margin_));
}

std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config,
                                        std::vector<Warning>* warnings) {
  opencl::check_variants(config.variants);
  const StereoRig seen = config.is_paper() ? rig : within_common_view(rig);
  if (device.is_reference()) return registered_oracle()->make_frontend(seen, config);
  const MemoryFit fit = fit_memory(seen, config, device.context()->limits().memory_bytes);
  if (warnings != nullptr && !fit.message.empty()) warnings->push_back({WarningKind::device_memory, fit.message});
  if (config.is_paper()) return std::make_unique<PaperDeviceFrontend>(seen, *device.context(), fit.config);
  return std::make_unique<DeviceFrontend>(seen, *device.context(), fit.config);
}

}  // namespace quadedge::frontend
