/// \file stereo_odometry.cpp  The way of a frame (doc/design.md section 1), from two images to a pose.
#include <algorithm>
#include <chrono>

#include "frontend/frontend.hpp"
#include "odometry/disparity_offset.hpp"
#include "odometry/key_rig.hpp"
#include "odometry/motion_search.hpp"
#include "opencl/context.hpp"
#include "opencl/variants.hpp"
#include "quadedge/error.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/tap.hpp"

namespace quadedge {
namespace {

/// Milliseconds since the last lap, steady clock.
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

/// Covariance of a * b for left perturbations of both, a exact up to its own covariance.
Eigen::Matrix<double, 6, 6> composed_covariance(const Eigen::Matrix<double, 6, 6>& of_a, const Eigen::Isometry3d& a,
                                                const Eigen::Matrix<double, 6, 6>& of_b) {
  Eigen::Matrix3d cross;
  const Eigen::Vector3d t = a.translation();
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  Eigen::Matrix<double, 6, 6> adjoint = Eigen::Matrix<double, 6, 6>::Zero();
  adjoint.topLeftCorner<3, 3>() = a.linear();
  adjoint.bottomRightCorner<3, 3>() = a.linear();
  adjoint.bottomLeftCorner<3, 3>() = cross * a.linear();
  return of_a + adjoint * of_b * adjoint.transpose();
}

/// The motion of one of `intervals` equal frame intervals, with the translation spread evenly (a prediction, not an
/// estimate).
Eigen::Isometry3d one_interval(const Eigen::Isometry3d& motion, int intervals) {
  const Eigen::AngleAxisd rotation(motion.linear());
  Eigen::Isometry3d part = Eigen::Isometry3d::Identity();
  part.linear() = Eigen::AngleAxisd(rotation.angle() / intervals, rotation.axis()).toRotationMatrix();
  part.translation() = motion.translation() / intervals;
  return part;
}

void check_image(const ImageView& image, const PinholeCamera& camera, bool any_size, const char* side) {
  if (image.empty()) throw DataError(std::string("the ") + side + " image is empty");
  if (!any_size && (image.width != camera.width || image.height != camera.height)) {
    throw DataError(std::string("the ") + side + " image has " + std::to_string(image.width) + "x" +
                    std::to_string(image.height) + " pixels, the calibration expects " + std::to_string(camera.width) +
                    "x" + std::to_string(camera.height));
  }
}

}  // namespace

const char* to_string(FrameStatus status) {
  switch (status) {
    case FrameStatus::first: return "first";
    case FrameStatus::tracked: return "tracked";
    case FrameStatus::lost_too_few_edges: return "lost_too_few_edges";
    case FrameStatus::lost_too_few_quads: return "lost_too_few_quads";
    case FrameStatus::lost_no_consensus: return "lost_no_consensus";
  }
  return "unknown";
}

class StereoOdometry::Implementation {
 public:
  Implementation(const StereoRig& rig, Device& device, const Config& config)
      : rig_(rig),
        device_(device),
        config_(config),
        frontend_(frontend::make_frontend(rig, device, config)),
        offset_(rig, config.pose),
        search_(rig, config, *frontend_, offset_) {}

  FrameResult track(const StereoFrame& frame);
  FrameDetails details() const;

  frontend::Frontend& frontend() const { return *frontend_; }
  Device& device() const { return device_; }
  const Config& config() const { return config_; }

 private:
  odometry::StepHandle find_motion(FrameResult& result);
  void locate(const odometry::MotionStep& step, FrameResult& result);
  void lose(FrameStatus status, const std::string& message, FrameResult& result);
  void become_base(const FrameResult& result);
  std::optional<Eigen::Isometry3d> predicted_motion() const;

  StereoRig rig_;
  Device& device_;
  Config config_;
  std::unique_ptr<frontend::Frontend> frontend_;
  odometry::DisparityOffset offset_;
  odometry::MotionSearch search_;
  odometry::KeyRig key_rig_;

  frontend::RigHandle current_handle_, previous_handle_, key_handle_;
  int frame_ = -1;             ///< number of the current frame
  bool has_base_ = false;      ///< a frame that the next one is matched with
  bool keep_pending_ = false;  ///< the current frame is the next one's base
  bool key_pending_ = false;   ///< and its key rig
  int base_frame_ = 0;
  Eigen::Isometry3d base_from_key_ = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> base_covariance_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Isometry3d world_from_last_ = Eigen::Isometry3d::Identity();
  std::optional<Eigen::Isometry3d> velocity_;  ///< current_from_previous of one frame interval
  /// The newest frame that has edges and no pose: the frontend's previous rig while the key rig is the base.
  struct Unplaced {
    int frame;
    Eigen::Isometry3d world_from_left;  ///< a guess
  };
  std::optional<Unplaced> unplaced_;
  bool base_to_key_pending_ = false;  ///< the base becomes the key rig before the current frame is kept

