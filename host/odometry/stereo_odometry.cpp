/// \file stereo_odometry.cpp  The processing of a frame (doc/design.md section 1), from two images to a pose.
#include <chrono>
#include <cmath>
#include <set>
#include <tbb/task_group.h>
#include <utility>

#include "common/disparity_range.hpp"
#include "common/equal_scale.hpp"
#include "common/host_stages.hpp"
#include "common/recorded_images.hpp"
#include "frontend/frontend.hpp"
#include "motion/disparity_offset.hpp"
#include "motion/motion_search.hpp"
#include "odometry/constant_velocity.hpp"
#include "odometry/current_rig.hpp"
#include "odometry/key_rig.hpp"
#include "odometry/tracking_state.hpp"
#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "pose/relative_pose.hpp"
#include "pose/rig_uncertainty.hpp"
#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/tap.hpp"
#include "rig_check/rig_monitor.hpp"

namespace quadedge {
namespace {

/// Milliseconds since the previous lap, steady clock.
class StageClock {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

FrameStatus lost_status(pose::MotionStatus status) {
  return status == pose::MotionStatus::too_few_quads ? FrameStatus::lost_too_few_quads : FrameStatus::lost_no_consensus;
}

void add_message(const std::string& message, FrameResult& result) {
  result.message += (result.message.empty() ? "" : "; ") + message;
}

/// The configuration, if it and the rig are valid. \throws DataError, UsageError.
Config checked(const StereoRig& rig, Config config) {
  check_rig(rig, "stereo rig");
  if (!has_disparity_range(config.stereo)) check_disparity_range(rig, "stereo rig");
  check_config(config);
  return config;
}

}  // namespace

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::first: return "first";
    case FrameStatus::tracked: return "tracked";
    case FrameStatus::lost_too_few_edges: return "lost_too_few_edges";
    case FrameStatus::lost_too_few_quads: return "lost_too_few_quads";
    case FrameStatus::lost_no_consensus: return "lost_no_consensus";
    case FrameStatus::lost_rig_mismatch: return "lost_rig_mismatch";
  }
  return "unknown";
}

class StereoOdometry::Implementation {
 public:
  /// \param own the device if this object owns it, else null
  Implementation(const StereoRig& rig, std::unique_ptr<Device> own, Device& device, const Config& config)
      : recorded_(rig),
        rig_(with_equal_scales(rig)),
        own_device_(std::move(own)),
        device_(device),
        config_(config),
        frontend_(frontend::make_frontend(rig_, device, config, &start_warnings_)),
        offset_(rig_, config.pose),
        motion_search_(config, *frontend_, offset_),
        rig_monitor_(rig_) {}

  FrameResult track(const StereoFrame& frame);
  FrameDetails details() const;

  const StereoEdges& stereo_edges() const {
    static const StereoEdges none;
    return current_ ? current_->edges : none;
  }
  odometry::CurrentRig current_rig() const { return {*frontend_, current_, offset_}; }
  const StereoRig& rig() const { return rig_; }
  frontend::Frontend& frontend() const { return *frontend_; }
  Device& device() const { return device_; }
  const Config& config() const { return config_; }

 private:
  /// The motion of the current rig, found before it is known whether the frame can be used. Until adopt() it changes
  /// nothing.
  struct FoundMotion {
    motion::StepHandle step;  ///< null if none was searched for
    bool is_from_lost_rig = false;
    double pose_ms = 0;
  };

  void process(const StereoFrame& frame, FrameResult& result);
  void start(FrameResult& result);
  FoundMotion search();
  void adopt(FoundMotion& found, FrameResult& result);
  void start_segment(FrameResult& result);
  void locate(const motion::MotionStep& step, FrameResult& result);
  void lose(FrameStatus status, const std::string& message, FrameResult& result);
  void take(const rig_check::RigReport& report, FrameResult& result) const;
  void warn(const Warning& warning, FrameResult& result) const;

