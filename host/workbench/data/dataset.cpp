/// \file dataset.cpp  Chooses the layout that recognises the folder, then applies the user's cameras and frame range.
#include "quadedge/dataset.hpp"

#include <algorithm>

#include "common/printed.hpp"
#include "data/calibrations/forms.hpp"
#include "data/image_file.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "geometry/disparity_range.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace data {
namespace {

const Layout& choose(const fs::path& folder, const std::string& format) {
  if (!fs::exists(folder)) fail(folder.string(), "no such folder", "a recorded sequence or pair");
  if (!fs::is_directory(folder)) fail(folder.string(), "a file", "the folder of a recorded sequence or pair");
  for (const auto& layout : layouts()) {
    if (format == "auto" ? layout.recognise(folder) : layout.name == format) return layout;
  }
  if (format != "auto") throw UsageError("--format " + format + ": expected auto, " + joined(dataset_formats()));
  std::vector<std::string> entries;
  for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path().filename().string());
  std::sort(entries.begin(), entries.end());
  constexpr std::size_t kShown = 6;
  std::string found;
  for (std::size_t i = 0; i < std::min(entries.size(), kShown); ++i) found += (i ? ", " : "") + entries[i];
  if (entries.size() > kShown) found += ", ...";
  fail(folder.string(), entries.empty() ? "an empty folder" : found,
       "the folder of one recording (your own images: --left, --right and --calibration) in one of the layouts " +
           joined(dataset_formats()));
}

/// Limits the frames to the half-open range given by the user.
void cut_frames(Dataset& dataset, int first_frame, int last_frame) {
  const int count = static_cast<int>(dataset.frames.size());
  const int last = last_frame < 0 ? count : last_frame;
  if (first_frame < 0 || last > count || first_frame >= last) {
    throw UsageError("frames " + std::to_string(first_frame) + ":" + std::to_string(last) + ": " + dataset.path +
                     " has the frames 0:" + std::to_string(count));
  }
  dataset.frames.erase(dataset.frames.begin() + last, dataset.frames.end());
  dataset.frames.erase(dataset.frames.begin(), dataset.frames.begin() + first_frame);
}

void check_stamps(const Dataset& dataset, Findings& findings) {
  for (std::size_t i = 1; i < dataset.frames.size(); ++i) {
    const std::int64_t step = dataset.frames[i].stamp_ns - dataset.frames[i - 1].stamp_ns;
    if (step > 0 || (step < 0 && dataset.restarts)) continue;
    findings.error(dataset.frames[i].left,
                   "timestamp " + format_seconds(dataset.frames[i].stamp_ns) + " after " +
                       format_seconds(dataset.frames[i - 1].stamp_ns),
                   "increasing timestamps");
  }
}

/// Applies the user's calibration, field of view and mask to the layout's own.
void apply_users_cameras(Dataset& dataset, const DatasetOptions& options) {
  if (!options.calibration.empty()) {
    dataset.calibration = read_calibration(options.calibration, options.rectified);
    const FrameFiles& first = dataset.frames.front();
    set_image_sizes(*dataset.calibration, image_size(first.left), image_size(first.right),
                    first.left + ", " + first.right);
  }
  if (options.rectified && options.calibration.empty())
    throw UsageError("--rectified is for a --calibration that describes rectified images, as ROS's camera_info does");
  if (options.fov != 0 && !dataset.calibration) {
    throw UsageError("--fov: " + dataset.path + " does not describe lenses; give --calibration or omit --fov");
  }
  if (dataset.calibration && (!options.calibration.empty() || options.fov != 0)) {
    const StereoRig before = dataset.rig;
    dataset.rig = make_rig(*dataset.calibration, options.fov);
    if (before.max_disparity > 0) {  // from the layout's nearest depth
      dataset.rig.max_disparity =
          before.max_disparity * (dataset.rig.left.fx * dataset.rig.baseline()) / (before.left.fx * before.baseline());
    }
  }
  if (!options.mask.empty()) mask_rig(dataset.rig, options.mask);
}

/// Largest pixel value of an image. Damaged images are reported when they are read.
int max_value_of(const std::string& file) {
  try {
    return image_size(file).max_value;
  } catch (const DataError&) {
    return kMaxValue8;
  }
}

}  // namespace

Dataset read_dataset(const std::string& path, const DatasetOptions& options, Findings& findings) {
  const Layout& layout = choose(path, options.format);
  Dataset dataset = layout.read(path, options, findings);
  dataset.format = layout.name;
  if (dataset.path.empty()) dataset.path = path;
  if (dataset.name.empty()) dataset.name = folder_name(path);
  if (!dataset.frames.empty()) {
    findings.attempt([&] { apply_users_cameras(dataset, options); });
    dataset.rig.max_value = max_value_of(dataset.frames.front().left);
  } else if (findings.errors().empty()) {
    findings.error(dataset.path, "no stereo frame", "at least one");
  }
  finish_dataset(dataset, options.first_frame, options.last_frame, findings);
  return dataset;
}

void finish_dataset(Dataset& dataset, int first_frame, int last_frame, Findings& findings) {
  check_stamps(dataset, findings);
  if (const std::string complaint = rate_complaint(stamps_of(dataset)); !complaint.empty())
    dataset.warnings.push_back(complaint);
  if (!dataset.frames.empty()) cut_frames(dataset, first_frame, last_frame);
  // After an error, a rig that was not read says nothing more.
  if (!findings.errors().empty() && dataset.rig.left.width == 0) return;
  findings.attempt([&] {
    check_rig(dataset.rig, calibration_of(dataset).c_str());
    check_disparity_range(dataset.rig, calibration_of(dataset));
  });
}

std::vector<std::int64_t> stamps_of(const Dataset& dataset) {
  std::vector<std::int64_t> stamps;
  for (const FrameFiles& frame : dataset.frames) stamps.push_back(frame.stamp_ns);
  return stamps;
}

std::string calibration_of(const Dataset& dataset) {
  if (dataset.calibration) return dataset.calibration->files;
  if (dataset.format == "eth3d-slam") return dataset.path + " (calibration.txt, calibration2.txt, extrinsics_1_2.txt)";
  return fs::exists(fs::path(dataset.path) / "calib.txt") ? dataset.path + "/calib.txt" : dataset.path;
}

}  // namespace data

std::vector<std::string> dataset_formats() {
  std::vector<std::string> names;
  for (const auto& layout : data::layouts()) names.push_back(layout.name);
  return names;
}

Dataset open_dataset(const std::string& path, const DatasetOptions& options) {
  data::Findings findings(false);
  try {
    Dataset dataset = data::read_dataset(path, options, findings);
    data::check_sizes(dataset, data::calibration_of(dataset));
    return dataset;
  } catch (const std::filesystem::filesystem_error& problem) {
    throw DataError(data::unreadable_place(path, problem));
  }
}

}  // namespace quadedge
