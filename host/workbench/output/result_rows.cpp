/// \file result_rows.cpp  Every field is added with its name, so that a default item gives the heading.
#include "output/result_rows.hpp"

#include <Eigen/Geometry>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>

#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "common/timing.hpp"
#include "data/atomic_file.hpp"
#include "data/text.hpp"
#include "data/trajectory_rows.hpp"
#include "output/config_toml.hpp"
#include "output/json.hpp"
#include "output/output_folder.hpp"
#include "output/run_record.hpp"
#include "quadedge/error.hpp"
#include "quadedge/result_files.hpp"

namespace quadedge::report {
namespace {

constexpr int kDecimals = 6;  // of edges

/// Quoted where needed; line breaks become spaces.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c == '\n' || c == '\r' ? ' ' : c;
  }
  return quoted + "\"";
}

std::string csv_line(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) line += (i == 0 ? "" : ",") + csv_field(fields[i]);
  return line + "\n";
}

/// One record: every field with the name of its column.
class CsvRow {
 public:
  void add(std::string name, std::string field) {
    names_.push_back(std::move(name));
    fields_.push_back(std::move(field));
  }
  void add(std::string name, std::int64_t value) { add(std::move(name), std::to_string(value)); }
  std::string heading() const { return csv_line(names_); }
  std::string line() const { return csv_line(fields_); }

 private:
  std::vector<std::string> names_, fields_;
};

/// Empty for NaN.
std::string rounded(const char* format, double value) {
  return std::isfinite(value) ? printed(format, value) : std::string();
}

std::string exact(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? data::format_exact(*value) : std::string();
}

/// Time that a frame spent in a stage [ms]; NaN where it did not reach it.
double stage_ms(const FrameResult& result, const std::string& stage) {
  double sum = kNan;
  for (const auto& part : result.timing.stages) {
    if (part.stage == stage) sum = (std::isnan(sum) ? 0 : sum) + part.ms;
  }
  return sum;
}

void add_pose(CsvRow& row, const std::string& prefix, const std::optional<Eigen::Isometry3d>& pose) {
  const Eigen::Vector3d position = pose ? Eigen::Vector3d(pose->translation()) : Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation(pose ? Eigen::Matrix3d(pose->linear()) : Eigen::Matrix3d::Identity());
  rotation.normalize();
  if (rotation.w() < 0) rotation.coeffs() *= -1;
  const auto add = [&](const char* name, double value) {
    row.add(prefix + name, pose ? data::format_exact(value) : std::string());
  };
  add("x", position.x() + 0.0);  // no negative zero
  add("y", position.y() + 0.0);
  add("z", position.z() + 0.0);
  add("qx", rotation.x());
  add("qy", rotation.y());
  add("qz", rotation.z());
  add("qw", rotation.w());
}

void add_covariance(CsvRow& row, const std::string& prefix, const std::optional<PoseCovariance>& covariance) {
  constexpr std::array<const char*, 6> kNames = {"x", "y", "z", "rx", "ry", "rz"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    for (std::size_t j = i; j < kNames.size(); ++j) {
      row.add(prefix + kNames[i] + "_" + kNames[j],
              covariance ? data::format_exact((*covariance)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)))
                         : std::string());
    }
  }
}

CsvRow error_row(const TrajectoryEvaluation::PerPose& pose) {
  CsvRow row;
  row.add("stamp_s", data::format_seconds(pose.stamp_ns));
  row.add("ape_rotation_deg", exact(pose.ape_rotation_deg));
  row.add("ape_translation_m", exact(pose.ape_translation_m));
  row.add("rpe_rotation_deg", exact(pose.rpe_rotation_deg));
  row.add("rpe_translation_m", exact(pose.rpe_translation_m));
  return row;
}

CsvRow loop_row(const Closure& closure) {
  CsvRow row;
  row.add("frame", closure.frame);
  row.add("other", closure.other);
  row.add("verdict", std::string(to_string(closure.verdict)));
  row.add("similarity", data::format_exact(closure.similarity));
  row.add("inliers", closure.inliers);
  row.add("support", data::format_exact(closure.support));
  std::optional<Eigen::Isometry3d> motion;
  if (closure.frame_from_other) motion = closure.frame_from_other->inverse();
  add_pose(row, "", motion);
  row.add("deviation", exact(closure.deviation));
  row.add("distance_m", exact(closure.distance_m));
  row.add("angle_deg", exact(closure.angle_deg));
  return row;
}

