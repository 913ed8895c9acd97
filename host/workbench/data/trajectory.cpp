/// \file trajectory.cpp  Tells TUM, KITTI and EuRoC apart by their columns; comment lines of TUM files begin segments.
#include "quadedge/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "common/printed.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"
#include "geometry/calibration.hpp"
#include "quadedge/error.hpp"

namespace quadedge {
namespace {

constexpr const char* kTumColumns = "timestamp tx ty tz qx qy qz qw";
constexpr const char* kKittiColumns = "the 3 x 4 matrix world_from_left, row by row";
constexpr std::string_view kSegment = "# segment ";
/// Rotations in all known files have at least four significant digits; a matrix with a larger deviation is not a
/// rotation.
constexpr double kRotationInFiles = 1e-3;

/// Whether the stamps of a TUM file are nanoseconds, as ORB-SLAM3 writes them for EuRoC: no clock shows so many
/// seconds.
bool are_nanoseconds(const std::string& word) { return word.find_first_of(".eE") >= 16 && word.size() >= 16; }

/// Nanoseconds, or seconds where they have a point.
std::int64_t stamp_of(const std::string& word, const std::string& file, int line) {
  const std::size_t point = word.find('.');
  if (are_nanoseconds(word) || point == std::string::npos)
    return data::parse_nanoseconds(word.substr(0, point), file, line);
  return data::parse_seconds(word, file, line);
}

StampedPose tum_pose(const data::Line& line, const std::string& path) {
  const auto v = data::parse_row(line, path, 8, kTumColumns);
  const std::string stamp = data::split(line.text)[0];
  return {are_nanoseconds(stamp) ? data::parse_nanoseconds(stamp.substr(0, stamp.find('.')), path, line.number)
                                 : data::parse_seconds(stamp, path, line.number),
          data::stated_pose({v[1], v[2], v[3]}, {v[7], v[4], v[5], v[6]}, "qx qy qz qw", path, line.number)};
}

}  // namespace

namespace data {

Eigen::Isometry3d stated_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& rotation, const char* order,
                              const std::string& file, int line) {
  if (std::abs(rotation.norm() - 1) > kRotationInFiles)
    fail(file, line, "a quaternion of length " + std::to_string(rotation.norm()),
         std::string("a unit quaternion ") + order);
  Eigen::Isometry3d pose(rotation.normalized());
  pose.translation() = position;
  return pose;
}

Trajectory read_euroc_poses(const std::string& file) {
  const std::string expected = "timestamp [ns], p_x, p_y, p_z, q_w, q_x, q_y, q_z, ...";
  constexpr std::size_t kColumns = 8;
  Trajectory trajectory;
  for (const auto& line : table_lines(file)) {
    const auto cells = split(line.text, ", \t\r");
    if (cells.size() == 4)
      fail(file, line.number, "a position without orientation, as EuRoC's leica0 has it",
           "poses, as state_groundtruth_estimate0, vicon0 and mocap0 have them (" + expected + ")");
    if (cells.size() < kColumns) fail(file, line.number, in_quotes(line.text), expected);
    double v[kColumns];
    for (std::size_t i = 1; i < kColumns; ++i) v[i] = parse_number(cells[i], file, line.number, expected);
    trajectory.push_back(
        {stamp_of(cells[0], file, line.number),
         stated_pose({v[1], v[2], v[3]}, {v[4], v[5], v[6], v[7]}, "q_w q_x q_y q_z", file, line.number)});
  }
  return trajectory;
}

const StampedPose* pose_at(const Trajectory& poses, std::int64_t stamp_ns, std::int64_t tolerance_ns) {
  const auto later =
      std::lower_bound(poses.begin(), poses.end(), stamp_ns,
                       [](const StampedPose& pose, std::int64_t stamp) { return pose.stamp_ns < stamp; });
  const auto distance = [&](Trajectory::const_iterator pose) { return std::abs(pose->stamp_ns - stamp_ns); };
  auto nearest = later;
  if (later != poses.begin() && (later == poses.end() || distance(std::prev(later)) < distance(later)))
    nearest = std::prev(later);
  return nearest != poses.end() && distance(nearest) <= tolerance_ns ? &*nearest : nullptr;
}

std::string tum_header() { return "# timestamp[s] tx ty tz[m] qx qy qz qw: world_from_left_camera\n"; }

std::string tum_segment(int segment) {
  return std::string(kSegment) + std::to_string(segment) + ": the motion since the poses above is unknown\n";
}

std::optional<int> announced_segment(std::string_view line) {
  if (line.substr(0, kSegment.size()) != kSegment) return std::nullopt;
  line.remove_prefix(kSegment.size());
  int segment = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), segment);
  const bool is_number = error == std::errc() && segment >= 0 && (end == line.data() + line.size() || *end == ':');
  return is_number ? std::optional<int>(segment) : std::nullopt;
}

std::string tum_row(const StampedPose& pose) {
  Eigen::Quaterniond rotation(pose.world_from_left.linear());
  rotation.normalize();
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  std::string text = format_seconds(pose.stamp_ns);
  for (int i = 0; i < 3; ++i) text += ' ' + format_exact(pose.world_from_left.translation()[i]);
  for (int i = 0; i < 4; ++i) text += ' ' + format_exact(rotation.coeffs()[i]);
  return text + '\n';
}

