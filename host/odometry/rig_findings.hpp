#pragma once
/// \file rig_findings.hpp  Messages about a calibration: what was measured, and the likely cause.

#include <string>
#include <vector>

#include "odometry/epipolar_fit.hpp"
#include "odometry/epipolar_probe.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/rig_evidence.hpp"
#include "quadedge/warning.hpp"

namespace quadedge::odometry {

/// Messages for the user.
struct RigFindings {
  std::string mismatch;           ///< why the frame cannot be used; empty if it can
  std::vector<Warning> warnings;  ///< about a frame that can be used
};

/// Reports implausible values of a calibration: a baseline outside 5 mm to 5 m, a focal length outside 0.2 to 20 image
/// widths, a ratio of fx to fy outside 1 / 1.5 to 1.5, a principal point outside the image.
std::vector<Warning> implausible_numbers(const StereoRig& rig);

/// Adds the results of a search to the evidence.
void add_search_results(const ProbeSearch& search, const EpipolarFit& fit, RigEvidence& evidence);

/// Judges the rig by the results of a search.
/// \param turned description of the transformation of the right image with which a search finds most corners; or empty
RigFindings judge_search(const ProbeSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                         const std::string& turned);

/// Whether so few corners are found that transformed images should be tried.
bool finds_few_corners(const ProbeSearch& search, const RigEvidence& evidence);

}  // namespace quadedge::odometry
