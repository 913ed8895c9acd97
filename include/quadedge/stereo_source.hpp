#pragma once
/// \file stereo_source.hpp  A stereo camera of one's own: image folders, videos or a pipe, and a calibration file.

#include <functional>
#include <string>

#include "quadedge/dataset.hpp"

namespace quadedge {

/// Pairs that a longest_queue() holds unless the user says otherwise: a fifth of a second at 20 Hz.
constexpr int kUsualPipeQueue = 4;

/// What the pairs come from. One of three: `left` and `right`; `video`; `pipe`.
struct StereoSource {
  std::string left, right;  ///< two folders of images (in natural order of their names), image files or video files
  std::string video;        ///< one video whose pictures hold both views
  bool pipe = false;        ///< standard input: binary PGM or PPM pictures, one after the other, left before right
  std::string split;        ///< "left-right" or "top-bottom": how a picture of `video` or `pipe` holds the two views
  std::string calibration;  ///< files of read_calibration()
  double fov = 0;           ///< of make_rig()
  std::string mask;         ///< files of mask_rig(); empty: none
  double fps = 0;           ///< stamps are 0, 1 / fps ...; 0: of `times`, or the source's own
  std::string times;  ///< file with a row per pair: seconds, or as EuRoC's data.csv; empty: what lies beside the images
  /// Of a pipe: pairs that wait at most, the oldest gives way to a new one; 0: whoever writes has to wait.
  int queue = kUsualPipeQueue;
  int first_frame = 0;  ///< half-open range of pairs, as DatasetOptions
  int last_frame = -1;

  /// Whether there is anything to open.
  bool is_given() const { return !left.empty() || !right.empty() || !video.empty() || pipe; }
};

/// Opens it as a data set without ground truth, whose format is "images", "video" or "pipe". Of a pipe the first pair
/// is read. Images in folders are files (Dataset::frames); other pairs come from Dataset::stream, and a pipe has no
/// list of frames.
/// \throws UsageError for a source that is none or more than one of the three, and where stamps are missing that `fps`
/// would give; DataError that names the file, for unequal numbers of left and right pictures too.
Dataset open_stereo_source(const StereoSource& source);

/// Opens it and reads every pair, as check_dataset() does. \param seen told every pair that could be read
DatasetCheck check_stereo_source(const StereoSource& source,
                                 const std::function<void(const Dataset&, const StereoPair&)>& seen = {});

}  // namespace quadedge
