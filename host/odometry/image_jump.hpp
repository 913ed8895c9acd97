#pragma once
/// \file image_jump.hpp  Right images that are displaced along the epipolar lines in single frames: by cameras that
/// swing against one another, or by a line that is read late. doc/method.md section 7.

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "pose/quads.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::odometry {

/// By how much all disparities have grown beyond what a motion of the camera explains, and how certain that is [px].
struct ImageJump {
  double shift = 0, sigma = 0;
  double scatter = 0;  ///< median distance of a disparity from what motion and shift explain

  /// Whether the shift reaches `least` and is neither noise nor an average of different shifts.
  bool is_certain(double least) const;
};

/// Compares the disparities of matched edges with those that a motion predicts, up to small errors of the motion, which
/// change near points more than distant ones. Robust: objects that move by themselves hardly count.
class JumpMeter {
 public:
  /// \returns nothing for too few matches
  std::optional<ImageJump> measure(const pose::MeasuredEdges& before, const pose::MeasuredEdges& now,
                                   const TemporalMatches& matches, const Eigen::Isometry3d& now_from_before);

 private:
  /// A disparity less the predicted one [px], and its change by the shift, by a turn of the camera about x and about y,
  /// and by a step along z.
  struct Row {
    double difference;
    Eigen::Vector4d terms;
  };
  double median_distance(const Eigen::Vector4d& values);

  std::vector<Row> rows_;  ///< both kept for their memory
  std::vector<double> scratch_;
};

}  // namespace quadedge::odometry
