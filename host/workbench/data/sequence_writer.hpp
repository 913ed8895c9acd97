#pragma once
/// \file sequence_writer.hpp  Writes rendered sequences as recordings.

#include <functional>
#include <string>

#include "quadedge/synthetic.hpp"

namespace quadedge {

/// Writes a rendered sequence in the ETH3D SLAM stereo layout:
///   rgb/STAMP.png, rgb2/STAMP.png      left and right image, 8-bit grey
///   rgb.txt                            timestamp and file name of the left images
///   calibration.txt, calibration2.txt  fx fy cx cy of the left and the right camera
///   extrinsics_1_2.txt                 3 x 4 matrix left_from_right [m]
///   calibration.yaml                   instead of these three for a lens, see write_calibration()
///   groundtruth.txt                    TUM rows of world_from_left
///   depth/STAMP.pfm, depth2/STAMP.pfm  exact z of every pixel of the left and right image [m], 32-bit PFM
/// (16-bit PNG would round depths to 0.2 mm, too coarse for evaluating sub-pixel disparities.) Camera 1 is the left
/// one, so that groundtruth.txt and depth/ refer to the camera whose trajectory is estimated; of the rig "eth3d-slam"
/// it is the right one, as in that benchmark. `progress(done, all)` is called after each frame and may be empty.
/// \throws DataError if the folder already contains such a sequence or something cannot be written
void write_eth3d_slam(const std::string& folder, const SyntheticSequence& sequence,
                      const std::function<void(int, int)>& progress = {});

}  // namespace quadedge
