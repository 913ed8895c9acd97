#pragma once
/// \file epipolar_rows.hpp  Common numbering of the epipolar lines of both images of a rig. doc/method.md section 1.

#include "common/layouts.hpp"
#include "common/rectification_error.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/side.hpp"

namespace quadedge {

/// Numbering of an image's epipolar lines: angles of the epipolar planes, as tangents times the left focal length. The
/// plane half-way between the two optical axes has number 0.
EpipolarRows epipolar_rows(const StereoRig& rig, Side side);

/// Arguments of kernels/edge_selection.cl for an image. The right image, which is searched, keeps slightly more edges.
/// \param error of the right image's rows, which are numbered as they lie in it
SelectionArguments selection_arguments(const StereoRig& rig, Side side, const StereoConfig& config,
                                       const RectificationError& error = {});

}  // namespace quadedge