template <class Item>
std::string table(const std::vector<Item>& items, CsvRow (*row)(const Item&)) {
  std::string text = row({}).heading();
  for (const Item& item : items) text += row(item).line();
  return text;
}

/// Fields of one edge, separated by commas.
std::string decimals(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + data::format_fixed(value, kDecimals);
  return text;
}

/// Left, top, right and bottom, separated by spaces; empty without a box.
std::string box_text(const std::optional<Eigen::Vector4d>& box) {
  if (!box) return "";
  std::string text;
  for (const double side : {(*box)[0], (*box)[1], (*box)[2], (*box)[3]})
    text += (text.empty() ? "" : " ") + printed("%.0f", side);
  return text;
}

/// The first fields of a frame's row.
template <class Result>
CsvRow started_row(int number, const Result& result) {
  CsvRow row;
  row.add("frame", number);
  row.add("stamp_s", data::format_seconds(result.stamp_ns));
  row.add("status", std::string(to_string(result.status)));
  return row;
}

CsvRow frames_row(int number, const FrameResult& result) {
  CsvRow row = started_row(number, result);
  row.add("segment", result.segment);
  row.add("key_rig", result.reference_frame);
  row.add("new_key_rig", result.new_key_rig ? 1 : 0);
  row.add("edge_threshold", rounded("%.4g", result.diagnostics.edge_threshold));
  row.add("disparity_range", rounded("%.4g", result.diagnostics.disparity_range));
  row.add("disparity_error", rounded("%.3f", result.rig.disparity_error));
  for (const auto& [name, count] : named_counts(result.counts)) row.add(name, count);
  row.add("matched_ratio", rounded("%.4g", result.diagnostics.rig_evidence.matched_ratio));
  row.add("epipolar_residual", rounded("%.4g", result.diagnostics.rig_evidence.epipolar_residual));
  row.add("moving_ratio", rounded("%.4g", result.diagnostics.moving_ratio));
  row.add("moving_cells", result.diagnostics.moving_cells);
  row.add("moving_box", box_text(result.diagnostics.moving_box));
  row.add("ambiguous_motion", result.ambiguous_motion ? 1 : 0);
  row.add("latency_ms", rounded("%.3f", result.timing.latency_ms));
  for (const char* stage : kHostStages) row.add(std::string(stage) + "_ms", rounded("%.3f", stage_ms(result, stage)));
  row.add("warning", joined(result.warnings));
  row.add("message", result.message);
  return row;
}

CsvRow poses_row(int number, const FrameResult& result) {
  CsvRow row = started_row(number, result);
  row.add("segment", result.segment);
  row.add("reference_frame", result.reference_frame);
  add_pose(row, "", result.pose_or_prediction());
  std::optional<Eigen::Isometry3d> in_reference;
  if (result.current_from_reference) in_reference = result.current_from_reference->inverse();
  add_pose(row, "reference_", in_reference);
  add_covariance(row, "covariance_", result.covariance);
  add_covariance(row, "reference_covariance_", result.diagnostics.covariance_in_reference);
  row.add("base_frame", result.diagnostics.base_frame);
  return row;
}

CsvRow locations_row(int number, const Localisation& frame) {
  const bool located = frame.map_from_left.has_value();
  const auto add_located = [&](CsvRow& row, const char* name, const std::string& field) {
    row.add(name, located ? field : std::string());
  };
  CsvRow row = started_row(number, frame);
  add_located(row, "key_rig", std::to_string(frame.key_rig));
  add_located(row, "followed", frame.is_followed ? "1" : "0");
  add_located(row, "inliers", std::to_string(frame.inliers));
  add_located(row, "support", data::format_exact(frame.support));
  add_pose(row, "", frame.map_from_left);
  row.add("latency_ms", data::format_exact(frame.latency_ms));
  row.add("warning", joined(frame.warnings));
  row.add("message", frame.message);
  return row;
}

}  // namespace

AppendFile::AppendFile(std::string path) : path_(std::move(path)), stream_(path_, std::ios::binary) {
  if (!stream_) fail("opened for writing");
}

void AppendFile::append(const std::string& text) {
  if (!(stream_ << text << std::flush)) fail("written");
}

void AppendFile::fail(const char* what) const {
  throw DataError(path_ + ": cannot be " + what + ": " + std::strerror(errno));
}

