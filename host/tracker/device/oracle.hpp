#pragma once
/// \file oracle.hpp  The plain C++ reference, which takes the place of a device in programs that link it.

#include <memory>

#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

namespace frontend {
class Frontend;
}

/// What the library quadedge registers when a program that links it starts.
struct Oracle {
  DeviceInfo info;
  std::unique_ptr<frontend::Frontend> (*make_frontend)(const StereoRig& rig, const Config& config);
  EdgeSet (*detect_edges)(const ImageView& image, const Config& config, const PixelMask& mask);
};

/// Null where only quadedge_core is linked.
const Oracle* registered_oracle();
void register_oracle(const Oracle& oracle);

}  // namespace quadedge
