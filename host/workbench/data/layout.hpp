#pragma once
/// \file layout.hpp  Common parts of the readers of published layouts: the folders that `quadedge run` reads.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "data/image_file.hpp"
#include "quadedge/dataset.hpp"

namespace quadedge::data {

namespace fs = std::filesystem;

/// Collects the errors that a reader finds. Opening for a run stops at the first error; checking collects all of them.
class Findings {
 public:
  explicit Findings(bool collect) : collect_(collect) {}

  /// \throws DataError unless collecting.
  void error(const std::string& message);
  void error(const std::string& file, const std::string& found, const std::string& expected);
  void warn(const std::string& message) { warnings_.push_back(message); }
  /// Runs a part of a reader that is independent of the others; records its DataError when collecting.
  void attempt(const std::function<void()>& part);

  const std::vector<std::string>& errors() const { return errors_; }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  bool collect_;
  std::vector<std::string> errors_, warnings_;
};

/// One published layout.
struct Layout {
  const char* name;
  /// Whether the folder has this layout. Considers names only, so that damaged datasets are recognised and reported.
  bool (*recognise)(const fs::path& folder);
  /// Fills everything but `format`, and `path` and `name` where they are not the folder's. \throws DataError,
  /// UsageError.
  Dataset (*read)(const fs::path& folder, const DatasetOptions& options, Findings& findings);
  /// Whether the folder itself is a recording of many frames (not a folder of such folders). Considers names only; null
  /// for still pairs.
  bool (*is_recording)(const fs::path& folder) = nullptr;
};

extern const Layout kKitti, kKittiRaw, kEuroc, kTartanair, kEth3dSlam, kEth3dStereoPairs, kViso2Quad, kPairedNames,
    kEth3dTwoView, kMiddlebury2014, kMiddlebury2005, kMiddlebury2003;

/// All layouts, in the order in which they are tried.
const std::vector<Layout>& layouts();

/// Implements open_dataset() and check_dataset(): selects the layout, reads it, checks timestamps and rig, limits the
/// frames.
Dataset read_dataset(const std::string& path, const DatasetOptions& options, Findings& findings);

/// Common final steps of all datasets: limits the frames to a half-open range (last -1: to the end), checks that
/// timestamps increase and that the rig is usable. \throws UsageError for a range outside the dataset
void finish_dataset(Dataset& dataset, int first_frame, int last_frame, Findings& findings);

/// Opens a dataset by `open`, describes it and reads all of it. \param seen called with every pair that could be read;
/// may be empty
DatasetCheck check_opened(const std::string& path, const std::function<Dataset(Findings&)>& open,
                          const std::function<void(const Dataset&, const StereoPair&)>& seen);

/// Checks the size of an image against the camera's and its depth against the rig's. \throws DataError that names
/// `source`
void check_image(const Image& image, const std::string& source, const PinholeCamera& camera, int max_value);

/// Timestamps of all frames [ns].
std::vector<std::int64_t> stamps_of(const Dataset& dataset);

/// Folder and files that a dataset's rig was read from, for messages.
std::string calibration_of(const Dataset& dataset);

/// The road is visible from about 6 m, cars and kerbs beside the lane from 3 m: 127 to 129 px with KITTI's f and
/// baseline. Semi-global matching finds 99.9 % of sequence 06 below 116 px.
constexpr double kNearestRoadDepth = 3.0;  // m

/// Names of the images in a folder, sorted. \throws DataError if the folder is missing or contains none
std::vector<std::string> image_names(const fs::path& folder);

/// folder/stem.EXT for the first known image extension that exists; otherwise folder/stem.png, for the message.
std::string image_with_stem(const fs::path& folder, const std::string& stem);

/// Adds a frame, or reports which file is missing.
void add_frame(Dataset& dataset, std::int64_t stamp_ns, const fs::path& left, const fs::path& right,
               Findings& findings);

/// Adds the frames of folders whose images are numbered from 0: number k has the k-th time of `times_file`. \returns k
/// of every frame
std::vector<std::size_t> add_numbered_frames(Dataset& dataset, const fs::path& left, const fs::path& right,
                                             const std::vector<std::int64_t>& stamps_ns, const std::string& times_file,
                                             Findings& findings);

/// The recording that a folder is, or that it holds: the one called `wanted`, or the only one if that is empty.
/// \throws UsageError that lists them, DataError with `expected` if there is none
fs::path sequence_in(const fs::path& folder, bool (*is_recording)(const fs::path&), const std::string& wanted,
                     const std::string& expected);

/// Sets width and height of both cameras from the first frame's images.
void set_sizes_from_first_frame(Dataset& dataset);

/// Whether the first readable images have the sizes of the rig's cameras; true if none is readable.
bool sizes_fit(const Dataset& dataset);

/// Sets the rig and the maximum disparity of a dataset from a calibration.
void set_calibration(Dataset& dataset, const StereoCalibration& calibration);

/// \throws DataError that names the image and `calibration`, if the images of the first frame are damaged or have other
/// sizes than the rig's cameras.
void check_sizes(const Dataset& dataset, const std::string& calibration);

/// Error message of the file system for an unreadable location, with `path`.
std::string unreadable_place(const std::string& path, const fs::filesystem_error& problem);

/// The rotation nearest to a matrix read from a file. \throws DataError if it deviates by more than rounding (1e-3)
Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix, const std::string& file);

/// The transform of a 3 x 4 matrix, row by row, with the rotation nearest to its 3 x 3 part. \throws DataError as above
Eigen::Isometry3d nearest_transform(const std::vector<double>& rows, const std::string& file);

/// The cameras of a rectified pair, but not their sizes: equal focal lengths, the right one `baseline` metres to the
/// right.
void set_rectified_rig(StereoRig& rig, double focal, double cx, double cy, double right_cx, double baseline);

/// The absolute path of a folder, without "." and "..", and without a slash at its end.
fs::path whole_path(const fs::path& folder);
/// Its last part.
std::string folder_name(const fs::path& folder);

/// A dataset of one still pair.
Dataset still_pair(const std::string& left, const std::string& right, Findings& findings);

/// calib.txt of Middlebury 2014 and ETH3D two-view: cam0=[f 0 cx; 0 f cy; 0 0 1], cam1, baseline in mm, width, height,
/// ndisp.
struct PairCalibration {
  StereoRig rig;
  double disparity_offset = 0;  ///< px; cx of the right camera minus cx of the left one
  double disparities = 0;       ///< px; the documented bound ndisp, 0 when absent
};
PairCalibration read_pair_calibration(const std::string& file);

/// Largest disparity expected in ETH3D's low-resolution scenes [px].
double eth3d_max_disparity(const PairCalibration& calibration);

}  // namespace quadedge::data
