/// \file localiser.cpp  Frames located in a saved map (doc/method.md section 10).
#include "quadedge/localiser.hpp"

#include <algorithm>
#include <cmath>

#include "common/images.hpp"
#include "common/parallel.hpp"
#include "common/timing.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/uncertain_pose.hpp"
#include "geometry/undistortion.hpp"
#include "motion/frame_preparation.hpp"
#include "motion/learned_rig.hpp"
#include "motion/motion_search.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/tracking_state.hpp"
#include "motion/view_change.hpp"
#include "places/place_store.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "rig/rig_monitor.hpp"

namespace quadedge {
namespace {

/// Two poses are the same if points at the depth of the scene are seen in directions that differ by less than this: far
/// more than the error of a map between neighbouring keyframes, and less than the distance of two places.
constexpr double kSamePlace = 3 * kDegree;

/// A motion from a keyframe of the map to the frame.
struct Match {
  const places::Place* place;
  pose::RelativePose current_from_key;
  Eigen::Isometry3d map_from_left;
  int inliers;
  double support, inverse_depth;
  odometry::Ambiguity ambiguity;
};

bool agree(const Match& one, const Match& other) {
  const Eigen::Isometry3d error = one.map_from_left.inverse() * other.map_from_left;
  const double depth_shift = error.translation().norm() * std::max(one.inverse_depth, other.inverse_depth);
  return Eigen::AngleAxisd(error.linear()).angle() + depth_shift < kSamePlace;
}

/// Whether a keyframe sees the scene from another place than the frame, by the location that a match gives.
bool sees_other_place(const Match& match, const Eigen::Isometry3d& map_from_key) {
  const Eigen::Isometry3d motion = map_from_key.inverse() * match.map_from_left;
  return odometry::view_change(motion, match.inverse_depth) > odometry::kSameView;
}

/// Whether its support, which a wrong motion does not reach by chance, shows that the frame sees this place or one like
/// it.
bool is_supported(const Match& match) { return match.support > odometry::kChanceSupport; }

bool is_certain(const Match& match) { return !match.ambiguity.exists() && is_supported(match); }

bool are_equal(const PinholeCamera& one, const PinholeCamera& other) {
  return one.matrix() == other.matrix() && one.width == other.width && one.height == other.height;
}

bool are_equal(const StereoRig& one, const StereoRig& other) {
  return are_equal(one.left, other.left) && are_equal(one.right, other.right) &&
         one.right_from_left.matrix() == other.right_from_left.matrix();
}

/// The disparity offset that the map's recording has learned is that of the rig, unless another is given.
PoseConfig with_offset_of(const places::SavedPlaces& map, const StereoRig& rig, PoseConfig config) {
  if (!are_equal(map.rig, rig) || config.disparity_offset != 0) return config;
  config.disparity_offset = map.offset;
  config.disparity_offset_sigma = std::sqrt(map.offset_variance);
  return config;
}

Config checked(const places::SavedPlaces& map, const StereoRig& rig, const Config& config) {
  odometry::check_usable(rig, config);
  places::check_map_config(config);
  const auto settings = places::descriptor_settings(config);
  const auto& its = map.settings;
  for (const auto& [name, value] : settings) {
    const auto& key = name;  // C++17 has no captures of structured bindings
    const auto same = std::find_if(its.begin(), its.end(), [&](const auto& setting) { return setting.first == key; });
    if (same == its.end()) throw UsageError("the map does not state its " + key + ": expected " + value);
    if (same->second != value)
      throw UsageError("the map was made with " + key + " = " + same->second + ": expected the same");
  }
  return config;
}

/// Keyframes of the map were not masked.
Config without_auto_mask(Config config) {
  config.odometry.auto_mask = false;
  return config;
}

using SimilarPlaces = std::vector<places::PlaceStore::Similar>;

const Match* lose(LocalisationStatus status, const std::string& message, Localisation& result) {
  result.status = status;
  result.message = message;
  return nullptr;
}

std::string rig_text(const Match& match) { return "keyframe " + std::to_string(match.place->kept.frame); }

const Match* lose_between(const Match& one, const Match& other, Localisation& result) {
  return lose(LocalisationStatus::lost_ambiguous, "two places match: " + rig_text(one) + " and " + rig_text(other),
              result);
}

}  // namespace

const char* to_string(LocalisationStatus status) {
  switch (status) {
    case LocalisationStatus::located: return "located";
    case LocalisationStatus::lost_too_few_edges: return "lost_too_few_edges";
    case LocalisationStatus::lost_rig_mismatch: return "lost_rig_mismatch";
    case LocalisationStatus::lost_unknown_place: return "lost_unknown_place";
    case LocalisationStatus::lost_ambiguous: return "lost_ambiguous";
  }
  return "unknown";
}

class Localiser::Implementation {
 public:
  Implementation(const SavedMap& map, const StereoRig& rig, Device& device, const Config& config, bool follow)
      : map_(map),
        follow_(follow),
        config_(checked(map.places(), rig, config)),
        rig_(with_scale_of(map.rig().left, with_equal_scales(rig))),
        device_(device),
        preparation_(rig, rig_, device, without_auto_mask(config)),
        estimate_(rig::LearnedRig(with_offset_of(map.places(), rig_, config.pose)).estimate()),
        search_(config_, frontend(), rig_) {
    for (const auto& finding : rig::implausible_numbers(rig_)) preparation_.warn(finding.warning);
  }

