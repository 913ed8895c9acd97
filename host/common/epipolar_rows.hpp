#pragma once
/// \file epipolar_rows.hpp  Numbers for epipolar lines that both images of a rig share. doc/method.md section 1.

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/side.hpp"

namespace quadedge {

/// The numbers of one image's epipolar lines: angles of the planes through both camera centres, as tangents times the
/// left focal length. The plane half-way between the two optical axes has number 0.
EpipolarRows epipolar_rows(const StereoRig& rig, Side side);

/// What kernels/edge_selection.cl asks of an image. The right one is the searched one and keeps a little more.
SelectionArguments selection_arguments(const StereoRig& rig, Side side, const StereoConfig& config);

}  // namespace quadedge
