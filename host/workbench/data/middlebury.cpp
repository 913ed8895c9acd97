/// \file middlebury.cpp  Middlebury stereo pairs of 2003, 2005, 2006 and 2014.
///
/// Depth of the 2005 and 2006 pairs, according to their page: Z = 3740 px x 160 mm / (disparity + dmin), all in
/// full-size pixels. The offset dmin (and doffs of 2014) is represented by moving the right camera's principal point to
/// the right.

#include <algorithm>
#include <cmath>

#include "data/layout.hpp"
#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr double kFullFocal = 3740;  // px, 2005 and 2006 at full size
constexpr double kBaseline = 0.16;   // m
constexpr int kFullRows2005 = 1110;  // image rows of the full size of 2005 and 2006
constexpr int kFullRows2003 = 1500;
/// Disparities are stored as 8-bit grey values in full-size pixels (2003: in quarters of a quarter-size pixel), so that
/// none exceeds 255 of these units, which bounds the search.
constexpr double kLargestGrey = 255;

/// ndisp over the width is 0.09 to 0.12 in all published scenes of 2014 except Jadeplant and Vintage; used for copies
/// without ndisp.
constexpr double kDefaultRange2014 = 0.12;

bool has(const fs::path& folder, const std::string& stem) { return fs::exists(image_with_stem(folder, stem)); }

std::string if_there(const std::string& file) { return fs::exists(file) ? file : std::string(); }

/// Rig, range and ground-truth scale of a pair that was reduced from its full size by an integer factor.
/// `offset`: dmin in full-size pixels.
void set_reduced_rig(Dataset& dataset, int full_rows, double offset) {
  set_sizes_from_first_frame(dataset);
  const PinholeCamera left = dataset.rig.left;
  const double reduction = std::max(1.0, std::round(static_cast<double>(full_rows) / std::max(left.height, 1)));
  const double cx = (left.width - 1) / 2.0, cy = (left.height - 1) / 2.0;
  set_rectified_rig(dataset.rig, kFullFocal / reduction, cx, cy, cx + offset / reduction, kBaseline);
  dataset.rig.max_disparity = (kLargestGrey + offset) / reduction;
  dataset.disparity_truth_scale = 1 / reduction;
}

bool is_opencv_sample(const fs::path& folder) { return has(folder, "aloeL"); }

bool is_middlebury_2005(const fs::path& folder) {
  return has(folder, "view1") || has(folder, "view5") || is_opencv_sample(folder);
}

/// Pairs of 2005 and 2006, and the scene Aloe under its file names in the OpenCV samples.
Dataset read_middlebury_2005(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  const bool is_sample = is_opencv_sample(folder);
  Dataset dataset = still_pair(image_with_stem(folder, is_sample ? "aloeL" : "view1"),
                               image_with_stem(folder, is_sample ? "aloeR" : "view5"), findings);
  findings.attempt([&] {
    double offset = 0;
    const std::string file = (folder / "dmin.txt").string();
    if (fs::exists(file)) {
      const auto lines = data_lines(file);
      if (lines.size() != 1)
        fail(file, counted(lines.size(), "row"), "one number, the smallest disparity in full-size pixels");
      offset = parse_row(lines[0], file, 1, "the smallest disparity in full-size pixels")[0];
    } else {
      dataset.notes.push_back("no dmin.txt: disparity offset assumed to be zero, depths are nominal");
    }
    set_reduced_rig(dataset, kFullRows2005, offset);
  });
  dataset.disparity_truth = if_there(image_with_stem(folder, is_sample ? "aloeGT" : "disp1"));
  return dataset;
}

bool is_middlebury_2003(const fs::path& folder) { return has(folder, "im2") || has(folder, "im6"); }

Dataset read_middlebury_2003(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset = still_pair(image_with_stem(folder, "im2"), image_with_stem(folder, "im6"), findings);
  findings.attempt([&] { set_reduced_rig(dataset, kFullRows2003, 0); });
  dataset.disparity_truth = if_there(image_with_stem(folder, "disp2"));
  dataset.notes.push_back(
      "2003 pairs have no calibration: that of 2005 is used; matches are valid, depths are nominal");
  return dataset;
}

bool is_middlebury_2014(const fs::path& folder) {
  return (fs::exists(folder / "im0.png") || fs::exists(folder / "im1.png")) && fs::exists(folder / "calib.txt");
}

Dataset read_middlebury_2014(const fs::path& folder, const DatasetOptions&, Findings& findings) {
  Dataset dataset = still_pair((folder / "im0.png").string(), (folder / "im1.png").string(), findings);
  dataset.disparity_truth = if_there((folder / "disp0.pfm").string());
  findings.attempt([&] {
    const std::string file = (folder / "calib.txt").string();
    const PairCalibration calibration = read_pair_calibration(file);
    dataset.rig = calibration.rig;
    double disparities = calibration.disparities;
    if (!(disparities > 0)) {
      disparities = kDefaultRange2014 * calibration.rig.left.width;
      dataset.notes.push_back("calib.txt has no ndisp: disparities up to 12 % of the width are expected");
    }
    dataset.rig.max_disparity = disparities + calibration.disparity_offset;
  });
  return dataset;
}

}  // namespace

const Layout kMiddlebury2014{"middlebury-2014", is_middlebury_2014, read_middlebury_2014};
const Layout kMiddlebury2005{"middlebury-2005", is_middlebury_2005, read_middlebury_2005};
const Layout kMiddlebury2003{"middlebury-2003", is_middlebury_2003, read_middlebury_2003};

}  // namespace quadedge::data