  RecordedImages recorded_;
  StereoRig rig_;  ///< the cameras in which edges are detected
  std::unique_ptr<Device> own_device_;
  Device& device_;
  Config config_;
  std::vector<Warning> start_warnings_;  ///< for the first frame
  std::unique_ptr<frontend::Frontend> frontend_;
  motion::DisparityOffset offset_;
  motion::MotionSearch motion_search_;
  rig_check::RigMonitor rig_monitor_;

  odometry::TrackingState state_;
  odometry::ConstantVelocity velocity_;
  frontend::RigHandle current_;  ///< of the last frame tracked; null before the first frame
  motion::StepHandle step_;      ///< its motion; null if none was searched for
  std::optional<std::int64_t> last_stamp_ns_;
  std::vector<double> distances_;   ///< buffer of median_parallax()
  std::set<WarningKind> reported_;  ///< kinds of warnings of the frames before
};

FrameResult StereoOdometry::Implementation::track(const StereoFrame& frame) {
  recorded_.check(frame.left, frame.right);
  if (last_stamp_ns_ && frame.stamp_ns < *last_stamp_ns_) {
    throw DataError("timestamp " + std::to_string(frame.stamp_ns) + " ns goes back, expected at least " +
                    std::to_string(*last_stamp_ns_) + " ns, the timestamp of the previous frame");
  }
  last_stamp_ns_ = frame.stamp_ns;
  StageClock latency, clock;
  FrameResult result;
  result.stamp_ns = frame.stamp_ns;

  process(frame, result);
  const bool has_edges = result.counts.stereo_edges >= config_.pose.min_inliers;
  // The images are checked on a processor that the search leaves idle. An error in the search waits for the check.
  rig_check::RigReport rig_report;
  tbb::task_group beside;
  beside.run([&] {
    rig_report = rig_monitor_.judge(frame, current_->edges, result.counts.edges_left,
                                    result.diagnostics.disparity_range, frontend_->counts().epipolar_correction);
  });
  double stereo_ms = clock.lap();
  FoundMotion found = has_edges && state_.has_started() ? search() : FoundMotion();
  const double search_ms = clock.lap();
  beside.wait();
  stereo_ms += clock.lap();
  result.timing.stages.push_back({kStereoStage, stereo_ms});
  take(rig_report, result);
  if (!has_edges) {
    lose(FrameStatus::lost_too_few_edges, std::to_string(result.counts.stereo_edges) + " stereo edges", result);
  } else if (const auto* mismatch = rig_report.mismatch()) {
    lose(FrameStatus::lost_rig_mismatch, rig_check::sentence(*mismatch), result);
  } else if (!state_.has_started()) {
    start(result);
  } else {
    adopt(found, result);
    result.timing.stages.push_back({kTemporalStage, search_ms - found.pose_ms});
    if (step_->ok()) {
      locate(*step_, result);
    } else {
      const std::string reason = step_->doubt.exists() ? "ambiguous motion after a loss: " + to_string(step_->doubt)
                                                       : pose::to_string(step_->motion.status);
      lose(lost_status(step_->motion.status), reason, result);
    }
    result.timing.stages.push_back({kPoseStage, found.pose_ms + clock.lap()});
  }
  if (result.world_from_left) frontend_->take(rig_report.fit);
  result.segment = state_.segment;
  state_.world_from_last = result.pose_or_prediction();
  for (const Warning& warning : result.warnings) reported_.insert(warning.kind);
  result.timing.latency_ms = latency.lap();
  if (device_.context() != nullptr && device_.context()->profiling()) {
    for (const auto& row : device_.context()->take_profile())
      result.timing.kernels.push_back({row.stage, row.kernel_ms});
  }
  return result;
}

