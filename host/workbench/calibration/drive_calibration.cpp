/// \file drive_calibration.cpp  Cross-validates on two halves of the pairs before the calibration from all is accepted.
#include "quadedge/drive_calibration.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "calibration/pair_adjustment.hpp"
#include "calibration/pair_collection.hpp"
#include "calibration/rig_change.hpp"
#include "calibration/rig_unknowns.hpp"
#include "calibration/unseen_views.hpp"
#include "common/images.hpp"
#include "common/numeric.hpp"
#include "common/printed.hpp"
#include "geometry/calibration.hpp"
#include "geometry/disparity_range.hpp"
#include "geometry/frame_mask.hpp"
#include "geometry/lens_mapping.hpp"

namespace quadedge {
namespace {

using Pairs = std::vector<const rig::FramePair*>;

/// The recording contradicts the given calibration from here on (sound rigs: up to 7; KITTI's: 200 to 7,000).
constexpr double kMinContradiction = 15;
constexpr std::size_t kFewestPairs = 10;
constexpr int kFewestPoints = 500;

/// Whether the mask of a pinhole image hides a pixel of the recorded one; beyond the pinhole image as at its border.
bool is_masked(const LensMapping& lens, const PinholeCamera& camera, const PixelMask& mask, const Eigen::Vector2d& at) {
  if (mask.empty()) return false;
  const auto ray = lens.ray(at);
  if (!ray || !(ray->z() > 0)) return true;
  const Eigen::Vector2d pinhole = camera.project(*ray).cwiseMax(0).cwiseMin(Eigen::Vector2d(mask.width, mask.height));
  return hides(mask, pinhole.x(), pinhole.y());
}

/// Whether the mask of a frame hides a pixel of its image.
bool is_masked(const ImageView& mask, const Eigen::Vector2d& at) {
  if (mask.empty()) return false;
  const auto nearest = [](double position, int size) {
    return std::clamp(static_cast<int>(std::lround(position)), 0, size - 1);
  };
  return mask.value(nearest(at.x(), mask.width), nearest(at.y(), mask.height)) == 0;
}

/// What the recording has not shown of a calibration: "; not observed: A; B".
std::string not_observed(const DriveCalibration& result) {
  std::string names;
  for (const LearnedNumber& number : result.numbers) {
    if (!number.is_open()) continue;
    names += (names.empty() ? "; not observed: " : "; ") + number.name;
    if (number.name != rig::RigUnknowns::kCommonFocal) continue;
    StereoCalibration longer = result.given;
    for (PinholeCamera* camera : {&longer.left.camera, &longer.right.camera}) {
      camera->fx *= 1.1;
      camera->fy *= 1.1;
    }
    constexpr double kDepth = 10;  // m
    names += printed(" (10 %% would change depths of %.0f m by %.0f %%)", kDepth,
                     100 * rig::depth_error(longer, result.given, kDepth));
  }
  return names;
}

}  // namespace

class DriveCalibrator::Implementation {
 public:
  Implementation(const StereoCalibration& given, const StereoRig& rig, int most_pairs, bool learns_k3)
      : given_(given),
        unknowns_(given, learns_k3),
        lenses_{LensMapping(given.left), LensMapping(given.right)},
        cameras_{rig.left, rig.right},
        masks_{rig.left_mask, rig.right_mask},
        images_(rig),
        most_pairs_(static_cast<std::size_t>(most_pairs)),
        collector_(unknowns_, std::min(rig.disparity_range(), disparity_limit(rig)),
                   [this](Side side, const Eigen::Vector2d& at) {
                     const int s = index_of(side);
                     return is_masked(lenses_[s], cameras_[s], masks_[s], at) || is_masked(frame_masks_[s], at);
                   }) {}

  void see(const StereoFrame& frame) {
    images_.check(frame);
    frame_masks_[0] = frame.left_mask;
    frame_masks_[1] = frame.right_mask;
    auto pair = collector_.see(frame, frames_++);
    if (!pair || found_++ % every_ != 0) return;
    pairs_.push_back(std::move(*pair));
    if (pairs_.size() < 2 * most_pairs_) return;
    for (std::size_t i = 1; i < most_pairs_; ++i) pairs_[i] = std::move(pairs_[2 * i]);
    pairs_.resize(most_pairs_);
    every_ *= 2;
  }
  void restart() { collector_.restart(); }
  int pairs() const { return static_cast<int>(pairs_.size()); }
  DriveCalibration finish() const;

 private:
  rig::UnseenViews judge_unseen() const;
  void learn(DriveCalibration& result) const;