GrowingFiles::GrowingFiles(const std::string& folder)
    : tum_(folder + "/trajectory.txt"),
      kitti_(folder + "/trajectory_kitti.txt"),
      frames_(folder + "/frames.csv"),
      poses_(folder + "/poses.csv") {
  tum_.append(data::tum_header());
  frames_.append(frames_row(0, {}).heading());
  poses_.append(poses_row(0, {}).heading());
}

void GrowingFiles::add(const FrameResult& result) {
  const StampedPose pose{result.stamp_ns, result.pose_or_prediction(), result.segment};
  if (result.segment != segment_) tum_.append(data::tum_segment(segment_ = result.segment));
  if (is_tracked(result.status)) tum_.append(data::tum_row(pose));
  kitti_.append(data::kitti_row(pose));
  frames_.append(frames_row(number_, result).line());
  poses_.append(poses_row(number_, result).line());
  ++number_;
}

LocationFiles::LocationFiles(const std::string& folder)
    : trajectory_(folder + "/trajectory.txt"), rows_(folder + "/locations.csv") {
  trajectory_.append(data::tum_header());
  rows_.append(locations_row(0, {}).heading());
}

void LocationFiles::add(int number, const Localisation& frame) {
  if (frame.map_from_left) trajectory_.append(data::tum_row({frame.stamp_ns, *frame.map_from_left}));
  rows_.append(locations_row(number, frame).line());
}

std::string errors_csv(const TrajectoryEvaluation& evaluation) { return table(evaluation.per_pose, error_row); }

std::string loops_csv(const std::vector<Closure>& closures) { return table(closures, loop_row); }

std::string edges_csv(const EdgeSet& edges) {
  std::string text = "x,y,direction_rad,strength\n";
  for (std::size_t i = 0; i < edges.size(); ++i)
    text += decimals({edges.x[i], edges.y[i], edges.direction[i], edges.strength[i]}) + "\n";
  return text;
}

std::string matches_csv(const StereoMatches& matches, bool depths) {
  const StereoEdges& edges = matches.edges;
  std::string text = "left_x,left_y,left_direction_rad,right_x,right_y,right_direction_rad,ncc,x_m,y_m,z_m\n";
  for (std::size_t i = 0; i < edges.size(); ++i) {
    text += decimals({edges.left_x[i], edges.left_y[i], edges.left_direction[i], edges.right_x[i], edges.right_y[i],
                      edges.right_direction[i], edges.ncc[i]}) +
            ",";
    const auto& point = matches.points[i];
    text += depths && point ? decimals({point->position.x(), point->position.y(), point->position.z()}) : ",,";
    text += '\n';
  }
  return text;
}

}  // namespace quadedge::report

namespace quadedge {

struct ResultFiles::Open {
  Open(const std::string& path, bool force) : folder(path), lock(report::prepare_output_folder(path, force)) {}

  std::string folder;
  report::FolderLock lock;
  report::RunRecord run;
  report::GrowingFiles rows{folder};
};

ResultFiles::ResultFiles(const std::string& folder, const StereoOdometry& odometry, const ResultOrigin& origin,
                         bool force)
    : open_(std::make_unique<Open>(folder, force)) {
  report::RunRecord& run = open_->run;
  run.command = origin.command;
  run.input.format = "live";
  run.input.name = run.input.path = origin.name;
  run.input.width = odometry.rig().left.width;
  run.input.height = odometry.rig().left.height;
  run.device = odometry.device();
  run.self_test.verdict = "not run";
  run.config = odometry.config();
  run.variants = odometry.variants();
  run.start_ms = run.kernel_build_ms = odometry.kernel_build_ms();
  run.device_peak_mb = static_cast<double>(odometry.device_bytes()) / (1024.0 * 1024.0);
  data::write_atomically(folder + "/config.toml", report::config_toml(run.config, run.device.name));
}

ResultFiles::~ResultFiles() = default;
ResultFiles::ResultFiles(ResultFiles&&) noexcept = default;

void ResultFiles::add(const FrameResult& result) {
  open_->rows.add(result);
  open_->run.frames.push_back(result);
}

void ResultFiles::finish(const std::string& ended_early) {
  report::RunRecord& run = open_->run;
  run.ended_early = ended_early;
  run.input.frames = static_cast<int>(run.frames.size());
  run.host_peak_mb = host_peak_mb();
  data::write_atomically(open_->folder + "/report.json", report::report_json(run));
}

}  // namespace quadedge
