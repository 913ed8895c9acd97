#pragma once
/// \file rig_judgement.hpp  Limits on what is measured about a rig (doc/method.md section 7).

#include <optional>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/rig_evidence.hpp"
#include "rig_check/rig_finding.hpp"

namespace quadedge::rig_check {

/// Implausible numbers of a calibration: a baseline outside 5 mm to 5 m, a focal length outside 0.2 to 20 image widths,
/// a ratio of fx to fy outside 1 / 1.5 to 1.5, a principal point outside the image.
std::vector<RigFinding> implausible_numbers(const StereoRig& rig);

/// Reports a learned disparity offset [px] beyond what rectification leaves, in either direction.
std::optional<RigFinding> judge_disparity_offset(double offset);

/// Adds the results of a search to the evidence.
void add_search_results(const ProbeSearch& search, const EpipolarFit& fit, RigEvidence& evidence);

/// Whether so few corners are found that transformed images should be tried.
bool finds_few_corners(const ProbeSearch& search, const RigEvidence& evidence);

/// Judges the rig by the results of a search.
/// \param turn transformation of the right image with which most corners are found, or none
std::vector<RigFinding> judge_search(const ProbeSearch& search, const EpipolarFit& fit, const RigEvidence& evidence,
                                     ImageTurn turn);

}  // namespace quadedge::rig_check
