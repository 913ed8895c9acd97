/// \file frame_tracker.cpp  Prepares, searches, locates; after a loss tries earlier frames, or starts a segment.
#include "motion/frame_tracker.hpp"

#include <cmath>
#include <tbb/task_group.h>
#include <utility>

#include "common/printed.hpp"
#include "common/timing.hpp"
#include "device/context.hpp"
#include "geometry/corrected_rig.hpp"
#include "geometry/uncertain_pose.hpp"
#include "geometry/undistortion.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/paper_search.hpp"
#include "motion/view_change.hpp"
#include "quadedge/error.hpp"

namespace quadedge::odometry {
namespace {

/// Adds what passes until its end to a duration [ms].
class Stopwatch {
 public:
  explicit Stopwatch(double& ms) : ms_(ms) {}
  ~Stopwatch() { ms_ += milliseconds_since(start_); }

 private:
  double& ms_;
  Clock::time_point start_ = Clock::now();
};

FrameStatus lost_status(Refusal refusal) {
  return refusal == Refusal::too_few_quads ? FrameStatus::lost_too_few_quads : FrameStatus::lost_no_consensus;
}

void add_message(const std::string& message, FrameResult& result) {
  result.message += (result.message.empty() ? "" : "; ") + message;
}

std::unique_ptr<MotionFinder> make_search(const Config& config, frontend::Frontend& frontend, const StereoRig& rig) {
  if (config.is_paper()) return std::make_unique<PaperSearch>(config, frontend, rig);
  return std::make_unique<MotionSearch>(config, frontend::as_global(frontend), rig);
}

}  // namespace

FrameTracker::FrameTracker(const StereoRig& rig, Device& device, const Config& config)
    : rig_(with_equal_scales(rig)),
      device_(device),
      config_(config),
      preparation_(rig, rig_, device, config),
      learned_(config.pose),
      motion_search_(make_search(config, preparation_.frontend(), rig_)) {}

FrameResult FrameTracker::track(const StereoFrame& frame) {
  check(frame);
  FrameResult result;
  const auto start = Clock::now();
  edges_ms_ = search_ms_ = conclusion_ms_ = 0;
  follow(frame, result);
  result.timing.latency_ms = milliseconds_since(start);
  const double pose_ms = motion_search_->take_pose_ms();
  result.timing.stages = {{kStereoStage, edges_ms_}};
  if (step_) {
    result.timing.stages.push_back({kTemporalStage, search_ms_ - pose_ms});
    result.timing.stages.push_back({kPoseStage, conclusion_ms_ + pose_ms});
  }
  if (device_.context() != nullptr && device_.context()->profiling())
    for (const auto& row : device_.context()->take_profile())
      result.timing.kernels.push_back({row.stage, row.kernel_ms});
  return result;
}

/// The way of a frame: its edges; its motion, searched for while the images are checked; its pose, or why it is lost;
/// what the next frame starts from.
void FrameTracker::follow(const StereoFrame& frame, FrameResult& result) {
  process(frame, result);
  rig::RigReport report;
  StepHandle found = search_and_judge(frame, report);
  result.diagnostics.rig_evidence = report.evidence;
  for (const auto& finding : report.findings)
    if (finding.warning.kind == WarningKind::repeated_images) add_message(finding.warning.text, result);
  if (const auto fault = preparation_.fault(report))
    lose(fault->status, fault->text, result);
  else if (!state_.has_started())
    start(result);
  else
    conclude(std::move(found), result);
  if (result.world_from_left) preparation_.adopt(report, std::exchange(current_from_last_, std::nullopt));
  if (report.new_mask) hide(*report.new_mask);
  result.segment = state_.segment;
  state_.world_from_last = result.pose_or_prediction();
  result.warnings = preparation_.new_warnings();
}

/// \throws DataError if the frame does not fit the rig, or goes back in time
void FrameTracker::check(const StereoFrame& frame) {
  preparation_.check(frame);
  if (last_stamp_ns_ && frame.stamp_ns < *last_stamp_ns_) {
    throw DataError("timestamp " + std::to_string(frame.stamp_ns) + " ns goes back, expected at least " +
                    std::to_string(*last_stamp_ns_) + " ns, the timestamp of the previous frame");
  }
  since_last_.ns = last_stamp_ns_ ? frame.stamp_ns - *last_stamp_ns_ : 0;
  last_stamp_ns_ = frame.stamp_ns;
}

void FrameTracker::restart() {
  last_stamp_ns_.reset();
  velocity_.forget();
  earlier_.clear();
  keeps_key_ = true;
  learned_.restart();
  lenses_.emplace();
  has_returned_ = was_lost_ = at_start_ = false;
  current_from_last_ = std::nullopt;
  motion_search_->restart();
  preparation_.restart();
  starts_segment_ = starts_segment_ || state_.has_started();
  const TrackingState before = std::exchange(state_, {});
  state_.segment = before.segment;
  state_.world_from_last = before.world_from_last;
}

/// Turns the images into the current frame's edges.
void FrameTracker::process(const StereoFrame& frame, FrameResult& result) {
  const Stopwatch watch(edges_ms_);
  result.stamp_ns = frame.stamp_ns;
  step_ = nullptr;
  current_ = nullptr;
  current_ = preparation_.process(frame, learned_.estimate());
  const frontend::FrontendCounts& counts = frontend().counts();
  result.diagnostics.edge_threshold = counts.edge_threshold;
  result.diagnostics.disparity_range = counts.disparity_range;
  result.counts.edges_left = counts.edges_left;
  result.counts.edges_right = counts.edges_right;
  result.counts.stereo_edges = static_cast<int>(current_->edges.size());
  result.rig = current_->rig();
  if (frontend().is_smoothed()) add_message("smoothed, as noise hides the edges", result);
  if (counts.dropped_edges == 0) return;
  result.diagnostics.overflow = true;
  add_message(std::to_string(counts.dropped_edges) + " edges beyond edges.max_edges were dropped", result);
}

/// Hides a part of the image from the next frame on. The last motion may have been that of this part.
void FrameTracker::hide(const PixelMask& left) {
  preparation_.hide(left);
  motion_search_->hide(left);
  velocity_.forget();
}

/// Starts the trajectory, or after restart() a segment, at the first frame with edges.
void FrameTracker::start(FrameResult& result) {
  if (std::exchange(starts_segment_, false)) {
    ++state_.segment;
    add_message(
        "segment " + std::to_string(state_.segment) + " starts: its pose relative to earlier segments is unknown",
        result);
  }
  at_start_ = true;
  result.status = FrameStatus::first;
  result.world_from_left = state_.world_from_last;
  result.new_key_rig = true;
  result.reference_frame = current_->frame;
  result.current_from_reference = Eigen::Isometry3d::Identity();
  result.relative_covariance = result.covariance = result.diagnostics.covariance_in_reference = PoseCovariance::Zero();
  for (const auto& finding : rig::implausible_numbers(rig_)) preparation_.warn(finding.warning);
  state_.set_key(current_, {*result.world_from_left, PoseCovariance::Zero(), RigSensitivity::Zero()});
}

/// The images are checked on a processor that the search leaves idle. An error in the search waits for the check.
StepHandle FrameTracker::search_and_judge(const StereoFrame& frame, rig::RigReport& report) {
  tbb::task_group beside;
  beside.run([&] { report = preparation_.judge(frame); });
  StepHandle found = preparation_.has_enough_edges() && state_.has_started() ? search() : nullptr;
  const Stopwatch watch(edges_ms_);
  beside.wait();
  return found;
}

/// Finds the motion since the base. After a loss, when nothing is known of the motion, an ambiguous one is refused, and
/// the motion since the lost frame is tried.
StepHandle FrameTracker::search() {
  const Stopwatch watch(search_ms_);
  MotionQuery query;
  query.current = current_;
  query.rig = current_->rig();
  query.displacement = learned_.displacement_limits();
  query.seed = config_.seed + static_cast<std::uint64_t>(current_->frame);
  query.base = state_.base.frame_edges;
  query.prediction = velocity_.predict(TimeStep::between(*state_.base.frame_edges, *current_));
  query.accepts_ambiguous = current_->frame - state_.base.frame_edges->frame == 1;
  if (!state_.base_is_key()) {
    query.key = state_.key.frame_edges();
    query.base_from_key = state_.base.from_key.transform;
  }
  query.at_start = std::exchange(at_start_, false) && query.accepts_ambiguous;
  StepHandle found = motion_search_->find(query);
  if (found->ok()) return found;
  query.at_start = false;
  query.rig = found->rig;  // with a displacement, if one explains more of the image
  if (StepHandle returned = search_earlier(query)) return returned;
  if (!state_.lost) return found;
  query.base = state_.lost->frame_edges;
  query.key = nullptr;
  query.prediction = std::nullopt;
  query.accepts_ambiguous = true;
  StepHandle relocalised = motion_search_->find(query);
  return relocalised->ok() ? std::move(relocalised) : std::move(found);
}

/// Finds the motion since one of the earlier keyframes; null if there is none, or if two contradict one another, as in
/// places that look alike. A motion that accidental matches support is none.
StepHandle FrameTracker::search_earlier(MotionQuery query) {
  if (config_.is_paper()) return nullptr;
  query.key = nullptr;
  query.prediction = std::nullopt;
  query.accepts_ambiguous = false;
  StepHandle best;
  Eigen::Isometry3d world_from_best = Eigen::Isometry3d::Identity();
  for (const KeyRig* rig : earlier_.nearest(state_.world_from_last)) {
    query.base = rig->frame_edges();
    StepHandle found = motion_search_->find(query);
    if (!found->ok() || found->verdict.support < kChanceSupport) continue;
    const Eigen::Isometry3d world_from_found = rig->world_from_left() * found->motion.current_from_previous.inverse();
    if (best && view_change(world_from_best.inverse() * world_from_found, found->mean_inverse_depth()) > kSamePlace)
      return nullptr;
    if (best && best->motion.inliers >= found->motion.inliers) continue;
    best = std::move(found);
    world_from_best = world_from_found;
  }
  return best;
}

/// Takes over the result of the search. If the motion was found from a lost frame, a segment starts.
void FrameTracker::conclude(StepHandle found, FrameResult& result) {
  const Stopwatch watch(conclusion_ms_);
  step_ = std::move(found);
  motion_search_->remember(*step_);
  if (state_.lost && step_->base == state_.lost->frame_edges) start_segment(result);
  result.counts.temporal_left = step_->matches.alive_left;
  result.counts.temporal_right = step_->matches.alive_right;
  result.counts.quads = static_cast<int>(step_->matches.size());
  if (!step_->ok()) return lose(lost_status(step_->verdict.refusal), refusal_text(step_->verdict), result);
  return_to_earlier(result);
  locate(*step_, result);
}

/// If the motion was found from an earlier keyframe, makes that the keyframe again. Nothing is known of the velocity.
void FrameTracker::return_to_earlier(FrameResult& result) {
  const KeyRig* found = earlier_.find(step_->base);
  has_returned_ = found != nullptr && step_->base != state_.base.frame_edges && step_->base != state_.key.frame_edges();
  if (!has_returned_) return;
  const KeyRig earlier = *found;
  set_key(earlier.frame_edges(), earlier.pose(), step_->mean_inverse_depth(), true);
  velocity_.forget();
  add_message("located against frame " + std::to_string(earlier.frame()) + ", not since the last frame", result);
}

/// Makes the lost frame the keyframe of a new segment, in which its predicted pose counts as exact.
void FrameTracker::start_segment(FrameResult& result) {
  const auto number = [](int of) { return std::to_string(of); };
  const int last = state_.base.frame_edges->frame, lost = state_.lost->frame_edges->frame, segment = ++state_.segment;
  earlier_.clear();
  keeps_key_ = true;
  state_.set_key(state_.lost->frame_edges,
                 {state_.lost->world_from_left, PoseCovariance::Zero(), RigSensitivity::Zero()}, PoseOrigin::predicted);
  add_message("segment " + number(segment) + " starts: relocalised against frame " + number(lost) +
                  ", whose pose was predicted",
              result);
  preparation_.warn(
      {WarningKind::unknown_motion, "the motion between frames " + number(last) + " and " + number(current_->frame) +
                                        " is unknown; the poses from here on form segment " + number(segment) +
                                        ", whose pose relative to earlier segments is only predicted"});
}

/// Adopts what the motion shows of the rig. What is corrected of a displacement is corrected for the frames, too, that
/// the next ones are measured against.
void FrameTracker::adopt_rig(const MotionStep& step) {
  const RigEstimate now = learned_.anchored(rig::LearnedRig::refined(step.rig, step.base->rig(), step.motion.learned));
  const double moved = now.displacement - step.rig.displacement;
  current_->set_rig(now);
  for (const auto& of : {state_.key.frame_edges(), state_.base_is_key() ? nullptr : state_.base.frame_edges}) {
    if (!of || of->rig().displacement == 0 || now.displacement == 0) continue;
    RigEstimate corrected = of->rig();
    corrected.displacement += moved;
    corrected.displacement_sigma = std::min(corrected.displacement_sigma, now.displacement_sigma);
    of->set_rig(corrected);
  }
}

/// Warns if motions show that both lenses are off alike.
void FrameTracker::judge_lenses(const MotionStep& step) {
  if (step.rig.displacement != 0) lenses_.reset();
  if (!lenses_ || config_.is_paper() || step.verdict.ambiguity.exists()) return;
  lenses_->add(corrected_rig(rig_, step.rig), step.quads.scoring, step.motion.inlier,
               step.motion.current_from_previous);
  const auto found = lenses_->judge();
  if (!found) return;
  preparation_.warn(found->warning);
  lenses_.reset();
}

/// States what was found of the motion, beside the pose.
void FrameTracker::report(const MotionStep& step, FrameResult& result) {
  result.status = FrameStatus::tracked;
  result.counts.inliers = step.motion.inliers;
  result.rig = current_->rig();
  if (const auto large =
          rig::judge_disparity_offset(result.rig.disparity_offset, step.rig.disparity_offset + step.motion.offset,
                                      config_.pose.disparity_offset_sigma))
    preparation_.warn(large->warning);
  result.ambiguous_motion = step.verdict.ambiguity.exists();
  result.diagnostics.moving_ratio = step.verdict.moving_ratio;
  result.diagnostics.moving_cells = step.verdict.moving_cells;
  result.diagnostics.moving_box = step.verdict.moving_box;
  if (const double displacement = result.rig.displacement; displacement != 0) {
    const std::string text = printed("the right image is displaced by %+.1f px", displacement);
    add_message(text, result);
    preparation_.warn(
        {WarningKind::displaced_images, text + " along the epipolar lines and followed, also in later frames: do the "
                                               "cameras swing, or are single images cropped or stabilised?"});
  }
  if (step.verdict.ambiguity.exists()) add_message("ambiguous motion: " + to_string(step.verdict.ambiguity), result);
  result.diagnostics.base_frame = step.base->frame;
  result.diagnostics.search = step.matches.search;
}

/// That of the current frame's pose in the keyframe, the last column of its sensitivity.
Eigen::Matrix<double, 6, 1> FrameTracker::offset_sensitivity(const MotionStep& step) const {
  pose::UncertainPose found = pose::pose_in_earlier(step.motion.adopted());
  found.by_rig.rightCols<1>() = pose::offset_sensitivity(found.fixed_from_camera, step.motion.learned.by_offset);
  if (step.base != state_.key.frame_edges()) found = state_.base.in_key * found;
  return found.by_rig.rightCols<1>();
}

/// Locates the frame against the keyframe or, if that is out of view, against the base; in the latter case the frame
/// becomes the keyframe.
void FrameTracker::locate(const MotionStep& step, FrameResult& result) {
  const bool by_key = step.base == state_.key.frame_edges();
  pose::RelativePose current_from_key = step.motion.adopted();
  if (!by_key) current_from_key = current_from_key * state_.base.from_key;
  const Eigen::Isometry3d current_from_base = current_from_key.transform * state_.base.from_key.transform.inverse();
  const auto step_in_time = TimeStep::between(*state_.base.frame_edges, *current_);
  if (!has_returned_) velocity_.observe(current_from_base, step_in_time);
  if (step_in_time.frames == 1) current_from_last_ = current_from_base;

  KeyRigFitness fitness;
  fitness.quads = static_cast<int>(step.matches.size());
  fitness.inlier_ratio = step.motion.inlier_ratio();
  fitness.median_parallax = median_parallax(step.base->edges, step.matches, distances_);
  fitness.rotation = Eigen::AngleAxisd(current_from_key.transform.linear()).angle();
  fitness.frames = current_->frame - state_.key.frame();

  judge_lenses(step);
  adopt_rig(step);
  report(step, result);
  result.reference_frame = state_.key.frame();
  result.current_from_reference = current_from_key.transform;
  result.relative_covariance = pose::in_other_order(current_from_key.covariance);
  pose::UncertainPose key_from_current = pose::pose_in_earlier(current_from_key);
  key_from_current.by_rig = pose::rig_sensitivity(key_from_current.fixed_from_camera, step.mean_inverse_depth());
  key_from_current.by_rig.rightCols<1>() = offset_sensitivity(step);
  const pose::UncertainPose world_from_current = state_.key.pose() * key_from_current;
  result.diagnostics.rig_sensitivity = key_from_current.by_rig;
  result.diagnostics.covariance_in_reference = pose::whole_covariance(key_from_current, config_.pose);
  result.covariance = pose::whole_covariance(world_from_current, config_.pose);
  result.world_from_left = world_from_current.fixed_from_camera;
  result.new_key_rig = !config_.odometry.key_rig || !by_key || state_.key.needs_replacement(fitness, config_.odometry);

  state_.lost = std::nullopt;
  was_lost_ = false;
  inverse_depth_ = step.mean_inverse_depth();
  if (result.new_key_rig) {
    // All frames located against one keyframe share its disparities, so that together they carry no more information
    // than the last, most distant one.
    learned_.adopt(current_->rig());
    set_key(current_, world_from_current, inverse_depth_, !step.verdict.ambiguity.exists());
  } else {
    state_.base = {current_, current_from_key, key_from_current};
  }
}

/// Replaces the keyframe, which is kept for a loss if it was set so. \param inverse_depth mean of what is seen from
/// nearly there [1/m] \param keeps whether the new one will be kept when it is replaced
void FrameTracker::set_key(frontend::FrameEdgesHandle frame_edges, const pose::UncertainPose& pose,
                           double inverse_depth, bool keeps) {
  if (std::exchange(keeps_key_, keeps)) earlier_.remember(state_.key, inverse_depth);
  state_.set_key(std::move(frame_edges), pose);
}

/// Repeats the last motion. A lost frame that has edges is kept in addition to the base, which becomes the keyframe;
/// the next frame may be located against either.
void FrameTracker::lose(FrameStatus status, const std::string& message, FrameResult& result) {
  result.status = status;
  add_message(message, result);
  if (std::exchange(was_lost_, true)) velocity_.forget();
  const auto repeated = velocity_.predict(since_last_);
  result.predicted_world_from_left = repeated ? state_.world_from_last * repeated->inverse() : state_.world_from_last;
  result.reference_frame = state_.key.frame();
  if (status == FrameStatus::lost_too_few_edges || status == FrameStatus::lost_rig_mismatch) return;
  // No result says that it is a keyframe, and its motion may be ambiguous.
  if (!state_.base_is_key()) set_key(state_.base.frame_edges, state_.world_from_base(), inverse_depth_, false);
  state_.lost = LostFrame{current_, *result.predicted_world_from_left};
}

FrameDetails FrameTracker::details() const {
  FrameDetails details;
  if (!current_) return details;
  details.left_edges = frontend().edges(Side::left);
  details.right_edges = frontend().edges(Side::right);
  details.stereo = current_->edges;
  details.rig = current_->rig();
  if (!step_) return details;
  details.previous_stereo = step_->base->edges;
  details.previous_rig = details.rig.of(step_->base->rig());
  details.quads = step_->matches;
  details.quad_inlier.assign(step_->matches.size(), 0);
  for (std::size_t q = 0; q < step_->motion.inlier.size(); ++q)
    details.quad_inlier[static_cast<std::size_t>(step_->quads.match[q])] = step_->motion.inlier[q];
  return details;
}

LatestFrame FrameTracker::latest_frame() const {
  return {device_, preparation_.frontend(), current_, learned_.estimate(), step_ ? &*step_ : nullptr};
}

}  // namespace quadedge::odometry
