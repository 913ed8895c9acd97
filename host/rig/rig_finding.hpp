#pragma once
/// \file rig_finding.hpp  What can be wrong with a rig: kinds of findings, with their figures, and in words.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "quadedge/rig_evidence.hpp"
#include "rig/corner_matching.hpp"
#include "rig/image_delay.hpp"
#include "rig/static_region.hpp"

namespace quadedge::rig {

/// Each has its text in warning(). A kind of warning (quadedge/error.hpp) stands for several.
enum class RigFindingKind {
  // The frame cannot be used:
  frozen_camera,         ///< one image is identical to the previous one, the other is not
  no_common_scene,       ///< hardly any corner of the left image is found in the right one
  negative_image,        ///< most corners are found as their negative
  turned_image,          ///< most corners are found after a transformation of the right image
  negative_disparities,  ///< most disparities are negative
  delayed_images,        ///< the left image fits a right one of another frame
  far_off_lines,         ///< corners lie farther from their epipolar lines than stereo matching tolerates
  // The frame can be used:
  off_lines,                  ///< corners lie farther from their epipolar lines than in valid recordings
  beyond_range,               ///< disparities exceed the range searched
  some_negative_disparities,  ///< more disparities are negative than in valid recordings
  late_camera,                ///< distances from the epipolar lines are proportional to the image motion
  repeated_images,            ///< both images are identical to the previous ones
  large_disparity_offset,     ///< the offset that the odometry learns exceeds what rectification leaves
  saturated_images,           ///< corners leave their lines in images with many saturated pixels
  compressed_images,          ///< the same in images that show the blocks of a strong compression
  uneven_images,              ///< the same where one image is much brighter than the other
  shared_lens,                ///< motions show that both lenses are off alike
  interlaced,                 ///< odd and even rows show different times
  static_region,              ///< a part of the image does not move while the rest does
  masked_region,              ///< the same, certain enough to be masked
  // Numbers of the calibration:
  long_baseline,
  short_baseline,
  focal_length,
  pixel_shape,
  principal_point,
};

/// Whether a frame with such a finding has no pose: the order of the kinds decides.
constexpr bool is_mismatch(RigFindingKind kind) { return kind <= RigFindingKind::far_off_lines; }

/// A finding and the figures that its sentence states; other figures keep their initial values.
struct RigFinding {
  RigFindingKind kind;
  RigEvidence evidence = {};               ///< of the frame
  int corners = 0;                         ///< of the left image, searched for in the right one
  double inverted_ratio = 0;               ///< of these, found as their negative
  ImageTurn turn = ImageTurn::none;        ///< of turned_image
  EpipolarFit fit = {};                    ///< of the distances from the epipolar lines
  double max_disparity = 0;                ///< largest disparity searched [px]
  double time_offset = 0;                  ///< of late_camera [frame intervals]
  double disparity_offset = 0;             ///< of large_disparity_offset [px]
  ImageDelay delay = {};                   ///< of delayed_images
  double poor = 0;                         ///< figure of saturated, compressed or uneven images
  double shared_focal = 0, shared_k1 = 0;  ///< of shared_lens, see SharedLens::Error; 0: not certain
  double combed_ratio = 0;                 ///< of interlaced
  StaticRegion region = {};                ///< of static_region and masked_region
  Side camera = Side::left;                ///< the camera that is frozen or has an implausible number
  /// The implausible number: baseline [m], focal length [image widths], fx / fy.
  double number = 0;
  Eigen::Vector2d principal_point = Eigen::Vector2d::Zero();  ///< [px]
};

/// What was measured in a frame, and what is wrong with it.
struct RigReport {
  RigEvidence evidence;
  /// Patches around stereo edges; null without, valid until the next frame is judged.
  const std::vector<CornerMatch>* matches = nullptr;
  std::vector<RigFinding> findings;  ///< a mismatch is the only one
  /// What to hide of the left image from the next frame on; empty: nothing more, as what was hidden moves.
  std::optional<PixelMask> new_mask;

  /// The reason why the frame cannot be used, or null.
  const RigFinding* mismatch() const {
    return !findings.empty() && is_mismatch(findings.front().kind) ? &findings.front() : nullptr;
  }
};

/// What was measured and the likely cause, in one sentence for the user. The kind has a meaning if the finding is no
/// mismatch.
Warning warning(const RigFinding& finding);

}  // namespace quadedge::rig
