/// \file layout.cpp  The layouts in the order of trial, and what their readers share: frames, sizes, rotations.
#include "data/layout.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <map>

#include "common/printed.hpp"
#include "data/text.hpp"
#include "geometry/calibration.hpp"
#include "quadedge/error.hpp"

namespace quadedge::data {
namespace {

/// Parses "[f 0 cx; 0 f cy; 0 0 1]" into a camera.
void set_camera(PinholeCamera& camera, const std::string& text, const std::string& file, int line) {
  const auto tokens = split(text, " \t[];,");
  const std::string expected = "nine numbers [fx 0 cx; 0 fy cy; 0 0 1]";
  if (tokens.size() != 9) fail(file, line, in_quotes(text), expected);
  std::vector<double> values;
  for (const auto& token : tokens) values.push_back(parse_number(token, file, line, expected));
  if (values[1] != 0 || values[3] != 0 || values[6] != 0 || values[7] != 0 || values[8] != 1)
    fail(file, line, in_quotes(text), expected);
  camera.fx = values[0];
  camera.cx = values[2];
  camera.fy = values[4];
  camera.cy = values[5];
}

}  // namespace

void Findings::error(const std::string& message) {
  if (!collect_) throw DataError(message);
  errors_.push_back(visible(message));
}

void Findings::error(const std::string& file, const std::string& found, const std::string& expected) {
  error(file + ": found " + found + ", expected " + expected);
}

void Findings::attempt(const std::function<void()>& part) {
  try {
    part();
  } catch (const DataError& problem) {
    if (!collect_) throw;
    errors_.push_back(problem.what());
  }
}

const std::vector<Layout>& layouts() {
  static const std::vector<Layout> all = {kKitti,        kKittiRaw,         kEuroc,          kTartanair,
                                          kEth3dSlam,    kEth3dStereoPairs, kViso2Quad,      kPairedNames,
                                          kEth3dTwoView, kMiddlebury2014,   kMiddlebury2005, kMiddlebury2003};
  return all;
}

std::vector<std::string> image_names(const fs::path& folder) {
  if (!fs::is_directory(folder)) fail(folder.string(), "no such folder", "a folder of images");
  std::vector<std::string> names;
  std::string other;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (is_image_name(name) && name[0] != '.') names.push_back(name);
    if (is_other_image_name(name)) other = name;
  }
  if (names.empty() && !other.empty()) fail(folder.string(), "images such as " + other, kConverted);
  if (names.empty()) fail(folder.string(), "no image", "PNG, JPEG, PGM or PPM files");
  std::sort(names.begin(), names.end());
  return names;
}

std::string image_with_stem(const fs::path& folder, const std::string& stem) {
  for (const char* extension : {".png", ".ppm", ".pgm", ".jpg", ".jpeg"}) {
    const fs::path candidate = folder / (stem + extension);
    if (fs::exists(candidate)) return candidate.string();
  }
  return (folder / (stem + ".png")).string();
}

void add_frame(Dataset& dataset, std::int64_t stamp_ns, const fs::path& left, const fs::path& right,
               Findings& findings) {
  bool complete = true;
  for (const auto& file : {left, right}) {
    if (fs::is_regular_file(file)) continue;
    complete = false;
    findings.error(file.string(), "no such file",
                   file == left ? "the left image" : "the right image of " + left.filename().string());
  }
  if (complete) dataset.frames.push_back({stamp_ns, left.string(), right.string()});
}

std::vector<std::size_t> add_numbered_frames(Dataset& dataset, const fs::path& left, const fs::path& right,
                                             const std::vector<std::int64_t>& stamps_ns, const std::string& times_file,
                                             Findings& findings) {
  constexpr std::size_t kMostDigits = 10;
  std::vector<std::size_t> rows;
  const auto names = image_names(left);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string stem = fs::path(names[i]).stem().string();
    const bool is_number = stem.size() <= kMostDigits && stem.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t row = is_number ? std::stoul(stem) : i;
    if (row >= stamps_ns.size()) {
      findings.error(times_file, counted(stamps_ns.size(), "row"), "a time for the image " + names[i]);
      return rows;
    }
    const std::size_t before = dataset.frames.size();
    add_frame(dataset, stamps_ns[row], left / names[i], right / names[i], findings);
    if (dataset.frames.size() > before) rows.push_back(row);
  }
  return rows;
}