/// Turns the images into the current rig. The previous rig is recycled unless the state holds it.
void StereoOdometry::Implementation::process(const StereoFrame& frame, FrameResult& result) {
  step_ = nullptr;
  current_ = nullptr;
  current_ = frontend_->process(frame);
  const frontend::FrontendCounts& counts = frontend_->counts();
  result.warnings = std::exchange(start_warnings_, {});
  result.diagnostics.edge_threshold = counts.edge_threshold;
  result.diagnostics.disparity_range = counts.disparity_range;
  result.counts.edges_left = counts.edges_left;
  result.counts.edges_right = counts.edges_right;
  result.counts.stereo_edges = static_cast<int>(current_->edges.size());
  if (counts.dropped_edges == 0) return;
  result.diagnostics.overflow = true;
  result.message = std::to_string(counts.dropped_edges) + " edges beyond edges.max_edges were dropped";
}

/// Starts the trajectory at the first frame with edges.
void StereoOdometry::Implementation::start(FrameResult& result) {
  result.status = FrameStatus::first;
  result.world_from_left = state_.world_from_last;
  result.new_key_rig = true;
  result.reference_frame = current_->frame;
  result.current_from_reference = Eigen::Isometry3d::Identity();
  result.relative_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  result.covariance = result.diagnostics.covariance_in_reference = PoseCovariance::Zero();
  for (const auto& finding : rig_check::implausible_numbers(rig_)) warn(rig_check::warning(finding), result);
  state_.set_key(current_, {*result.world_from_left, PoseCovariance::Zero(), RigSensitivity::Zero()});
}

/// Finds the motion since the base. After a loss, when nothing is known of the motion, an ambiguous one is refused, and
/// the motion since the lost frame is tried.
StereoOdometry::Implementation::FoundMotion StereoOdometry::Implementation::search() {
  motion::MotionQuery query;
  query.current = current_;
  query.seed = config_.seed + static_cast<std::uint64_t>(current_->frame);
  query.base = state_.base.rig;
  query.prediction = velocity_.predict(current_->frame - state_.base.rig->frame);
  if (!state_.base_is_key()) {
    query.key = state_.key.rig();
    query.base_from_key = state_.base.from_key.transform;
  }
  FoundMotion found;
  found.step = motion_search_.find(query);
  const bool is_after_loss = current_->frame - state_.base.rig->frame > 1;
  if (is_after_loss && found.step->doubt.exists()) found.step->motion.status = pose::MotionStatus::no_consensus;
  if (!found.step->ok() && state_.lost) {
    query.base = state_.lost->rig;
    query.prediction = std::nullopt;
    motion::StepHandle relocalised = motion_search_.find(query);
    if (relocalised->ok()) {
      found.step = std::move(relocalised);
      found.is_from_lost_rig = true;
    }
  }
  found.pose_ms = motion_search_.take_pose_ms();
  return found;
}

/// Takes over the result of the search. If the motion was found from a lost frame, a segment starts.
void StereoOdometry::Implementation::adopt(FoundMotion& found, FrameResult& result) {
  step_ = std::move(found.step);
  motion_search_.remember(*step_);
  if (found.is_from_lost_rig) start_segment(result);
  result.counts.temporal_left = frontend_->counts().temporal_left;
  result.counts.temporal_right = frontend_->counts().temporal_right;
  result.counts.quads = static_cast<int>(step_->matches.size());
}

/// Makes the lost frame the key rig of a new segment, in which its predicted pose counts as exact.
void StereoOdometry::Implementation::start_segment(FrameResult& result) {
  const auto number = [](int of) { return std::to_string(of); };
  const int last = state_.base.rig->frame, lost = state_.lost->rig->frame, segment = ++state_.segment;
  state_.set_key(state_.lost->rig, {state_.lost->world_from_left, PoseCovariance::Zero(), RigSensitivity::Zero()},
                 odometry::PoseOrigin::predicted);
  add_message("segment " + number(segment) + " starts: relocalised against frame " + number(lost) +
                  ", whose pose was predicted",
              result);
  warn({WarningKind::unknown_motion, "the motion between frames " + number(last) + " and " + number(current_->frame) +
                                         " is unknown; the poses from here on are segment " + number(segment) +
                                         ", whose place relative to the earlier ones is a prediction"},
       result);
}

