#pragma once
/// \file stereo_source.hpp  A custom stereo camera: image folders, videos or a pipe, and a calibration file.

#include <functional>
#include <string>

#include "quadedge/dataset.hpp"

namespace quadedge {

/// A source of pairs. Exactly one of: `left` and `right`; `video`; `pipe`.
struct StereoSource {
  std::string left, right;  ///< two folders of images (in natural order of their names), image files or video files
  std::string video;        ///< one video whose frames contain both views
  bool pipe = false;        ///< standard input: binary PGM or PPM images in succession, left before right
  std::string split;  ///< "left-right" or "top-bottom": arrangement of the two views in an image of `video` or `pipe`
  std::string calibration;  ///< files of read_calibration()
  bool rectified = false;   ///< the images are rectified, see read_calibration()
  double fov = 0;           ///< see make_rig()
  std::string mask;         ///< files of mask_rig(); empty: none
  /// Pairs per second: timestamps are 0, 1 / fps ... for a pipe and for images without timestamps, and replace those of
  /// a video. Images with timestamps (names, data.csv, times.txt) keep them; a rate that contradicts them is one of
  /// Dataset::warnings. 0: the timestamps of the source.
  double fps = 0;
  std::string times;  ///< file with one row per pair, seconds or EuRoC's data.csv, that replaces all other timestamps
  bool restarts = false;  ///< whether stamps may go back, see Dataset::restarts
  /// Largest difference between the stamps of a pair of image files [ms]; others are dropped. 0: half the usual period.
  double tolerance_ms = 0;
  /// For a pipe: whether the oldest of the waiting pairs is dropped when pairs arrive faster than they are read.
  /// Otherwise the writer waits, and every pair is read.
  bool live = false;
  int first_frame = 0;  ///< first pair of the range, see DatasetOptions
  int last_frame = -1;

  /// Whether a source is specified.
  bool is_given() const { return !left.empty() || !right.empty() || !video.empty() || pipe; }
};

/// Opens the source as a dataset without ground truth, with the format "images", "video" or "pipe". The first pair of a
/// pipe is read. Images in folders become Dataset::frames; other pairs come from Dataset::stream, and a pipe has no
/// list of frames unless `times` gives one.
/// \throws UsageError if none or more than one of the three sources is specified, and if timestamps are missing and
/// `fps` is not given; DataError that names the file, also if the numbers of left and right images differ.
Dataset open_stereo_source(const StereoSource& source);

/// Opens the source and reads every pair, as check_dataset() does. \param seen called with every pair that could be
/// read
DatasetCheck check_stereo_source(const StereoSource& source,
                                 const std::function<void(const Dataset&, const StereoPair&)>& seen = {});

}  // namespace quadedge
