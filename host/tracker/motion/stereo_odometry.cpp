/// \file stereo_odometry.cpp  The public odometry: a tracker of frames with its device and its processors.
#include "common/parallel.hpp"
#include "device/context.hpp"
#include "device/variants.hpp"
#include "motion/frame_tracker.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/tap.hpp"

namespace quadedge {
namespace {

/// The configuration, if it and the rig are valid. \throws DataError, UsageError.
Config checked(const StereoRig& rig, Config config) {
  odometry::check_usable(rig, config);
  return config;
}

}  // namespace

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::first: return "first";
    case FrameStatus::tracked: return "tracked";
    case FrameStatus::lost_too_few_edges: return "lost_too_few_edges";
    case FrameStatus::lost_too_few_quads: return "lost_too_few_quads";
    case FrameStatus::lost_no_consensus: return "lost_no_consensus";
    case FrameStatus::lost_rig_mismatch: return "lost_rig_mismatch";
  }
  return "unknown";
}

class StereoOdometry::Implementation {
 public:
  std::unique_ptr<Device> own_device;  ///< null if the caller owns it
  Device& device;
  odometry::FrameTracker tracker;
  Processors processors;
};

StereoOdometry::StereoOdometry(const StereoRig& rig, const Config& config) {
  const Config sound = checked(rig, config);  // before a device is opened
  auto device = std::make_unique<Device>();
  Device& opened = *device;
  implementation_.reset(new Implementation{std::move(device), opened, {rig, opened, sound}, {}});
}

StereoOdometry::StereoOdometry(const StereoRig& rig, Device& device, const Config& config) {
  const Config sound = checked(rig, config);
  const auto use = device.use();
  implementation_.reset(new Implementation{nullptr, device, {rig, device, sound}, {}});
}

StereoOdometry::~StereoOdometry() = default;
FrameResult StereoOdometry::track(const StereoFrame& frame) {
  const auto use = implementation_->device.use();
  return implementation_->processors.run([&] { return implementation_->tracker.track(frame); });
}
void StereoOdometry::restart() {
  const auto use = implementation_->device.use();
  implementation_->tracker.restart();
}
FrameDetails StereoOdometry::details() const {
  const auto use = implementation_->device.use();
  return implementation_->tracker.details();
}
const StereoEdges& StereoOdometry::stereo_edges() const { return implementation_->tracker.stereo_edges(); }
odometry::LatestFrame odometry::LatestFrame::of(const StereoOdometry& odometry) {
  return odometry.implementation_->tracker.latest_frame();
}
const StereoRig& StereoOdometry::rig() const { return implementation_->tracker.rig(); }
const Config& StereoOdometry::config() const { return implementation_->tracker.config(); }
const DeviceInfo& StereoOdometry::device() const { return implementation_->device.info(); }
void StereoOdometry::set_tap(Tap* tap) { implementation_->tracker.frontend().set_tap(tap); }
std::size_t StereoOdometry::device_bytes() const { return implementation_->tracker.frontend().device_bytes(); }

std::map<std::string, std::string> StereoOdometry::variants() const {
  std::map<std::string, std::string> chosen;
  if (implementation_->device.context() == nullptr) return chosen;
  for (const auto& variant : opencl::all_variants()) {
    chosen[variant.stage] = opencl::choose_variant(variant.stage, *implementation_->device.context(),
                                                   implementation_->tracker.config().variants)
                                .name;
  }
  return chosen;
}

double StereoOdometry::kernel_build_ms() const {
  const auto* context = implementation_->device.context();
  return context == nullptr ? 0 : context->build_ms();
}

}  // namespace quadedge
