#pragma once
/// \file disparity_range.hpp  The disparities that are searched: those of a rig if the configuration states none, and
/// the levels of the coarse search. doc/method.md section 3.

#include <cstdint>
#include <optional>
#include <string>

#include "common/layouts.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"

namespace quadedge {

/// Whether the configuration states a range: stereo.max_disparity or stereo.min_depth. Otherwise the range follows the
/// images, see host/tracker/edges/range_follower.hpp.
bool has_disparity_range(const StereoConfig& config);

/// The configuration with a disparity range: without one, stereo.max_disparity becomes rig.disparity_range().
/// \throws DataError as check_disparity_range().
Config with_disparity_range(Config config, const StereoRig& rig);

/// The largest range that the images of a rig are searched for without a range in the configuration [px]: half the
/// width of the left image, or StereoRig::max_disparity if that is larger.
double disparity_limit(const StereoRig& rig);

/// \throws DataError that names `source` (the calibration file) if focal length and baseline are so large that
/// rig.disparity_range() exceeds the largest value of stereo.max_disparity.
void check_disparity_range(const StereoRig& rig, const std::string& source);

// What a path costs in addition when its disparity changes by a level, and when it changes by more. Pixels cost their
// difference in slope and half their difference in grey levels.
constexpr int kCoarseStepPenalty = 12, kCoarseJumpPenalty = 200;
constexpr float kUndecided = 0.9F;      // belief of an edge's best candidate below which neighbours leave a tie
constexpr float kCoarseReach = 1.5F;    // px; half a level and the error of a coarse position
constexpr float kCoarseDissent = 0.1F;  // factor on the prior of candidates that the coarse disparity contradicts

/// How many edges the votes of their neighbours leave undecided.
struct RelaxationTally {
  std::int32_t edges = 0;      ///< with a candidate
  std::int32_t undecided = 0;  ///< of these, with a best belief below kUndecided
};

/// The search at half size over the disparities of `geometry`, one of `rig`; none where the rig is not rectified, or
/// where its images are too small.
std::optional<CoarseDisparityArguments> coarse_search(const StereoRig& rig, const EpipolarGeometry& geometry);

}  // namespace quadedge
