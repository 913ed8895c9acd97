#pragma once
/// \file pair_adjustment.hpp  Pairs of stereo frames and what they tell of the rig: motions, points and the numbers of
/// the calibration by robust least squares, of which motions and points are eliminated.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <utility>
#include <vector>

#include "calibration/rig_unknowns.hpp"

namespace quadedge::rig {

/// The views of a point: of the left and the right camera, in the first and in the second frame of a pair.
enum View { kLeftFirst, kRightFirst, kLeftSecond, kRightSecond, kViews };

/// A corner where the recorded images of a pair show it [px].
struct SeenPoint {
  std::array<Eigen::Vector2d, kViews> at;
  std::array<bool, kViews> is_seen{};
};

/// Two stereo frames of a recording with a moving camera.
struct FramePair {
  int first = 0, second = 0;                                            ///< numbers of the frames
  Eigen::Isometry3d second_from_first = Eigen::Isometry3d::Identity();  ///< of the left camera, as far as known
  std::vector<SeenPoint> points;
};

/// Points of a pair and their motion, in terms of one calibration.
class PairAdjustment {
 public:
  /// Distance of a point from a view up to which fit() keeps it [px].
  static constexpr double kFitLimit = 4;

  /// \param unknowns, pairs must outlive the object
  PairAdjustment(const RigUnknowns& unknowns, const std::vector<const FramePair*>& pairs);

  /// Learns the unknowns, or with `fixed` values only motions and points. \returns the values
  Eigen::VectorXd learn();
  void fit(const Eigen::VectorXd& fixed);
  /// Estimates the motion of a pair by its points and the given calibration; starts from that of the pair, which may be
  /// far off. \returns the part of the points that agree with it
  static double find_motion(const RigUnknowns& unknowns, FramePair& pair);

  /// Of the unknowns, as the pairs alone tell it, at the values that learn() has found; motions and points eliminated.
  const Eigen::MatrixXd& information() const { return information_; }
  /// How far a point lies from where a view shows it.
  struct Residual {
    View view;
    Eigen::Vector2d at;    ///< px
    double distance;       ///< px; kFitLimit for a point that takes no part
    double inverse_depth;  ///< 1/m
    bool takes_part;
  };
  /// Of all views of all points, whether they take part or not: two calibrations are compared view by view.
  std::vector<Residual> residuals() const;
  int points() const;  ///< that take part

 private:
  struct Point {
    bool is_valid = false;               ///< whether the lens shows it
    Eigen::Vector3d ray;                 ///< of the left camera in the first frame, unit length
    Eigen::Matrix<double, 3, 2> beside;  ///< its tangents
    double inverse_depth = 0;            ///< 1/m
    bool is_alive = false;               ///< whether it takes part
  };
  struct Pair {
    const FramePair* seen = nullptr;
    Eigen::Isometry3d motion;
    std::vector<Point> points;
  };
  struct Cameras;
  struct Terms;
  struct Step;

  /// Calls a function with every pair, point and its views, and with terms of the thread.
  template <class Function>
  void for_all_points(const Function& function);
  void start();
  void settle_points(int rounds);
  void cull(double limit);
  /// \param culls steps before which points that lie farther from a view than a limit [px] cease to take part
  void optimise(bool learns, const std::vector<std::pair<int, double>>& culls);
  void adjust(bool learns, const std::vector<std::pair<int, double>>& culls);
  std::vector<Pair> stepped(bool learns, double damping, Eigen::VectorXd& change);
  double cost(const std::vector<Pair>& pairs, const Eigen::VectorXd& values) const;

  const RigUnknowns& unknowns_;
  std::vector<Pair> pairs_;
  Eigen::VectorXd values_;  ///< of the unknowns
  Eigen::MatrixXd information_;
  double scale_;  ///< distance from which views count less [px]
};

}  // namespace quadedge::rig
