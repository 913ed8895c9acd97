/// \file registration.cpp  Registers the plain C++ reference as the device `reference`. CMake makes every program that
/// links the library take in this file.
#include "device/oracle.hpp"
#include "oracle/reference_frontend.hpp"
#include "paper/grid_edges.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge {
namespace {

std::unique_ptr<frontend::Frontend> make_frontend(const StereoRig& rig, const Config& config) {
  if (config.is_paper()) return std::make_unique<frontend::PaperReferenceFrontend>(rig, config);
  return std::make_unique<frontend::ReferenceFrontend>(rig, config);
}

EdgeSet detect_edges(const ImageView& image, const Config& config, const PixelMask& mask) {
  reference::EdgeThreshold threshold(config.edges);
  const auto detect = config.is_paper() ? paper::grid_edges : reference::detect_edges;
  const auto all = detect(image, config.edges, threshold.next({image}));
  return reference::to_edge_set(reference::outside_mask(all, mask, config.edges.margin));
}

DeviceInfo info() {
  DeviceInfo info;
  info.index = -1;
  info.platform = "none";
  info.name = "plain C++ reference";
  info.driver = info.opencl = "-";
  info.type = "reference";
  info.compute_units = 1;
  info.single_precision = {true, true, true, false, false, true};
  return info;
}

}  // namespace
}  // namespace quadedge

/// Undefined for the linker (CMakeLists.txt), so that it takes this file.
extern "C" bool quadedge_has_oracle;
bool quadedge_has_oracle =
    (quadedge::register_oracle({quadedge::info(), quadedge::make_frontend, quadedge::detect_edges}), true);
