#pragma once
/// \file unseen_views.hpp  Two calibrations, judged by the same views of points in frames that neither was learned
/// from.

#include <Eigen/Core>
#include <array>
#include <vector>

#include "calibration/pair_adjustment.hpp"

namespace quadedge::rig {

/// Views of the points that the given or the learned calibration explains; where the other one does not, it counts as
/// PairAdjustment::kFitLimit off.
class UnseenViews {
 public:
  enum Calibration { kGiven, kLearned };

  /// \param values of the learned calibration
  void add(const RigUnknowns& unknowns, const std::vector<const FramePair*>& pairs, const Eigen::VectorXd& values);

  int points() const { return points_; }
  /// Medians over the left and the right camera [px].
  std::array<double, 2> distances(Calibration of) const;
  /// Medians over the cells of the left and of the right image, and by distance from near to far [px], NaN below 20
  /// points.
  std::array<std::vector<double>, 3> parts(Calibration of) const;
  /// Whether points fit the learned calibration better, in both cameras.
  bool fall() const;
  /// Whether they fit the given one as much better at some distance, or at several places of an image.
  bool rise_in_parts() const;

 private:
  struct View {
    std::size_t side, place, range;  ///< cell of the image, range of distances
    std::array<double, 2> distance;  ///< with either calibration [px]
  };
  std::vector<View> views_;
  int points_ = 0;
};

}  // namespace quadedge::rig
