#include "report/poses_csv.hpp"

#include <array>

#include "data/text.hpp"

namespace quadedge::report {
namespace {

constexpr std::array<const char*, 7> kPose = {"x", "y", "z", "qx", "qy", "qz", "qw"};
constexpr std::array<const char*, 6> kErrorNames = {"x", "y", "z", "rx", "ry", "rz"};

std::string pose_header(const std::string& prefix) {
  std::string text;
  for (const char* name : kPose) text += "," + prefix + name;
  return text;
}

std::string covariance_header(const std::string& prefix) {
  std::string text;
  for (std::size_t i = 0; i < kErrorNames.size(); ++i) {
    for (std::size_t j = i; j < kErrorNames.size(); ++j) text += "," + prefix + kErrorNames[i] + "_" + kErrorNames[j];
  }
  return text;
}

std::string pose_fields(const Eigen::Isometry3d& pose) {
  Eigen::Quaterniond rotation(pose.linear());
  rotation.normalize();
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  std::string text;
  for (int i = 0; i < 3; ++i) text += "," + data::format_exact(pose.translation()[i] + 0.0);  // no negative zero
  for (int i = 0; i < 4; ++i) text += "," + data::format_exact(rotation.coeffs()[i]);
  return text;
}

std::string covariance_fields(const std::optional<PoseCovariance>& covariance) {
  std::string text;
  for (int i = 0; i < 6; ++i) {
    for (int j = i; j < 6; ++j) text += "," + (covariance ? data::format_exact((*covariance)(i, j)) : std::string());
  }
  return text;
}

}  // namespace

PosesCsv::PosesCsv(const std::string& path) : file_(path) {
  file_.append("frame,stamp_s,status,reference_frame" + pose_header("") + pose_header("reference_") +
               covariance_header("covariance_") + covariance_header("reference_covariance_") + "\n");
}

void PosesCsv::add(const FrameResult& result) {
  std::string text = std::to_string(frames_++) + "," + data::format_seconds(result.stamp_ns) + "," +
                     to_string(result.status) + "," + std::to_string(result.reference_frame);
  text += pose_fields(result.world_from_left);
  text +=
      is_tracked(result.status) ? pose_fields(result.current_from_reference.inverse()) : std::string(kPose.size(), ',');
  text += covariance_fields(result.covariance_in_world) + covariance_fields(result.covariance_in_reference);
  file_.append(text + "\n");
}

}  // namespace quadedge::report
