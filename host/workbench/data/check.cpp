/// \file check.cpp  Checks of `quadedge check`.

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/image_list.hpp"
#include "data/layout.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "quadedge/trajectory.hpp"

namespace quadedge {
namespace data {
namespace {

void describe_camera(const PinholeCamera& camera, const char* which, DatasetCheck& check) {
  check.facts.push_back(std::string(which) + " camera: " + std::to_string(camera.width) + " x " +
                        std::to_string(camera.height) + ", fx " + format_fixed(camera.fx, 3) + " fy " +
                        format_fixed(camera.fy, 3) + " cx " + format_fixed(camera.cx, 3) + " cy " +
                        format_fixed(camera.cy, 3));
}

std::string hidden_part(const PixelMask& mask) {
  const auto hidden = std::count(mask.hidden.begin(), mask.hidden.end(), 1);
  return format_fixed(mask.empty() ? 0 : 100.0 * static_cast<double>(hidden) / static_cast<double>(mask.hidden.size()),
                      1);
}

void describe_lenses(const Dataset& dataset, DatasetCheck& check) {
  const StereoRig& rig = dataset.rig;
  if (const auto& calibration = dataset.calibration) {
    const double fov = 2 * std::atan(0.5 * rig.left.width / rig.left.fx) / kDegree;
    check.facts.push_back("calibration: " + calibration->format + ", " + calibration->files);
    check.facts.push_back(std::string("lenses: ") + to_string(calibration->left.model) + " and " +
                          to_string(calibration->right.model) + ", field of view " + format_fixed(fov, 1) + " degrees");
  }
  if (!rig.left_mask.empty() || !rig.right_mask.empty()) {
    check.facts.push_back("hidden: " + hidden_part(rig.left_mask) + " % of the left image, " +
                          hidden_part(rig.right_mask) + " % of the right one");
  }
}

void describe(const Dataset& dataset, DatasetCheck& check) {
  check.facts.push_back("format: " + dataset.format);
  check.facts.push_back(std::string(dataset.stream ? "source: " : "folder: ") + dataset.path);
  check.facts.push_back("frames: " + std::to_string(dataset.frames.size()));
  describe_camera(dataset.rig.left, "left", check);
  describe_camera(dataset.rig.right, "right", check);
  check.facts.push_back(std::string("images: ") +
                        (dataset.rig.left_undistortion.empty() ? "pinhole" : "distorted, corrected by a table"));
  describe_lenses(dataset, check);
  check.facts.push_back("baseline: " + format_fixed(dataset.rig.baseline(), 6) + " m");
  check.facts.push_back("disparity range at the start: " + format_fixed(dataset.rig.disparity_range(), 1) + " px");
  if (const std::int64_t period = usual_period(stamps_of(dataset)); period > 0) {
    check.facts.push_back(
        "rate: " + format_fixed(1e9 / static_cast<double>(period), 2) + " Hz, " +
        format_fixed(static_cast<double>(dataset.frames.back().stamp_ns - dataset.frames[0].stamp_ns) / 1e9, 3) + " s");
  }
  for (const auto& note : dataset.notes) check.facts.push_back("note: " + note);
  check.warnings.insert(check.warnings.end(), dataset.warnings.begin(), dataset.warnings.end());
}

/// Finds steps of more than twice the usual one.
void find_gaps(const Dataset& dataset, DatasetCheck& check) {
  const std::int64_t period = usual_period(stamps_of(dataset));
  for (std::size_t i = 1; period > 0 && i < dataset.frames.size(); ++i) {
    const std::int64_t step = dataset.frames[i].stamp_ns - dataset.frames[i - 1].stamp_ns;
    if (step > 2 * period) {
      check.warnings.push_back("gap of " + format_fixed(static_cast<double>(step) / 1e9, 3) + " s before frame " +
                               std::to_string(i) + " (" + dataset.frames[i].left + ")");
    }
  }
}

void check_truth(const Dataset& dataset, DatasetCheck& check) {
  if (dataset.truth_file.empty()) {
    check.facts.push_back("ground truth: no poses");
  } else {
    const auto covered = std::count_if(dataset.frames.begin(), dataset.frames.end(), [&](const FrameFiles& frame) {
      return std::any_of(dataset.truth.begin(), dataset.truth.end(), [&](const StampedPose& pose) {
        return std::abs(pose.stamp_ns - frame.stamp_ns) <= kStampToleranceNs;
      });
    });
    const std::string coverage = std::to_string(covered) + " of " + counted(dataset.frames.size(), "frame");
    check.facts.push_back("ground truth: " + dataset.truth_file + ", " + coverage);
    if (static_cast<std::size_t>(covered) < dataset.frames.size()) {
      check.warnings.push_back(dataset.truth_file + ": covers " + coverage);
    }
  }
  if (!dataset.disparity_truth.empty()) check.facts.push_back("disparity of the left view: " + dataset.disparity_truth);
}

/// Reads an image file; returns nothing and records an error if it is not as expected.
std::optional<Image> read_image(const std::string& file, const PinholeCamera& camera, int max_value,
                                DatasetCheck& check) {
  try {
    Image image = read_grey_image(file);
    if (camera.width > 0) check_image(image, file, camera, max_value);
    return image;
  } catch (const DataError& problem) {
    check.errors.push_back(problem.what());
  }
  return std::nullopt;
}

/// Warns of 16-bit images that hold fewer bits at the lower end, whose contrast is too small for edges.
void check_range(const Image& image, const std::string& file, DatasetCheck& check) {
  if (image.max_value <= kMaxValue8) return;
  const ImageView view = image.view();
  int largest = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) largest = std::max(largest, view.value(x, y));
  constexpr int kSmallPart = 8;
  if (kSmallPart * largest > image.max_value) return;
  check.warnings.push_back(file + ": the largest of its 16-bit values is " + std::to_string(largest) +
                           ", expected values up to " + std::to_string(image.max_value) +
                           ": pixels of 10, 12 or 14 bits need to be scaled to 16");
}

/// Reads every image file, including those after a damaged one.
void read_files(const Dataset& dataset, const std::function<void(const Dataset&, const StereoPair&)>& seen,
                DatasetCheck& check) {
  for (std::size_t i = 0; i < dataset.frames.size(); ++i) {
    const FrameFiles& frame = dataset.frames[i];
    auto left = read_image(frame.left, dataset.rig.left, dataset.rig.max_value, check);
    auto right = read_image(frame.right, dataset.rig.right, dataset.rig.max_value, check);
    if (i == 0 && left) check_range(*left, frame.left, check);
    if (left && right && seen)
      seen(dataset, {static_cast<int>(i), frame.stamp_ns, std::move(*left), std::move(*right)});
  }
}

/// Reads all pairs of a stream up to the first damaged one, and sets the list of frames accordingly.
void read_stream(Dataset& dataset, const std::function<void(const Dataset&, const StereoPair&)>& seen,
                 DatasetCheck& check) {
  std::vector<FrameFiles> frames;
  try {
    FramePrefetcher pairs(dataset);
    while (const auto pair = pairs.next()) {
      if (frames.empty()) check_range(pair->left, dataset.path, check);
      frames.push_back({pair->stamp_ns, dataset.path, dataset.path});
      if (seen) seen(dataset, *pair);
    }
  } catch (const DataError& problem) {
    check.errors.push_back(problem.what());
  }
  dataset.frames = std::move(frames);
}

DatasetCheck read_all(Dataset dataset, const Findings& findings,
                      const std::function<void(const Dataset&, const StereoPair&)>& seen) {
  DatasetCheck of_images, check;
  if (dataset.stream) {
    read_stream(dataset, seen, of_images);
  } else {
    read_files(dataset, seen, of_images);
  }
  describe(dataset, check);
  find_gaps(dataset, check);
  check_truth(dataset, check);
  check.warnings.insert(check.warnings.end(), findings.warnings().begin(), findings.warnings().end());
  check.warnings.insert(check.warnings.end(), of_images.warnings.begin(), of_images.warnings.end());
  check.errors = findings.errors();
  check.errors.insert(check.errors.end(), of_images.errors.begin(), of_images.errors.end());
  return check;
}

}  // namespace

DatasetCheck check_opened(const std::string& path, const std::function<Dataset(Findings&)>& open,
                          const std::function<void(const Dataset&, const StereoPair&)>& seen) {
  Findings findings(true);
  DatasetCheck check;
  try {
    return read_all(open(findings), findings, seen);
  } catch (const DataError& problem) {
    findings.error(problem.what());
  } catch (const fs::filesystem_error& problem) {
    findings.error(unreadable_place(path.empty() ? problem.path1().string() : path, problem));
  }
  check.errors = findings.errors();
  check.warnings = findings.warnings();
  return check;
}

}  // namespace data

DatasetCheck check_dataset(const std::string& path, const DatasetOptions& options,
                           const std::function<void(const Dataset&, const StereoPair&)>& seen) {
  return data::check_opened(
      path, [&](data::Findings& findings) { return data::read_dataset(path, options, findings); }, seen);
}

}  // namespace quadedge