/// Locates the frame against the key rig or, if that is out of view, against the base; in the latter case the frame
/// becomes the key rig.
void StereoOdometry::Implementation::locate(const motion::MotionStep& step, FrameResult& result) {
  const bool by_key = step.base == state_.key.rig();
  pose::RelativePose current_from_key = step.motion.adopted();
  if (!by_key) current_from_key = current_from_key * state_.base.from_key;
  const Eigen::Isometry3d current_from_base = current_from_key.transform * state_.base.from_key.transform.inverse();
  const int frames = current_->frame - state_.base.rig->frame;
  velocity_.observe(current_from_base, frames);
  if (frames == 1) {
    if (const auto late = rig_monitor_.observe_motion(current_from_base)) warn(rig_check::warning(*late), result);
  }

  odometry::KeyRigFitness fitness;
  fitness.quads = static_cast<int>(step.matches.size());
  fitness.inlier_ratio = step.motion.inlier_ratio;
  fitness.median_parallax = odometry::median_parallax(step.base->edges, step.matches, distances_);
  fitness.rotation = Eigen::AngleAxisd(current_from_key.transform.linear()).angle();
  fitness.frames = current_->frame - state_.key.frame();

  result.status = FrameStatus::tracked;
  result.counts.inliers = step.motion.inliers;
  const pose::PoseAndOffset learned = step.motion.learned.value_or(pose::PoseAndOffset());
  result.disparity_offset = offset_.value() + learned.offset;
  result.disparity_offset_sigma = std::sqrt(learned.offset_variance > 0 ? learned.offset_variance : offset_.variance());
  if (const auto large = rig_check::judge_disparity_offset(offset_.value() + step.motion.offset))
    warn(rig_check::warning(*large), result);
  result.ambiguous_motion = step.doubt.exists();
  result.diagnostics.moving_ratio = step.verdict.moving_ratio;
  if (step.doubt.exists()) add_message("ambiguous motion: " + motion::to_string(step.doubt), result);
  result.diagnostics.base_frame = step.base->frame;
  result.diagnostics.search = step.matches.search;
  result.reference_frame = state_.key.frame();
  result.current_from_reference = current_from_key.transform;
  result.relative_covariance = current_from_key.covariance;
  pose::UncertainPose key_from_current = pose::pose_in_earlier(current_from_key);
  key_from_current.by_rig = pose::rig_sensitivity(key_from_current.fixed_from_camera, step.mean_inverse_depth());
  const pose::UncertainPose world_from_current = state_.key.pose() * key_from_current;
  result.diagnostics.rig_sensitivity = key_from_current.by_rig;
  result.diagnostics.covariance_in_reference = pose::whole_covariance(key_from_current, config_.pose);
  result.covariance = pose::whole_covariance(world_from_current, config_.pose);
  result.world_from_left = world_from_current.fixed_from_camera;
  result.new_key_rig = !config_.odometry.key_rig || !by_key || state_.key.needs_replacement(fitness, config_.odometry);

  state_.lost = std::nullopt;
  if (result.new_key_rig) {
    // All frames located against one key rig share its disparities, so that together they carry no more information
    // than the last, most distant one.
    offset_.update(learned.offset, learned.offset_variance, fitness.frames);
    state_.set_key(current_, world_from_current);
  } else {
    state_.base = {current_, current_from_key, key_from_current};
  }
}

