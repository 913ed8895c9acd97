#pragma once
/// \file learned_rig.hpp  What a recording has shown of its rig: the common offset of all disparities, and whether
/// right images are displaced. doc/method.md section 7.

#include "motion/motion_estimate.hpp"
#include "quadedge/config.hpp"
#include "quadedge/rig_estimate.hpp"
#include "rig/image_jump.hpp"

namespace quadedge::rig {

/// A Kalman filter for the common offset of a rig's disparities, a rectification error of a fraction of a pixel (KITTI:
/// 0.2 px and more), and for the displacements of single right images from it. The offset is observable in the quads of
/// a moving camera (pose::fit_offset()); one frame per keyframe contributes a measurement. It is that of the rig less
/// the displacement of the frames, which share it according to their uncertainties. Displacements are measured from
/// frame to frame; as they scatter about zero, each is drawn there, and their errors do not add up without bound.
class LearnedRig {
 public:
  explicit LearnedRig(const PoseConfig& config);

  /// The rig of the next frame, before its motion is known.
  RigEstimate estimate() const;
  /// From when on an image of this recording is displaced. Strict until several are: without the displacement, hardly
  /// anything of the image is to be explained.
  DisplacementLimits displacement_limits() const;

  /// The rig of a frame after a fit that began with it. What the fit has learned is the rig's offset less the
  /// displacement of its frames. \param base of the frame that the displacement was measured against
  static RigEstimate refined(RigEstimate frame, const RigEstimate& base, const pose::PoseAndOffset& learned);
  /// Draws the displacement of a frame towards 0, where those of a recording scatter about, and takes note of it and of
  /// the errors of disparities.
  RigEstimate anchored(RigEstimate frame);
  /// Takes over the offset of a keyframe.
  void adopt(const RigEstimate& frame);
  /// The images of the next recording may not be displaced, and the rig may have been calibrated anew.
  void restart();

 private:
  double swing() const;

  double value_;
  pose::OffsetPrior prior_;
  double error_weight_ = 0;          ///< of prior_.error, see RigEstimate
  int displaced_ = 0;                ///< frames
  double frames_ = 0, squares_ = 0;  ///< since the first displaced one, and sum of squares [px^2], older ones less
};

}  // namespace quadedge::rig
