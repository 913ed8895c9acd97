/// \file eth3d_pairs.cpp  Stereo pairs of ETH3D: the two-view benchmark, and pairs of its multi-view recordings.

#include <algorithm>
#include <optional>

#include "common/printed.hpp"
#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"

namespace quadedge::data {

// ETH3D's low-resolution many-view scenes as stereo sequences:
// stereo_pairs/NAME/{im0.png,im1.png,calib.txt,images.txt,disp0GT.pfm}, a folder per frame whose name is its time
// [ns]. calib.txt may also lie in stereo_pairs/ or beside it. images.txt (COLMAP: id qw qx qy qz tx ty tz camera name)
// has the pose camera_from_world of im0.png.
namespace {

constexpr const char* kPairs = "stereo_pairs";

fs::path pairs_folder(const fs::path& folder) {
  return folder_name(folder) == kPairs ? whole_path(folder) : folder / kPairs;
}

std::vector<std::string> pair_names(const fs::path& pairs) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(pairs))
    if (entry.is_directory() && entry.path().filename().string()[0] != '.')
      names.push_back(entry.path().filename().string());
  if (names.empty()) fail(pairs.string(), "no folder", "one with im0.png and im1.png for every frame");
  std::sort(names.begin(), names.end(), comes_before);
  return names;
}

/// calib.txt of a pair, or the one above that all share.
std::string calibration_file(const fs::path& pair) {
  for (const fs::path& place : {pair, pair / "..", pair / ".." / ".."})
    if (fs::exists(place / "calib.txt")) return (place / "calib.txt").lexically_normal().string();
  return (pair / "calib.txt").string();
}

bool are_equal(const StereoRig& one, const StereoRig& other) {
  return one.left.matrix() == other.left.matrix() && one.right.matrix() == other.right.matrix() &&
         one.right_from_left.matrix() == other.right_from_left.matrix() && one.left.width == other.left.width &&
         one.left.height == other.left.height;
}

void read_rig(Dataset& dataset) {
  std::string first;
  for (const FrameFiles& frame : dataset.frames) {
    const std::string file = calibration_file(fs::path(frame.left).parent_path());
    if (file == first) continue;
    const PairCalibration calibration = read_pair_calibration(file);
    if (first.empty()) {
      first = file;
      dataset.rig = calibration.rig;
      dataset.rig.max_disparity = eth3d_max_disparity(calibration);
    } else if (!are_equal(calibration.rig, dataset.rig)) {
      fail(file, "another calibration than in " + first, "the same cameras in all frames");
    }
  }
}

/// The pose of im0.png; nothing without images.txt.
std::optional<Eigen::Isometry3d> read_pose(const std::string& file) {
  if (!fs::exists(file)) return std::nullopt;
  const std::string expected = "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, camera from world";
  constexpr std::size_t kColumns = 10;
  for (const Line& line : data_lines(file)) {
    const auto words = split(line.text, " \t\r");
    if (words.size() != kColumns || fs::path(words.back()).filename() != "im0.png") continue;
    double v[8];
    for (std::size_t i = 1; i < 8; ++i) v[i] = parse_number(words[i], file, line.number, expected);
    return stated_pose({v[5], v[6], v[7]}, {v[1], v[2], v[3], v[4]}, "QW QX QY QZ", file, line.number).inverse();
  }
  fail(file, "no row of im0.png", expected);
}

void read_truth(Dataset& dataset) {
  for (const FrameFiles& frame : dataset.frames) {
    const std::string file = (fs::path(frame.left).parent_path() / "images.txt").string();
    const auto pose = read_pose(file);
    if (!pose) continue;
    if (dataset.truth_file.empty()) dataset.truth_file = file;
    dataset.truth.push_back({frame.stamp_ns, *pose});
  }
}

bool is_eth3d_stereo_pairs(const fs::path& folder) { return fs::is_directory(pairs_folder(folder)); }

