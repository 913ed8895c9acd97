#pragma once
/// \file dataset.hpp  Recorded sequences and image pairs in published layouts.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/image.hpp"
#include "quadedge/pair_stream.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {

/// Image files of one stereo frame.
struct FrameFiles {
  std::int64_t stamp_ns = 0;
  std::string left = {}, right = {};
  std::string left_mask = {}, right_mask = {};  ///< masks of this frame, see StereoFrame; empty: none
};

/// A sequence or an image pair: cameras, list of frames. Images are not loaded yet.
struct Dataset {
  /// One of dataset_formats(); or images | video | pipe, see open_stereo_source().
  std::string format;
  std::string path;  ///< folder of the sequence, or its first file
  std::string name;  ///< short name for tables
  /// Its max_disparity is that of this kind of data, f x baseline / nearest depth. Where the principal points differ
  /// (`doffs` of Middlebury), the plain difference of columns is smaller by `doffs`.
  StereoRig rig;
  std::optional<StereoCalibration> calibration;  ///< calibration that the rig was made from, if it describes lenses
  std::vector<FrameFiles> frames;                ///< for a video, its file names in every frame; empty for a pipe
  std::shared_ptr<const PairStream> stream;      ///< of pairs that are not stored as separate image files, or null
  /// Ground-truth poses of the left camera; empty if there is no ground truth. Used for evaluation only.
  Trajectory truth;
  std::string truth_file;             ///< file that the ground truth was read from
  std::string disparity_truth;        ///< file with the disparities of the left view; empty if there is none
  double disparity_truth_scale = 1;   ///< px per unit stored in `disparity_truth` (in 8-bit files 0 means unknown)
  bool restarts = false;              ///< whether stamps may go back, where StereoOdometry::restart() is due
  std::vector<std::string> notes;     ///< remarks for the user: nominal calibration, assumed timestamps, skipped images
  std::vector<std::string> warnings;  ///< options that contradict the data
};

/// Options of open_dataset().
struct DatasetOptions {
  std::string format = "auto";  ///< "auto" or one of dataset_formats()
  std::string sequence;         ///< KITTI: name of the sequence if `path` contains several
  int first_frame = 0;          ///< frames first_frame .. last_frame - 1
  int last_frame = -1;          ///< -1: up to the last frame
  std::string calibration;      ///< files of read_calibration(); empty: the calibration of the dataset
  bool rectified = false;       ///< the images are rectified, see read_calibration()
  double fov = 0;               ///< see make_rig(); for recordings with a lens calibration
  std::string mask;             ///< files of mask_rig(); empty: none
};

/// Values of DatasetOptions::format other than "auto".
std::vector<std::string> dataset_formats();

/// Recognises the layout and reads calibration, list of frames and ground truth. Checks that every image file exists
/// and that timestamps increase. \throws DataError that names the file, what was found and what was expected.
Dataset open_dataset(const std::string& path, const DatasetOptions& options = {});

/// Gives every frame of a dataset of image files its masks (StereoFrame): FOLDER/left/NAME.png and
/// FOLDER/right/NAME.png for images NAME.*; a camera without such a folder has none. \throws UsageError for a video or
/// a pipe; DataError for a folder without left and right, and for an image without its mask.
void add_masks(Dataset& dataset, const std::string& folder);

/// Result of `quadedge check`: all problems of a dataset, not only the first. Every image is decoded.
struct DatasetCheck {
  std::vector<std::string> facts;     ///< one line each: format, number of frames, image sizes, frame rate, baseline,
                                      ///< coverage of the ground truth
  std::vector<std::string> warnings;  ///< gaps between timestamps, ground truth that covers only some frames
  std::vector<std::string> errors;    ///< problems that would stop a run
};
/// \param seen called with every pair that could be read
DatasetCheck check_dataset(const std::string& path, const DatasetOptions& options = {},
                           const std::function<void(const Dataset&, const StereoPair&)>& seen = {});

/// Reads a grey image at its full bit depth. Colour images are converted to luminance.
/// \throws DataError for a missing, truncated or undecodable file.
Image read_grey_image(const std::string& path);

/// Reads frames ahead on another thread, in order. Live streams drop pairs as PairStream::longest_queue() describes.
class FramePrefetcher {
 public:
  /// Numbered as in Dataset::frames.
  using Frame = StereoPair;
  /// `ahead`: number of frames decoded in advance. `stop`: called while waiting for a frame (a pipe may never deliver
  /// one); if it returns true, the sequence ends. \throws as PairStream::open().
  explicit FramePrefetcher(const Dataset& dataset, int ahead = 2, std::function<bool()> stop = {});
  ~FramePrefetcher();
  /// Returns the next frame, or nothing at the end. \throws DataError if the frame cannot be read or its size differs
  /// from the calibration.
  std::optional<Frame> next();
  /// Number of pairs of a live stream that were dropped so far.
  int dropped() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
