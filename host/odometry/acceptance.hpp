#pragma once
/// \file acceptance.hpp  Acceptance tests that every motion hypothesis has to pass.

#include <cstdint>
#include <vector>

#include "common/temporal_search.hpp"
#include "odometry/disparity_offset.hpp"
#include "odometry/motion_step.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// A motion has to be supported by the edges that it brings into view. If its support is low, it also has to agree with
/// global matches. Of several motions, the one that explains the largest image area is chosen.
class Acceptance {
 public:
  /// Refers to `offset`, which must outlive the object.
  Acceptance(const Config& config, const DisparityOffset& offset) : config_(config), offset_(offset) {}

  /// Sets the support of `step`. Below temporal.min_support its status becomes no_consensus: within the search radius a
  /// few pixels wide, a wrong motion also finds some support, but less than the true motion.
  /// \param predicted positions at which the base's edges were searched for in the left image
  void test_support(const EdgePositions& predicted, MotionStep& step) const;

  /// Sets the explained area, which is the mean over the image cells of the fraction of predicted edges whose quads
  /// closely agree with the motion, and the moving ratio. Objects are weighted by the area that they cover, not by
  /// their number of edges.
  void measure_area(const EdgePositions& predicted, MotionStep& step);

  /// Whether a part of the image is static that the motion would have moved. Edges are not static by chance, and
  /// distant edges agree with the motion as well. Hence, either the camera did not move, or something moves along with
  /// it.
  bool contradicts_static_scene(const MotionStep& step);

  /// Whether a motion near the prediction is accepted without further tests.
  bool is_confident(const MotionStep& step) const;

  /// Records the support of the motion that was chosen; resets the record after a failure.
  void remember(const MotionStep& found);

  /// Whether so much of the image moves differently that it may show the camera's motion, so that another motion has to
  /// be searched for.
  static bool has_secondary_motion(const MotionStep& step);
  /// Whether most of the image moves differently.
  static bool is_minority_motion(const MotionStep& step);

  /// Whether another motion explains nearly as large an area as `found` and is not the same motion.
  /// \param base_from_other between the rigs that the two motions are measured against
  bool are_competing(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& base_from_other);
  /// Whether most inliers of `found` also agree with `other`.
  bool are_same_motion(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& base_from_other);

  /// Whether global matches agree with a motion in at least as many image cells as an estimate needs inliers. A global
  /// match can lie anywhere in the image, so that a wrong motion agrees with hardly any of them. Matches in the same
  /// cell count once, because the errors of neighbours are correlated.
  bool agrees_with_global_matches(const MotionStep& global_matches, const MotionQuery& query, const MotionStep& step);

 private:
  /// temporal.confident_support, or less if recent motions had low support.
  double confident_support() const;

  struct Cell {
    double edges = 0, found = 0, explained = 0;
  };

  Config config_;
  const DisparityOffset& offset_;
  static constexpr double kUnknownSupport = 1;
  double recent_support_ = kUnknownSupport;      ///< of recent motions
  std::vector<Cell> cells_;                      ///< kept between calls, as are the following buffers
  std::vector<std::uint8_t> agrees_, is_still_;  ///< one per quad
};

}  // namespace quadedge::odometry