/// Repeats the last motion. A lost frame that has edges is kept in addition to the base, which becomes the key rig; the
/// next frame may be located against either.
void StereoOdometry::Implementation::lose(FrameStatus status, const std::string& message, FrameResult& result) {
  result.status = status;
  add_message(message, result);
  if (state_.lost) velocity_.forget();  // lost twice in a row
  const auto repeated = velocity_.predict(1);
  result.predicted_world_from_left = repeated ? state_.world_from_last * repeated->inverse() : state_.world_from_last;
  result.reference_frame = state_.key.frame();
  if (status == FrameStatus::lost_too_few_edges || status == FrameStatus::lost_rig_mismatch) return;
  if (!state_.base_is_key()) state_.set_key(state_.base.rig, state_.world_from_base());
  state_.lost = odometry::LostRig{current_, *result.predicted_world_from_left};
}

void StereoOdometry::Implementation::take(const rig_check::RigReport& report, FrameResult& result) const {
  result.diagnostics.rig_evidence = report.evidence;
  if (report.mismatch() != nullptr) return;
  for (const auto& finding : report.findings) {
    warn(rig_check::warning(finding), result);
    if (finding.kind == rig_check::RigFindingKind::repeated_images) add_message(rig_check::sentence(finding), result);
  }
}

/// Reports each kind of warning in one frame only.
void StereoOdometry::Implementation::warn(const Warning& warning, FrameResult& result) const {
  if (reported_.count(warning.kind) == 0) result.warnings.push_back(warning);
}

FrameDetails StereoOdometry::Implementation::details() const {
  FrameDetails details;
  if (!current_) return details;
  details.left_edges = frontend_->edges(Side::left);
  details.right_edges = frontend_->edges(Side::right);
  details.stereo = current_->edges;
  if (!step_) return details;
  details.previous_stereo = step_->base->edges;
  details.quads = step_->matches;
  details.quad_inlier.assign(step_->matches.size(), 0);
  for (std::size_t q = 0; q < step_->motion.inlier.size(); ++q)
    details.quad_inlier[static_cast<std::size_t>(step_->quads.match[q])] = step_->motion.inlier[q];
  return details;
}

StereoOdometry::StereoOdometry(const StereoRig& rig, const Config& config) {
  const Config sound = checked(rig, config);  // before a device is opened
  auto device = std::make_unique<Device>();
  Device& opened = *device;
  implementation_ = std::make_unique<Implementation>(rig, std::move(device), opened, sound);
}

StereoOdometry::StereoOdometry(const StereoRig& rig, Device& device, const Config& config)
    : implementation_(std::make_unique<Implementation>(rig, nullptr, device, checked(rig, config))) {}

StereoOdometry::~StereoOdometry() = default;
FrameResult StereoOdometry::track(const StereoFrame& frame) { return implementation_->track(frame); }
FrameDetails StereoOdometry::details() const { return implementation_->details(); }
const StereoEdges& StereoOdometry::stereo_edges() const { return implementation_->stereo_edges(); }
odometry::CurrentRig StereoOdometry::current_rig() const { return implementation_->current_rig(); }
const StereoRig& StereoOdometry::rig() const { return implementation_->rig(); }
const Config& StereoOdometry::config() const { return implementation_->config(); }
const DeviceInfo& StereoOdometry::device() const { return implementation_->device().info(); }
void StereoOdometry::set_tap(Tap* tap) { implementation_->frontend().set_tap(tap); }
std::size_t StereoOdometry::device_bytes() const { return implementation_->frontend().device_bytes(); }

std::map<std::string, std::string> StereoOdometry::variants() const {
  std::map<std::string, std::string> chosen;
  if (implementation_->device().context() == nullptr) return chosen;
  for (const auto& variant : opencl::all_variants()) {
    chosen[variant.stage] =
        opencl::choose_variant(variant.stage, *implementation_->device().context(), implementation_->config().variants)
            .name;
  }
  return chosen;
}

double StereoOdometry::kernel_build_ms() const {
  const auto* context = implementation_->device().context();
  return context == nullptr ? 0 : context->build_ms();
}

}  // namespace quadedge
