/// \file eth3d_two_view.cpp  ETH3D low-resolution two-view pairs: two_view_training/SCENE/{im0.png,im1.png,calib.txt}
/// and two_view_training_gt/SCENE/disp0GT.pfm. The same files as in Middlebury 2014; folder names and ground truth
/// distinguish the two. The third Middlebury benchmark has these files too, the ground truth beside the images.

#include "data/layout.hpp"

namespace quadedge::data {
namespace {

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

}  // namespace

double eth3d_max_disparity(const PairCalibration& calibration) {
  const bool is_stated = calibration.disparities > 0 && calibration.disparities < calibration.rig.left.width;
  return is_stated ? calibration.disparities + calibration.disparity_offset : kMaxDisparity;
}

bool is_eth3d_two_view(const fs::path& folder) {
  if (!fs::exists(folder / "im0.png") && !fs::exists(folder / "im1.png")) return false;
  const fs::path clean = whole_path(folder);
  return !fs::exists(folder / "calib.txt") || !truth_of(folder).empty() ||
         clean.parent_path().filename().string().rfind("two_view", 0) == 0;
}

Dataset read_eth3d_two_view(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset = still_pair(folder, (folder / "im0.png").string(), (folder / "im1.png").string(), findings);
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
    const ImageSize left{dataset.rig.left.width, dataset.rig.left.height};
    const ImageSize right{dataset.rig.right.width, dataset.rig.right.height};
    dataset.rig = rectified_rig(left.width > kWideColumns ? kFocalWide : kFocalNarrow, (left.width - 1) / 2.0,
                                (left.height - 1) / 2.0, (left.width - 1) / 2.0, kTwoViewBaseline);
    dataset.rig.left.width = left.width;
    dataset.rig.left.height = left.height;
    dataset.rig.right.width = right.width;
    dataset.rig.right.height = right.height;
    dataset.notes.push_back("no calib.txt: nominal calibration (f " + std::to_string(dataset.rig.left.fx) +
                            " px, baseline 0.06 m); matches are valid, depths and poses are nominal");
  });
  dataset.rig.max_disparity = max_disparity;
  return dataset;
}

}  // namespace quadedge::data
