/// \file viso2_quad.cpp  The stereo quad in libviso2's img/ folder: I1p, I2p (previous left, right), I1c, I2c
/// (current).

#include "data/layout.hpp"

namespace quadedge::data {
namespace {

// Calibration set in the source of the libviso2 demo; no file contains it.
constexpr double kFocal = 645.24, kCentreX = 635.96, kCentreY = 194.13;  // px
constexpr double kQuadBaseline = 0.5707;                                 // m
/// A car's camera sees the road from about 6 m on; objects beside the lane are as near as 3 m (123 px here).
constexpr double kNearestQuadDepth = 3.0;  // m
/// The Karlsruhe sequences have 10 frames per second; the quad has no timestamps.
constexpr std::int64_t kPeriodNs = 100'000'000;

bool is_viso2_quad(const fs::path& folder) { return fs::exists(image_with_stem(folder, "I1p")); }

Dataset read_viso2_quad(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset;
  std::int64_t stamp = 0;
  for (const char* which : {"p", "c"}) {
    add_frame(dataset, stamp, image_with_stem(folder, std::string("I1") + which),
              image_with_stem(folder, std::string("I2") + which), findings);
    stamp += kPeriodNs;
  }
  set_rectified_rig(dataset.rig, kFocal, kCentreX, kCentreY, kCentreX, kQuadBaseline);
  findings.attempt([&] { set_sizes_from_first_frame(dataset); });
  dataset.rig.max_disparity = kFocal * kQuadBaseline / kNearestQuadDepth;
  dataset.notes.push_back("calibration of the libviso2 demo; nominal times 0.1 s apart");
  return dataset;
}

}  // namespace

const Layout kViso2Quad{"viso2-quad", is_viso2_quad, read_viso2_quad};

}  // namespace quadedge::data