std::string kitti_row(const StampedPose& pose) {
  std::string text;
  for (int i = 0; i < 12; ++i) {
    text += format_exact(pose.world_from_left.matrix()(i / 4, i % 4));
    text += i == 11 ? '\n' : ' ';
  }
  return text;
}

}  // namespace data

void check_trajectory(const Trajectory& trajectory, const std::string& source) {
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const Eigen::Isometry3d& pose = trajectory[i].world_from_left;
    if (rotation_error(pose.linear()) <= kRotationInFiles && pose.translation().allFinite() && is_affine(pose))
      continue;
    throw DataError(source + ": found pose " + std::to_string(i) +
                    " that is not a rigid transform, expected a rotation and a translation of finite numbers");
  }
}

std::vector<Trajectory> split_segments(const Trajectory& trajectory) {
  std::vector<Trajectory> segments;
  for (const StampedPose& pose : trajectory) {
    if (segments.empty() || segments.back().back().segment != pose.segment) segments.emplace_back();
    segments.back().push_back(pose);
  }
  return segments;
}

Trajectory read_tum(const std::string& path) {
  Trajectory trajectory;
  int segment = 0;
  for (const auto& line : data::text_lines(path)) {
    if (const auto next = data::announced_segment(line.text)) {
      if (*next <= segment) {
        data::fail(path, line.number, "segment " + std::to_string(*next) + " after segment " + std::to_string(segment),
                   "increasing numbers");
      }
      segment = *next;
    }
    if (!data::has_data(line)) continue;
    trajectory.push_back(tum_pose(line, path));
    trajectory.back().segment = segment;
    const std::size_t count = trajectory.size();
    const bool starts_segment =
        count > 1 && trajectory[count - 2].segment != segment;  // where a clock may have been set
    if (count > 1 && !starts_segment && trajectory[count - 1].stamp_ns <= trajectory[count - 2].stamp_ns) {
      data::fail_order(path, line.number, trajectory[count - 1].stamp_ns, trajectory[count - 2].stamp_ns);
    }
  }
  return trajectory;
}

void write_tum(const std::string& path, const Trajectory& trajectory) {
  std::string text = data::tum_header();
  int segment = 0;
  for (const auto& pose : trajectory) {
    if (pose.segment != segment) text += data::tum_segment(segment = pose.segment);
    text += data::tum_row(pose);
  }
  data::write_atomically(path, text);
}

Trajectory read_kitti(const std::string& path, const std::vector<std::int64_t>& stamps_ns) {
  const auto lines = data::data_lines(path);
  if (!stamps_ns.empty() && stamps_ns.size() != lines.size()) {
    data::fail(path, data::counted(lines.size(), "pose"), std::to_string(stamps_ns.size()) + ", one per timestamp");
  }
  Trajectory trajectory;
  for (const auto& line : lines) {
    const auto values = data::parse_row(line, path, 12, kKittiColumns);
    StampedPose pose;
    pose.stamp_ns = stamps_ns.empty() ? static_cast<std::int64_t>(trajectory.size()) : stamps_ns[trajectory.size()];
    for (int i = 0; i < 12; ++i) pose.world_from_left.matrix()(i / 4, i % 4) = values[static_cast<std::size_t>(i)];
    const double deviation = rotation_error(pose.world_from_left.linear());
    if (deviation > kRotationInFiles) {
      data::fail(path, line.number, "a 3 x 3 part that is not a rotation (deviation " + printed("%f", deviation) + ")",
                 kKittiColumns);
    }
    trajectory.push_back(pose);
  }
  return trajectory;
}

void write_kitti(const std::string& path, const Trajectory& trajectory) {
  std::string text;
  for (const auto& pose : trajectory) text += data::kitti_row(pose);
  data::write_atomically(path, text);
}

Trajectory read_trajectory(const std::string& path) {
  const auto lines = data::table_lines(path);
  if (lines.empty()) data::fail(path, "no pose", std::string("rows of ") + kTumColumns + " or of " + kKittiColumns);
  if (lines[0].text.find(',') != std::string::npos) {
    const std::size_t cells = data::split(lines[0].text, ", \t").size();
    if (cells == 12) data::fail(path, lines[0].number, "12 columns with commas", "KITTI's matrices, without commas");
    const bool is_truth = std::filesystem::path(path).filename() == "data.csv";
    Trajectory trajectory = is_truth ? data::read_euroc_truth(path) : data::read_euroc_poses(path);
    for (std::size_t i = 1; i < trajectory.size(); ++i) {
      if (trajectory[i].stamp_ns > trajectory[i - 1].stamp_ns) continue;
      data::fail(path, lines[i].number,
                 "timestamp " + std::to_string(trajectory[i].stamp_ns) + " after " +
                     std::to_string(trajectory[i - 1].stamp_ns),
                 "increasing timestamps");
    }
    return trajectory;
  }
  const std::size_t columns = data::split(lines[0].text).size();
  if (columns == 8) return read_tum(path);
  if (columns == 12) return read_kitti(path);
  data::fail(path, lines[0].number, std::to_string(columns) + " columns", "8 (TUM), 12 (KITTI), or EuRoC's CSV");
}

}  // namespace quadedge
