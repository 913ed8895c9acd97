#pragma once
/// \file dataset.hpp  Recorded sequences and pairs in the published layouts.

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

/// Files of one stereo frame.
struct FrameFiles {
  std::int64_t stamp_ns = 0;
  std::string left, right;
};

/// A sequence or a pair: calibration, frame list, and how far disparities reach. Images are not loaded yet.
struct Dataset {
  /// kitti | euroc | eth3d-slam | eth3d-two-view | middlebury-2003 | middlebury-2005 | middlebury-2006 |
  /// middlebury-2014 | viso2-quad; or images | video | pipe, see open_stereo_source()
  std::string format;
  std::string path;  ///< the sequence's own folder, or its first file
  std::string name;  ///< short name for tables
  StereoRig rig;
  std::optional<StereoCalibration> calibration;  ///< what the rig was made of, where lenses are told of
  std::vector<FrameFiles> frames;                ///< of a stream the files again and again; of a pipe none
  std::shared_ptr<const PairStream> stream;  ///< where the pairs come from that are no files of their own; else null
  /// Largest disparity that this kind of data holds [px], measured from a point at infinity: f x baseline / nearest
  /// depth. Where the principal points differ (doffs of Middlebury) the plain difference of columns is smaller by that.
  double max_disparity = 0;
  /// Ground-truth poses of the LEFT CAMERA, empty when there are none. Only evaluation may look at it.
  Trajectory truth;
  std::string truth_file;       ///< where it came from
  std::string disparity_truth;  ///< file with the left view's disparity, empty when there is none
  double disparity_truth_scale =
      1;  ///< px of this image per unit stored in `disparity_truth` (8-bit files: 0 is unknown)
  std::vector<std::string> notes;  ///< what a user should know: nominal calibration, assumed times, skipped images
};

/// Choices of the user.
struct DatasetOptions {
  std::string format = "auto";  ///< or one of dataset_formats()
  std::string sequence;         ///< KITTI: the sequence's name when `path` holds several
  int first_frame = 0;          ///< half-open range of frames
  int last_frame = -1;          ///< -1: to the end
  std::string calibration;      ///< files of read_calibration(); empty: what the layout says
  double fov = 0;               ///< of make_rig(), for recordings with a calibration of lenses
  std::string mask;             ///< files of mask_rig(); empty: none
};

/// The names that DatasetOptions::format takes besides "auto".
std::vector<std::string> dataset_formats();

/// Recognises the layout and reads calibration, frame list and ground truth; checks that every image file exists and
/// that stamps increase. \throws DataError naming the file, what was found and what was expected.
Dataset open_dataset(const std::string& path, const DatasetOptions& options = {});

/// What `quadedge check` prints: everything wrong with the data, not only the first thing; also decodes every image.
struct DatasetCheck {
  std::vector<std::string> facts;     ///< one line each: format, frames, sizes, rate, baseline, truth coverage
  std::vector<std::string> warnings;  ///< gaps in the stamps, truth covering a part only
  std::vector<std::string> errors;    ///< what would stop a run
};
DatasetCheck check_dataset(const std::string& path, const DatasetOptions& options = {});

/// Reads one grey image at its full depth. Colour becomes luminance.
/// \throws DataError for a missing, truncated or undecodable file.
Image read_grey_image(const std::string& path);

/// Reads frames ahead on another thread, in order; those of a stream that does not wait as PairStream says.
class FramePrefetcher {
 public:
  /// Numbered as in Dataset::frames.
  struct Frame : StereoPair {
    StereoFrame view() const { return {stamp_ns, left.view(), right.view()}; }
  };
  /// `ahead`: frames kept decoded in advance. `stop`: asked while a frame is waited for (a pipe may never give one);
  /// where it says yes, the frames are over. \throws as PairStream::open().
  explicit FramePrefetcher(const Dataset& dataset, int ahead = 2, std::function<bool()> stop = {});
  ~FramePrefetcher();
  /// The next frame, or nothing at the end. \throws DataError of the frame that could not be read, also when its size
  /// differs from the calibration's.
  std::optional<Frame> next();
  /// Pairs left out so far since their stream did not wait.
  int dropped() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
