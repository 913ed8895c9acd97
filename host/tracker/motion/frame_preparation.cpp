/// \file frame_preparation.cpp  Runs the front end, judges the rig, updates its rows; reports each warning once.
#include "motion/frame_preparation.hpp"

#include <utility>

#include "common/printed.hpp"
#include "geometry/disparity_range.hpp"

namespace quadedge::odometry {

void check_usable(const StereoRig& rig, const Config& config) {
  check_rig(rig, "stereo rig");
  if (!has_disparity_range(config.stereo)) check_disparity_range(rig, "stereo rig");
  check_config(config);
}

FramePreparation::FramePreparation(const StereoRig& recorded, const StereoRig& rig, Device& device,
                                   const Config& config)
    : recorded_(recorded),
      min_edges_(config.pose.min_inliers),
      checks_rig_(!config.is_paper()),
      rows_(std::make_unique<rig::RectificationFollower>(rig, config.stereo)),
      frontend_(frontend::make_frontend(rig, device, config, &warnings_)),
      new_monitor_([&rig, masks = config.odometry.auto_mask] { return std::make_unique<rig::RigMonitor>(rig, masks); }),
      rig_monitor_(new_monitor_()) {
  frontend_->correct_rows(rows_.get());
}

/// The previous frame is recycled unless somebody holds it.
frontend::FrameEdgesHandle FramePreparation::process(const StereoFrame& frame, RigEstimate rig) {
  current_ = nullptr;
  current_ = frontend_->process(frame);
  rig.rows = rows_->error();
  current_->set_rig(rig);
  return current_;
}

rig::RigReport FramePreparation::judge(const StereoFrame& frame) {
  if (!checks_rig_) return {};
  const frontend::FrontendCounts& counts = frontend_->counts();
  return rig_monitor_->judge(frontend_->searched(frame), current_->edges, counts.edges_left, counts.disparity_range,
                             current_->rig(), frontend_->hidden_in_frame());
}

void FramePreparation::adopt(const rig::RigReport& report, const std::optional<Eigen::Isometry3d>& current_from_last) {
  if (report.matches == nullptr) return;
  const double change = rows_->observe(*report.matches);
  // A camera that has just turned displaces points once, whatever moves then, which a late camera does with all motion.
  if (current_from_last && !rows_->is_contradicted()) {
    if (const auto late = rig_monitor_->observe_motion(*current_from_last)) warn(late->warning);
  }
  if (change == 0) return;
  rig_monitor_->forget_motions();
  const std::string text = printed(
      "points lie %.1f px off the epipolar lines of earlier frames: has a camera turned? The row model is reestimated",
      change);
  warn({WarningKind::changed_rig, text});
}

std::optional<FrameFault> FramePreparation::fault(const rig::RigReport& report) {
  const auto* mismatch = report.mismatch();
  if (mismatch == nullptr && !frontend_->is_smoothed())  // noise alone displaces patches by as much as a warning takes
    for (const auto& finding : report.findings) warn(finding.warning);
  if (!has_enough_edges()) {
    std::string text = std::to_string(current_->edges.size()) + " stereo edges";
    for (const auto& finding : report.findings)
      if (finding.is_mismatch || finding.warning.kind == WarningKind::poor_images) text += "; " + finding.warning.text;
    return FrameFault{FrameStatus::lost_too_few_edges, text};
  }
  if (mismatch != nullptr) return FrameFault{FrameStatus::lost_rig_mismatch, mismatch->warning.text};
  return std::nullopt;
}

void FramePreparation::restart() {
  rig_monitor_ = new_monitor_();
  frontend_->hide({});
  reported_.clear();
}

std::vector<Warning> FramePreparation::new_warnings() {
  std::vector<Warning> wanted;
  for (Warning& warning : std::exchange(warnings_, {}))
    if (reported_.count(warning.kind) == 0) wanted.push_back(std::move(warning));
  for (const Warning& warning : wanted) reported_.insert(warning.kind);
  return wanted;
}

}  // namespace quadedge::odometry