  StereoCalibration given_;
  rig::RigUnknowns unknowns_;
  LensMapping lenses_[2];
  PinholeCamera cameras_[2];
  PixelMask masks_[2];
  RecordedImages images_;
  ImageView frame_masks_[2];  ///< of the frame that see() sees
  std::size_t most_pairs_;
  rig::PairCollector collector_;
  std::vector<rig::FramePair> pairs_;
  int frames_ = 0;
  std::size_t found_ = 0, every_ = 1;
};

/// Learns from the first and the third of four stretches and judges by the others, then the other way round.
rig::UnseenViews DriveCalibrator::Implementation::judge_unseen() const {
  Pairs halves[2];
  for (std::size_t i = 0; i < pairs_.size(); ++i) halves[4 * i / pairs_.size() % 2].push_back(&pairs_[i]);
  rig::UnseenViews unseen;
  for (int half = 0; half < 2; ++half)
    unseen.add(unknowns_, halves[1 - half], rig::PairAdjustment(unknowns_, halves[half]).learn());
  return unseen;
}

void DriveCalibrator::Implementation::learn(DriveCalibration& result) const {
  Pairs all;
  for (const rig::FramePair& pair : pairs_) all.push_back(&pair);
  rig::PairAdjustment adjustment(unknowns_, all);
  const Eigen::VectorXd values = adjustment.learn();
  Eigen::MatrixXd information = adjustment.information();
  result.points = adjustment.points();
  result.contradiction = values.dot(information * values);
  information.diagonal() += unknowns_.priors().cwiseAbs2().cwiseInverse();
  result.covariance = information.inverse();
  for (int i = 0; i < unknowns_.count(); ++i) {
    result.numbers.push_back(unknowns_[i]);
    result.numbers.back().change = values[i];
    result.numbers.back().sigma = std::sqrt(result.covariance(i, i));
  }
  result.learned = unknowns_.at(values);
  result.learned.right_from_left = rounded_transform(result.learned.right_from_left);
  result.change = rig::change_of(given_, result.learned);
}

DriveCalibration DriveCalibrator::Implementation::finish() const {
  DriveCalibration result;
  result.given = result.calibration = result.learned = given_;
  result.frames = frames_;
  result.pairs = pairs();
  if (pairs_.size() < kFewestPairs) return result;
  const rig::UnseenViews unseen = judge_unseen();
  result.unseen_given = unseen.distances(rig::UnseenViews::kGiven);
  result.unseen_learned = unseen.distances(rig::UnseenViews::kLearned);
  learn(result);
  if (unseen.points() < kFewestPoints) return result;
  if (!unseen.fall() || result.contradiction <= kMinContradiction) {
    result.verdict = CalibrationVerdict::as_good;
  } else if (!unseen.rise_in_parts()) {
    result.verdict = CalibrationVerdict::better;
    result.calibration = result.learned;
  }
  return result;
}

DriveCalibrator::DriveCalibrator(const StereoCalibration& given, const StereoRig& rig, int most_pairs, bool learns_k3)
    : implementation_(std::make_unique<Implementation>(given, rig, most_pairs, learns_k3)) {}
DriveCalibrator::~DriveCalibrator() = default;
DriveCalibrator::DriveCalibrator(DriveCalibrator&&) noexcept = default;
void DriveCalibrator::see(const StereoFrame& frame) { implementation_->see(frame); }
void DriveCalibrator::restart() { implementation_->restart(); }
int DriveCalibrator::pairs() const { return implementation_->pairs(); }
DriveCalibration DriveCalibrator::finish() const { return implementation_->finish(); }

std::string DriveCalibration::text() const {
  const std::string learned_from = std::to_string(pairs) + " pairs of " + std::to_string(frames) + " frames",
                    drive = ": drive past near and far objects, turn both ways";
  if (numbers.empty())
    return "this recording cannot show it (" + learned_from + " show a motion, at least " +
           std::to_string(kFewestPairs) + " are needed)" + drive;
  const bool is_bound = *std::min_element(unseen_given.begin(), unseen_given.end()) >= rig::PairAdjustment::kFitLimit;
  const std::string facts = printed(
      ". In frames that were not learned from, points lie %s%.3f px (left) and %.3f px (right) from their predictions "
      "with the given calibration, %.3f and %.3f px with the learned one",
      is_bound ? "at least " : "", unseen_given[0], unseen_given[1], unseen_learned[0], unseen_learned[1]);
  switch (verdict) {
    case CalibrationVerdict::better:
      return "the calibration is off; a better one was learned from " + learned_from + not_observed(*this) + facts;
    case CalibrationVerdict::as_good:
      return "the calibration is as good as given, according to " + learned_from + not_observed(*this) + facts;
    case CalibrationVerdict::cannot_show: break;
  }
  return "this recording cannot show it (" + learned_from +
         " show too few points, or the learned calibration is better on the whole and worse in parts of the images or "
         "at some distances)" +
         drive + (std::isfinite(unseen_given[0] + unseen_given[1]) ? facts : "");
}

const char* to_string(CalibrationVerdict verdict) {
  switch (verdict) {
    case CalibrationVerdict::better: return "better";
    case CalibrationVerdict::as_good: return "as_good";
    case CalibrationVerdict::cannot_show: return "cannot_show";
  }
  return "";
}

}  // namespace quadedge
