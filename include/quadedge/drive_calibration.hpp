#pragma once
/// \file drive_calibration.hpp  The calibration of a stereo rig, learned from a recording with it.

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "quadedge/calibration.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// What a recording says of the calibration that it was given.
enum class CalibrationVerdict {
  better,       ///< what was learned explains frames better that it was not learned from
  as_good,      ///< the given calibration explains them as well
  cannot_show,  ///< too little motion or texture to tell, or one is better here and the other one there
};

/// The name of the enumerator.
const char* to_string(CalibrationVerdict verdict);

/// One number of a calibration, as a change of the given one.
struct LearnedNumber {
  std::string name;
  std::string unit;   ///< "px", "rad", "baselines", or empty for ratios and coefficients
  double change = 0;  ///< 0: as given
  double sigma = 0;   ///< standard deviation of the change
  double prior = 0;   ///< standard deviation that calibrations have before anything is learned
  /// Whether the recording has not narrowed it down.
  bool is_open() const { return !(sigma < 0.7 * prior); }
};

/// What it means to measure with the given calibration if the learned one is true.
struct CalibrationChange {
  struct AtDepth {
    double depth = 0;  ///< m
    double error = 0;  ///< of the measured depth, as a part of it: median of its absolute value over the image
  };
  std::vector<AtDepth> depths;                   ///< at 1, 2, 5, 10 and 50 m
  double rotation = 0;                           ///< of the right camera [rad]
  std::array<double, 2> largest_displacement{};  ///< over the left and the right image [px]
};

/// A learned calibration, and what speaks for it.
struct DriveCalibration {
  CalibrationVerdict verdict = CalibrationVerdict::cannot_show;
  /// The one to use: the learned calibration if the verdict is `better`, else the given one.
  StereoCalibration calibration;
  StereoCalibration given, learned;
  /// What was learned, whatever the verdict, and its covariance, in the order of `numbers`.
  std::vector<LearnedNumber> numbers;
  Eigen::MatrixXd covariance;
  int frames = 0, pairs = 0, points = 0;  ///< seen; pairs of frames and points in them that were learned from
  /// By how much the recording contradicts the given calibration: chi squared of what was learned, by what the frames
  /// alone tell.
  double contradiction = 0;
  /// Median distance of points from where the left and the right camera see them, in frames that were not learned from
  /// [px]. The same points count with either calibration, up to 4 px; NaN below 20 of them.
  std::array<double, 2> unseen_given{}, unseen_learned{};
  CalibrationChange change;

  /// The judgement for the user, in a few sentences.
  std::string text() const;
};

/// By how much a pixel of a recorded image lies where the given calibration does not expect it: its position by the
/// given calibration less its own, for the direction to a distant point that the learned one gives it [px]. NaN where
/// one of the lenses does not show it.
Eigen::Vector2d displacement(const StereoCalibration& given, const StereoCalibration& learned, Side side,
                             const Eigen::Vector2d& pixel);

/// Learns the calibration of a rig from stereo frames of a moving camera, in their order. Needs no device. Identical
/// frames give identical results.
class DriveCalibrator {
 public:
  static constexpr int kMostPairs = 200;

  /// \param rig made from `given`; its masks exclude parts of the images
  /// \param most_pairs pairs of frames that are kept: of a longer recording so many to twice as many, evenly spread
  /// \param learns_k3 whether k3 of Brown's lenses may change; Kalibr's radtan has none
  DriveCalibrator(const StereoCalibration& given, const StereoRig& rig, int most_pairs = kMostPairs,
                  bool learns_k3 = true);
  ~DriveCalibrator();
  DriveCalibrator(DriveCalibrator&&) noexcept;

  /// The next frame of the recording. \throws DataError if images or masks do not fit the rig
  void see(const StereoFrame& frame);
  /// The next frame does not follow the last one.
  void restart();
  /// Pairs of frames kept so far.
  int pairs() const;
  /// Learns from what was seen, and judges it.
  DriveCalibration finish() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace quadedge
