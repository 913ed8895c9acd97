#pragma once
/// \file rig_findings.hpp  What is said about a calibration, in words: what is seen, and what the cause may be.

#include <string>
#include <vector>

#include "odometry/epipolar_fit.hpp"
#include "odometry/epipolar_probe.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/rig_evidence.hpp"

namespace quadedge::odometry {

/// Sentences for a person.
struct RigFindings {
  std::string mismatch;             ///< why the frame cannot be used; empty where it can
  std::vector<std::string> doubts;  ///< what is doubtful although it can
};

/// Numbers of a calibration that hardly any rig has: a baseline beyond 5 mm to 5 m, a focal length beyond 0.2 to 20
/// image widths, a principal point outside the image, pixels that are half as wide as high.
std::vector<std::string> implausible_numbers(const StereoRig& rig);

/// Puts the outcome of a search into the evidence.
void take_search(const ProbeSearch& search, const EpipolarFit& fit, RigEvidence& evidence);

/// What a search says about the rig.
/// \param turned of a search with the right image turned otherwise that finds most spots: how it is turned; else empty
RigFindings judge_search(const ProbeSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                         const std::string& turned);

/// Does the search find so little that turned images should be tried?
bool finds_little(const ProbeSearch& search, const RigEvidence& evidence);

}  // namespace quadedge::odometry
