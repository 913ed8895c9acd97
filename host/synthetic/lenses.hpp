#pragma once
/// \file lenses.hpp  The lenses and rigs of the renderer.

#include <string>

#include "quadedge/calibration.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::synthetic {

/// One of synthetic_lenses(), with parameters typical of calibrations of real cameras. `focal`: focal length of the
/// corresponding pinhole camera [px]. Wide-angle lenses have a larger field of view than that camera.
Lens make_lens(const std::string& name, double focal);

/// The cameras of cables_2 of ETH3D's SLAM benchmark (calibration.txt, calibration2.txt, extrinsics_1_2.txt), camera 2,
/// which is the left one, first.
StereoCalibration eth3d_slam_rig();

}  // namespace quadedge::synthetic