  Localisation locate(const StereoFrame& frame);
  const Config& config() const { return config_; }
  const Device& device() const { return device_; }
  Processors processors;

 private:
  frontend::Frontend& frontend() const { return preparation_.frontend(); }
  void locate(const frontend::FrameEdgesHandle& frame_edges, Localisation& result);
  bool follow(const frontend::FrameEdgesHandle& frame_edges, Localisation& result);
  std::optional<Match> compare(const places::Place& place, const frontend::FrameEdgesHandle& frame_edges,
                               const std::optional<Eigen::Isometry3d>& map_from_left);
  static const Match* judge(const std::vector<Match>& matches, Localisation& result);
  std::optional<Match> find_rival(const Match& best, const SimilarPlaces& similar, std::size_t next,
                                  const frontend::FrameEdgesHandle& frame_edges);
  void set_location(const Match& match, Localisation& result) const;

  SavedMap map_;
  bool follow_;
  Config config_;
  StereoRig rig_;  ///< the cameras in which edges are detected
  Device& device_;
  odometry::FramePreparation preparation_;
  RigEstimate estimate_;
  odometry::MotionSearch search_;
  std::optional<Eigen::Isometry3d> last_;  ///< pose of the previous frame, if that was located
  odometry::ConstantVelocity velocity_;
  std::optional<std::int64_t> last_stamp_ns_;
  odometry::TimeStep since_last_;  ///< from the frame before
};

Localisation Localiser::Implementation::locate(const StereoFrame& frame) {
  preparation_.check(frame);
  const auto start = Clock::now();
  Localisation result;
  result.stamp_ns = frame.stamp_ns;
  since_last_.ns = last_stamp_ns_ ? frame.stamp_ns - *last_stamp_ns_ : 0;
  last_stamp_ns_ = frame.stamp_ns;
  const frontend::FrameEdgesHandle frame_edges = preparation_.process(frame, estimate_);
  const rig::RigReport report = preparation_.judge(frame);
  if (const auto fault = preparation_.fault(report)) {
    lose(fault->status == FrameStatus::lost_rig_mismatch ? LocalisationStatus::lost_rig_mismatch
                                                         : LocalisationStatus::lost_too_few_edges,
         fault->text, result);
  } else if (!follow(frame_edges, result)) {
    locate(frame_edges, result);
  }
  result.warnings = preparation_.new_warnings();
  if (last_ && result.map_from_left)
    velocity_.observe(result.map_from_left->inverse() * *last_, since_last_);
  else
    velocity_.forget();
  if (result.map_from_left) preparation_.adopt(report, std::nullopt);
  last_ = result.map_from_left;
  result.latency_ms = milliseconds_since(start);
  return result;
}

/// Tries the keyframe nearest to the predicted pose: 1 rad counts as much as 1 m.
bool Localiser::Implementation::follow(const frontend::FrameEdgesHandle& frame_edges, Localisation& result) {
  const auto motion = velocity_.predict(since_last_);
  if (!follow_ || !last_ || !motion) return false;
  const Eigen::Isometry3d predicted = *last_ * motion->inverse();
  const std::vector<places::Place>& places = map_.places().store.places();
  const auto distance = [&](const places::Place& place) {
    const Eigen::Isometry3d error = map_.places().poses[static_cast<std::size_t>(place.node)].inverse() * predicted;
    return Eigen::AngleAxisd(error.linear()).angle() + error.translation().norm();
  };
  const auto nearest = std::min_element(places.begin(), places.end(), [&](const auto& one, const auto& other) {
    return distance(one) < distance(other);
  });
  const auto match = compare(*nearest, frame_edges, predicted);
  if (!match || !is_certain(*match)) return false;
  result.is_followed = true;
  set_location(*match, result);
  return true;
}

/// Compares the frame with the most similar keyframes, and with more of them while it is lost.
void Localiser::Implementation::locate(const frontend::FrameEdgesHandle& frame_edges, Localisation& result) {
  const places::PlaceSignature signature = places::place_signature(frontend().keep());
  const auto may_be = [](const places::Place&) { return true; };
  const auto similar =
      map_.places().store.most_similar(signature, places::kCandidateBatches * places::kCandidates, may_be);
  result.message = "the map has no keyframes";
  std::vector<Match> matches;
  for (std::size_t k = 0; k < similar.size(); ++k) {
    if (auto match = compare(*similar[k].place, frame_edges, std::nullopt)) matches.push_back(*match);
    const bool is_last = k + 1 == similar.size() || (k + 1) % places::kCandidates == 0;
    const Match* best = is_last ? judge(matches, result) : nullptr;
    if (best == nullptr) continue;
    if (const auto rival = find_rival(*best, similar, k + 1, frame_edges))
      lose_between(*best, *rival, result);
    else
      set_location(*best, result);
    return;
  }
}

/// Searches further keyframes, from places that the located frame does not see, for one that matches all the same,
/// ambiguously or not.
std::optional<Match> Localiser::Implementation::find_rival(const Match& best, const SimilarPlaces& similar,
                                                           std::size_t next,
                                                           const frontend::FrameEdgesHandle& frame_edges) {
  for (; next < similar.size(); ++next) {
    const places::Place& place = *similar[next].place;
    if (!sees_other_place(best, map_.places().poses[static_cast<std::size_t>(place.node)])) continue;
    auto match = compare(place, frame_edges, std::nullopt);
    if (match && is_supported(*match) && !agree(*match, best)) return match;
  }
  return std::nullopt;
}

/// The match with most inliers gives the pose if its support, or another that agrees with it, shows that it is not
/// found by chance, and none that is certain contradicts it. \returns it, or null if the frame is lost
const Match* Localiser::Implementation::judge(const std::vector<Match>& matches, Localisation& result) {
  if (matches.empty()) return lose(LocalisationStatus::lost_unknown_place, "no keyframe of the map matches", result);
  const Match* best = nullptr;
  for (const Match& match : matches)
    if (!match.ambiguity.exists() && (best == nullptr || match.inliers > best->inliers)) best = &match;
  if (best == nullptr)
    return lose(LocalisationStatus::lost_ambiguous,
                rig_text(matches.front()) + ": " + odometry::to_string(matches.front().ambiguity), result);
  bool is_confirmed = is_certain(*best);
  for (const Match& match : matches) {
    if (&match == best || match.ambiguity.exists()) continue;
    if (agree(match, *best)) {
      is_confirmed = true;
    } else if (is_certain(match)) {
      return lose_between(*best, match, result);
    }
  }
  if (!is_confirmed)
    return lose(LocalisationStatus::lost_unknown_place, rig_text(*best) + " alone matches, with little support",
                result);
  return best;
}

/// Searches for the motion from a place, near a predicted pose if there is one.
std::optional<Match> Localiser::Implementation::compare(const places::Place& place,
                                                        const frontend::FrameEdgesHandle& frame_edges,
                                                        const std::optional<Eigen::Isometry3d>& map_from_left) {
  const Eigen::Isometry3d& map_from_key = map_.places().poses[static_cast<std::size_t>(place.node)];
  odometry::MotionQuery query;
  query.current = frame_edges;
  query.base = frontend().restore(place.kept);
  query.seed = config_.seed;
  query.rig = estimate_;
  query.rig.disparity_error = 0;  // an error of the rig must not make places alike
  if (map_from_left) query.prediction = map_from_left->inverse() * map_from_key;
  const odometry::StepHandle step = search_.find(query);
  if (!step->ok()) return std::nullopt;
  const odometry::Verdict& verdict = step->verdict;
  pose::RelativePose current_from_key = step->motion.adopted();
  current_from_key.covariance += step->motion.learned.by_offset * step->motion.learned.by_offset.transpose();
  const Eigen::Isometry3d found = map_from_key * current_from_key.transform.inverse();
  return Match{
      &place,           current_from_key, found, step->motion.inliers, verdict.support, step->mean_inverse_depth(),
      verdict.ambiguity};
}

void Localiser::Implementation::set_location(const Match& match, Localisation& result) const {
  pose::UncertainPose key_from_left = pose::pose_in_earlier(match.current_from_key);
  key_from_left.by_rig = pose::rig_sensitivity(key_from_left.fixed_from_camera, match.inverse_depth);
  const pose::UncertainPose map_from_key{map_.places().poses[static_cast<std::size_t>(match.place->node)]};
  result.status = LocalisationStatus::located;
  result.message.clear();
  result.map_from_left = match.map_from_left;
  result.covariance = pose::whole_covariance(map_from_key * key_from_left, config_.pose);
  result.key_rig = match.place->kept.frame;
  result.inliers = match.inliers;
  result.support = match.support;
}

Localiser::Localiser(const SavedMap& map, const StereoRig& rig, Device& device, const Config& config, bool follow) {
  const auto use = device.use();
  implementation_ = std::make_unique<Implementation>(map, rig, device, config, follow);
}
Localiser::~Localiser() = default;
Localisation Localiser::locate(const StereoFrame& frame) {
  const auto use = implementation_->device().use();
  return implementation_->processors.run([&] { return implementation_->locate(frame); });
}
const Config& Localiser::config() const { return implementation_->config(); }

}  // namespace quadedge