fs::path sequence_in(const fs::path& folder, bool (*is_recording)(const fs::path&), const std::string& wanted,
                     const std::string& expected) {
  if (is_recording(folder)) {
    if (!wanted.empty() && wanted != folder_name(folder))
      fail(folder.string(), "the sequence " + folder_name(folder), "the sequence " + wanted + " asked for");
    return folder;
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (is_recording(entry.path())) names.push_back(entry.path().filename().string());
  if (names.empty()) fail(folder.string(), "no sequence", expected);
  std::sort(names.begin(), names.end());
  if (wanted.empty() && names.size() == 1) return folder / names[0];
  if (std::find(names.begin(), names.end(), wanted) != names.end()) return folder / wanted;
  const std::string list = joined(names);
  if (!wanted.empty())
    throw UsageError(folder.string() + " has no sequence " + in_quotes(wanted) + "; there are " + list);
  throw UsageError(folder.string() + " holds the sequences " + list + ": give the folder of one, such as " +
                   (folder / names[0]).string());
}

void set_sizes_from_first_frame(Dataset& dataset) {
  if (dataset.frames.empty()) return;
  set_size(dataset.rig.left, image_size(dataset.frames[0].left));
  set_size(dataset.rig.right, image_size(dataset.frames[0].right));
}

bool sizes_fit(const Dataset& dataset) {
  for (const auto& frame : dataset.frames) {
    try {
      return image_size(frame.left) == size_of(dataset.rig.left) &&
             image_size(frame.right) == size_of(dataset.rig.right);
    } catch (const DataError&) {
      continue;  // reported when the frame is read
    }
  }
  return true;
}

void set_calibration(Dataset& dataset, const StereoCalibration& calibration) {
  dataset.calibration = calibration;
  dataset.rig.left = calibration.left.camera;
  dataset.rig.right = calibration.right.camera;
  dataset.rig.right_from_left = calibration.right_from_left;
  // Tables of a wrong resolution might exhaust the memory; the mismatch is reported when the images are read.
  if (sizes_fit(dataset)) dataset.rig = make_rig(calibration);
}

void check_sizes(const Dataset& dataset, const std::string& calibration) {
  const auto check = [&](const std::string& file, const PinholeCamera& camera) {
    const ImageSize found = image_size(file), expected = size_of(camera);
    if (found != expected)
      fail(file, to_string(found) + " pixels", to_string(expected) + ", as " + calibration + " says");
  };
  check(dataset.frames.front().left, dataset.rig.left);
  check(dataset.frames.front().right, dataset.rig.right);
}

std::string unreadable_place(const std::string& path, const fs::filesystem_error& problem) {
  const std::string name = in_quotes(problem.path1().filename().string());
  return path + ": found " + name + " that cannot be read (" + problem.code().message() +
         "), expected a readable folder";
}

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix, const std::string& file) {
  constexpr double kTolerance = 1e-3;
  const double deviation = rotation_error(matrix);
  if (deviation > kTolerance) {
    fail(file,
         "a 3 x 3 part that deviates from an orthonormal matrix by " + printed("%f", deviation) + " (determinant " +
             printed("%f", matrix.determinant()) + ")",
         "a rotation");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Isometry3d nearest_transform(const std::vector<double>& rows, const std::string& file) {
  const Eigen::Matrix<double, 3, 4> matrix = Eigen::Map<const Eigen::Matrix<double, 4, 3>>(rows.data()).transpose();
  Eigen::Isometry3d transform(nearest_rotation(matrix.leftCols<3>(), file));
  transform.translation() = matrix.col(3);
  return transform;
}

void set_rectified_rig(StereoRig& rig, double focal, double cx, double cy, double right_cx, double baseline) {
  rig.left.fx = rig.left.fy = rig.right.fx = rig.right.fy = focal;
  rig.left.cx = cx;
  rig.right.cx = right_cx;
  rig.left.cy = rig.right.cy = cy;
  rig.right_from_left.translation() << -baseline, 0, 0;
}

fs::path whole_path(const fs::path& folder) { return fs::absolute(folder / ".").lexically_normal().parent_path(); }

std::string folder_name(const fs::path& folder) { return whole_path(folder).filename().string(); }

Dataset still_pair(const std::string& left, const std::string& right, Findings& findings) {
  Dataset dataset;
  add_frame(dataset, 0, left, right, findings);
  return dataset;
}

PairCalibration read_pair_calibration(const std::string& file) {
  std::map<std::string, std::pair<std::string, int>> entries;
  for (const auto& line : data_lines(file)) {
    const std::size_t equals = line.text.find('=');
    const auto names = split(line.text.substr(0, equals));
    if (equals == std::string::npos || names.size() != 1) fail(file, line.number, in_quotes(line.text), "key=value");
    const std::string& key = names[0];
    if (!entries.insert({key, {line.text.substr(equals + 1), line.number}}).second)
      fail(file, line.number, "a second entry " + key, "each entry once");
  }
  const auto entry = [&](const std::string& key) {
    const auto found = entries.find(key);
    if (found == entries.end()) fail(file, "no entry " + key, "cam0, cam1, baseline, width and height");
    return found->second;
  };
  const auto number = [&](const std::string& key) {
    const auto [text, line] = entry(key);
    const auto tokens = split(text);
    return parse_number(tokens.empty() ? "" : tokens[0], file, line, key);
  };
  const auto side = [&](const std::string& key) {
    const auto [text, line] = entry(key);
    const auto tokens = split(text);
    return parse_whole(tokens.empty() ? "" : tokens[0], file, line, key, 1, kLargestImageSide);
  };
  PairCalibration calibration;
  StereoRig& rig = calibration.rig;
  set_camera(rig.left, entry("cam0").first, file, entry("cam0").second);
  set_camera(rig.right, entry("cam1").first, file, entry("cam1").second);
  rig.left.width = rig.right.width = side("width");
  rig.left.height = rig.right.height = side("height");
  rig.right_from_left.translation() << -number("baseline") / 1000.0, 0, 0;
  calibration.disparity_offset = rig.right.cx - rig.left.cx;
  if (entries.count("ndisp")) calibration.disparities = number("ndisp");
  return calibration;
}

}  // namespace quadedge::data