Dataset read_eth3d_stereo_pairs(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  const fs::path pairs = pairs_folder(folder);
  Dataset dataset;
  dataset.name = folder_name(pairs / "..");
  const auto names = pair_names(pairs);
  const auto stamps = stamps_of_names(names, pairs.string());
  if (!stamps) dataset.notes.push_back("the folders' names are no timestamps; 10 Hz is assumed");
  constexpr std::int64_t kPeriodNs = 100'000'000;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::int64_t stamp = stamps ? (*stamps)[i] : static_cast<std::int64_t>(i) * kPeriodNs;
    add_frame(dataset, stamp, pairs / names[i] / "im0.png", pairs / names[i] / "im1.png", findings);
  }
  findings.attempt([&] { read_rig(dataset); });
  findings.attempt([&] { read_truth(dataset); });
  if (!dataset.frames.empty()) {
    const fs::path disparity = fs::path(dataset.frames.front().left).parent_path() / "disp0GT.pfm";
    if (fs::exists(disparity)) dataset.disparity_truth = disparity.string();
  }
  return dataset;
}

// ETH3D low-resolution two-view pairs: two_view_training/SCENE/{im0.png,im1.png,calib.txt} and
// two_view_training_gt/SCENE/disp0GT.pfm. The same files as in Middlebury 2014; folder names and ground truth
// distinguish the two. The third Middlebury benchmark has these files too, the ground truth beside the images.

/// Indoor and outdoor scenes at distances of about 0.7 m and more: at most 64 px of disparity, the usual search range
/// on this benchmark; semi-global matching finds up to 39 px in terrains_1s and 59 px in forest_1s (99 %). ndisp of
/// ETH3D is the image width and says nothing; the third Middlebury benchmark has a smaller one, which holds.
constexpr double kMaxDisparity = 64;
/// Published calibrations are of two kinds: the wide "l" images (above 900 columns) and the "s" images, both with a
/// baseline of about 6 cm.
constexpr double kFocalWide = 541.764, kFocalNarrow = 711.499, kTwoViewBaseline = 0.06;
constexpr int kWideColumns = 900;

std::string truth_of(const fs::path& folder) {
  const fs::path clean = whole_path(folder);
  const fs::path beside =
      clean.parent_path().parent_path() / (clean.parent_path().filename().string() + "_gt") / clean.filename();
  for (const auto& place : {clean, beside}) {
    if (fs::exists(place / "disp0GT.pfm")) return (place / "disp0GT.pfm").string();
  }
  return {};
}

bool is_eth3d_two_view(const fs::path& folder) {
  if (!fs::exists(folder / "im0.png") && !fs::exists(folder / "im1.png")) return false;
  const fs::path clean = whole_path(folder);
  return !fs::exists(folder / "calib.txt") || !truth_of(folder).empty() ||
         clean.parent_path().filename().string().rfind("two_view", 0) == 0;
}

Dataset read_eth3d_two_view(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset = still_pair((folder / "im0.png").string(), (folder / "im1.png").string(), findings);
  dataset.disparity_truth = truth_of(folder);
  double max_disparity = kMaxDisparity;
  findings.attempt([&] {
    if (fs::exists(folder / "calib.txt")) {
      const PairCalibration calibration = read_pair_calibration((folder / "calib.txt").string());
      dataset.rig = calibration.rig;
      max_disparity = eth3d_max_disparity(calibration);
      return;
    }
    set_sizes_from_first_frame(dataset);
    const PinholeCamera left = dataset.rig.left;
    set_rectified_rig(dataset.rig, left.width > kWideColumns ? kFocalWide : kFocalNarrow, (left.width - 1) / 2.0,
                      (left.height - 1) / 2.0, (left.width - 1) / 2.0, kTwoViewBaseline);
    dataset.notes.push_back("no calib.txt: nominal calibration (f " + printed("%f", dataset.rig.left.fx) +
                            " px, baseline 0.06 m); matches are valid, depths and poses are nominal");
  });
  dataset.rig.max_disparity = max_disparity;
  return dataset;
}

}  // namespace

double eth3d_max_disparity(const PairCalibration& calibration) {
  const bool is_stated = calibration.disparities > 0 && calibration.disparities < calibration.rig.left.width;
  return is_stated ? calibration.disparities + calibration.disparity_offset : kMaxDisparity;
}

const Layout kEth3dStereoPairs{"eth3d-stereo-pairs", is_eth3d_stereo_pairs, read_eth3d_stereo_pairs,
                               is_eth3d_stereo_pairs};
const Layout kEth3dTwoView{"eth3d-two-view", is_eth3d_two_view, read_eth3d_two_view};

}  // namespace quadedge::data
