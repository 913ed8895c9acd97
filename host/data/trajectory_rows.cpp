#include "data/trajectory_rows.hpp"

#include <charconv>
#include <system_error>

#include "data/text.hpp"

namespace quadedge::data {
namespace {

constexpr std::string_view kSegment = "# segment ";

}  // namespace

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

}  // namespace quadedge::data
