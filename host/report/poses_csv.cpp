#include "report/poses_csv.hpp"

#include "data/text.hpp"

namespace quadedge::report {
namespace {

using Value = std::optional<double>;
using Covariance = const std::optional<PoseCovariance>& (*)(const FrameResult&);

constexpr std::array<const char*, 6> kErrorNames = {"x", "y", "z", "rx", "ry", "rz"};

FrameColumns columns_of_poses() {
  FrameColumns columns;
  const auto add = [&](const std::string& name, std::function<Value(const FrameResult&)> value) {
    columns.push_back({name, [value = std::move(value)](const NumberedFrame& frame) {
                         const Value found = value(frame.result);
                         return found ? data::format_exact(*found) : std::string();
                       }});
  };
  const auto add_covariance = [&](const std::string& prefix, Covariance covariance) {
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) {
        add(prefix + kErrorNames[static_cast<std::size_t>(i)] + "_" + kErrorNames[static_cast<std::size_t>(j)],
            [=](const FrameResult& result) {
              const auto& matrix = covariance(result);
              return matrix ? Value((*matrix)(i, j)) : Value();
            });
      }
    }
  };
  columns.push_back({"frame", [](const NumberedFrame& frame) { return std::to_string(frame.number); }});
  columns.push_back(
      {"stamp_s", [](const NumberedFrame& frame) { return data::format_seconds(frame.result.stamp_ns); }});
  columns.push_back({"status", [](const NumberedFrame& frame) { return to_string(frame.result.status); }});
  columns.push_back({"segment", [](const NumberedFrame& frame) { return std::to_string(frame.result.segment); }});
  columns.push_back(
      {"reference_frame", [](const NumberedFrame& frame) { return std::to_string(frame.result.reference_frame); }});
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i)
    add(kPoseColumns[i], [i](const FrameResult& result) { return Value(pose_value(result.pose_or_prediction(), i)); });
  for (std::size_t i = 0; i < kPoseColumns.size(); ++i) {
    add(std::string("reference_") + kPoseColumns[i], [i](const FrameResult& result) {
      return result.current_from_reference ? Value(pose_value(result.current_from_reference->inverse(), i)) : Value();
    });
  }
  add_covariance("covariance_",
                 [](const FrameResult& result) -> const std::optional<PoseCovariance>& { return result.covariance; });
  add_covariance("reference_covariance_", [](const FrameResult& result) -> const std::optional<PoseCovariance>& {
    return result.diagnostics.covariance_in_reference;
  });
  return columns;
}

}  // namespace

double pose_value(const Eigen::Isometry3d& pose, std::size_t i) {
  if (i < 3) return pose.translation()[static_cast<Eigen::Index>(i)] + 0.0;  // no negative zero
  Eigen::Quaterniond rotation(pose.linear());
  rotation.normalize();
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  return rotation.coeffs()[static_cast<Eigen::Index>(i - 3)];
}

const FrameColumns& poses_csv_columns() {
  static const FrameColumns all = columns_of_poses();
  return all;
}

CsvTable read_poses_csv(const std::string& file) { return {file, "a poses.csv of `quadedge run`"}; }

}  // namespace quadedge::report