  odometry::StepHandle last_step_;  ///< of the current frame; null where none was tried
  std::vector<double> distances_;   ///< buffer of median_parallax()
};

FrameResult StereoOdometry::Implementation::track(const StereoFrame& frame) {
  check_image(frame.left, rig_.left, !rig_.left_undistortion.empty(), "left");
  check_image(frame.right, rig_.right, !rig_.right_undistortion.empty(), "right");
  StageClock latency, clock;
  ++frame_;
  last_step_ = nullptr;
  FrameResult result;
  result.stamp_ns = frame.stamp_ns;

  if (base_to_key_pending_) key_handle_ = previous_handle_;
  if (keep_pending_) previous_handle_ = current_handle_;
  if (keep_pending_ && key_pending_) key_handle_ = current_handle_;
  base_to_key_pending_ = keep_pending_ = false;
  current_handle_ = nullptr;
  current_handle_ = frontend_->process(frame);
  result.stages.push_back({"stereo", clock.lap()});
  result.counts.edges_left = frontend_->counts().edges_left;
  result.counts.edges_right = frontend_->counts().edges_right;
  result.counts.stereo_edges = static_cast<int>(current_handle_->edges.size());
  if (frontend_->counts().dropped_edges > 0) {
    result.overflow = true;
    result.message = std::to_string(frontend_->counts().dropped_edges) + " edges beyond edges.max_edges were dropped";
  }

  if (result.counts.stereo_edges < config_.pose.min_inliers) {
    lose(FrameStatus::lost_too_few_edges, std::to_string(result.counts.stereo_edges) + " stereo edges", result);
  } else if (!has_base_) {
    result.status = FrameStatus::first;
    result.world_from_left = world_from_last_;
    result.new_key_rig = true;
    result.reference_frame = frame_;
    key_rig_.start(frame_, result.world_from_left);
    become_base(result);
  } else {
    last_step_ = find_motion(result);
    const odometry::MotionStep& step = *last_step_;
    result.counts.temporal_left = frontend_->counts().temporal_left;
    result.counts.temporal_right = frontend_->counts().temporal_right;
    result.counts.quads = static_cast<int>(step.matches.size());
    result.stages.push_back({"temporal", clock.lap()});
    if (step.motion.status == pose::MotionStatus::ok) {
      locate(step, result);
    } else {
      lose(lost_status(step.motion.status), pose::to_string(step.motion.status), result);
    }
    result.stages.push_back({"pose", clock.lap()});
  }
  world_from_last_ = result.world_from_left;
  result.latency_ms = latency.lap();
  if (device_.context() != nullptr && device_.context()->profiling()) {
    for (const auto& [stage, ms] : device_.context()->take_profile()) result.stages.push_back({"device " + stage, ms});
  }
  return result;
}

/// Constant velocity over the frames since the base; nothing where no velocity is known.
std::optional<Eigen::Isometry3d> StereoOdometry::Implementation::predicted_motion() const {
  if (!velocity_) return std::nullopt;
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  for (int i = base_frame_; i < frame_; ++i) motion = *velocity_ * motion;
  return motion;
}

/// The motion since the base or the key rig; after a loss, else the one since the frame that was lost, from which
/// tracking restarts.
odometry::StepHandle StereoOdometry::Implementation::find_motion(FrameResult& result) {
  odometry::MotionPrior prior;
  prior.seed = config_.seed + static_cast<std::uint64_t>(frame_);
  prior.prediction = predicted_motion();
  prior.current = current_handle_;
  prior.key = key_handle_;
  prior.previous = previous_handle_;
  if (base_frame_ == key_rig_.frame()) {
    prior.base = odometry::Base::key;
  } else {
    prior.base_from_key = base_from_key_;
  }
  odometry::StepHandle step = search_.find(prior);
  if (step->ok() || !unplaced_) return step;
  prior.base = odometry::Base::previous;
  prior.prediction = std::nullopt;
  odometry::StepHandle restart = search_.find(prior);
  if (!restart->ok()) return step;
  result.message += std::string(result.message.empty() ? "" : "; ") + "restarted from frame " +
                    std::to_string(unplaced_->frame) + ", whose place is a guess";
  key_rig_.start(unplaced_->frame, unplaced_->world_from_left);
  base_frame_ = unplaced_->frame;
  return restart;
}

/// Pose against the key rig, or against the previous frame where the key rig is out of sight: then this frame is the
/// next key rig.
void StereoOdometry::Implementation::locate(const odometry::MotionStep& step, FrameResult& result) {
  const bool by_key = step.base == odometry::Base::key;
  Eigen::Isometry3d current_from_key = step.motion.current_from_previous;
  Eigen::Matrix<double, 6, 6> covariance = step.motion.covariance;
  if (!by_key) {
    covariance = composed_covariance(covariance, current_from_key, base_covariance_);
    current_from_key = current_from_key * base_from_key_;
  }
  odometry::KeyRigState state;
  state.quads = static_cast<int>(step.matches.size());
  state.inlier_share = step.motion.inlier_ratio;
  state.median_parallax =
      odometry::median_parallax((by_key ? key_handle_ : previous_handle_)->edges, step.matches, distances_);
  state.rotation = Eigen::AngleAxisd(current_from_key.linear()).angle();
  state.frames = frame_ - key_rig_.frame();
  result.disparity_offset = offset_.value() + step.motion.offset;
  result.status = FrameStatus::tracked;
  result.counts.inliers = step.motion.inliers;
  result.search = step.matches.search;
  result.reference_frame = key_rig_.frame();
  result.current_from_reference = current_from_key;
  result.covariance = covariance;
  result.world_from_left = key_rig_.world_from_key() * current_from_key.inverse();

  velocity_ = one_interval(current_from_key * base_from_key_.inverse(), frame_ - base_frame_);
  unplaced_ = std::nullopt;
  result.new_key_rig = !config_.odometry.key_rig || !by_key || key_rig_.is_worn(state, config_.odometry);
  base_from_key_ = current_from_key;
  base_covariance_ = covariance;
  // All frames of a key rig are measured against its disparities: together they tell no more than the last one, the
  // farthest away.
  if (result.new_key_rig) offset_.update(step.motion.offset, step.motion.offset_variance, state.frames);
  if (result.new_key_rig) key_rig_.start(frame_, result.world_from_left);
  become_base(result);
}

/// Repeats the last motion. A lost frame that has edges is kept beside the last base, which becomes the key rig: the
/// next frame may be found against either.
void StereoOdometry::Implementation::lose(FrameStatus status, const std::string& message, FrameResult& result) {
  result.status = status;
  result.message += (result.message.empty() ? "" : "; ") + message;
  if (unplaced_) velocity_ = std::nullopt;  // lost twice in a row
  result.world_from_left = velocity_ ? world_from_last_ * velocity_->inverse() : world_from_last_;
  result.reference_frame = key_rig_.frame();
  if (status == FrameStatus::lost_too_few_edges) return;
  if (base_frame_ != key_rig_.frame()) {
    base_to_key_pending_ = true;
    key_rig_.start(base_frame_, key_rig_.world_from_key() * base_from_key_.inverse());
    base_from_key_ = Eigen::Isometry3d::Identity();
    base_covariance_.setZero();
  }
  unplaced_ = Unplaced{frame_, result.world_from_left};
  keep_pending_ = true;
  key_pending_ = false;
}

/// The current frame is what the next one is matched with. The frontend keeps it when that one comes, so that details()
/// sees both.
void StereoOdometry::Implementation::become_base(const FrameResult& result) {
  keep_pending_ = true;
  key_pending_ = result.new_key_rig;
  has_base_ = true;
  base_frame_ = frame_;
  if (result.new_key_rig) {
    base_from_key_ = Eigen::Isometry3d::Identity();
    base_covariance_.setZero();
  }
}

FrameDetails StereoOdometry::Implementation::details() const {
  FrameDetails details;
  if (!current_handle_) return details;
  details.left_edges = frontend_->edges(false);
  details.right_edges = frontend_->edges(true);
  const auto& matched = last_step_ && last_step_->base == odometry::Base::key ? key_handle_ : previous_handle_;
  if (matched) details.previous_stereo = matched->edges;
  details.stereo = current_handle_->edges;
  if (!last_step_) return details;
  const odometry::MotionStep& step = *last_step_;
  details.quads = step.matches;
  details.quad_inlier.assign(step.matches.size(), 0);
  for (std::size_t q = 0; q < step.motion.inlier.size(); ++q)
    details.quad_inlier[static_cast<std::size_t>(step.quads.match[q])] = step.motion.inlier[q];
  return details;
}

StereoOdometry::StereoOdometry(const StereoRig& rig, Device& device, const Config& config) {
  check_rig(rig, "stereo rig");
  check_config(config);
  implementation_ = std::make_unique<Implementation>(rig, device, config);
}

StereoOdometry::~StereoOdometry() = default;
FrameResult StereoOdometry::track(const StereoFrame& frame) { return implementation_->track(frame); }
FrameDetails StereoOdometry::details() const { return implementation_->details(); }
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
