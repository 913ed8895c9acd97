#include "data/trajectory_rows.hpp"

#include "data/text.hpp"

namespace quadedge::data {

std::string tum_header() { return "# timestamp[s] tx ty tz[m] qx qy qz qw: world_from_left_camera\n"; }

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
