#pragma once
/// \file acceptance.hpp  What to believe of a motion: every test that a hypothesis has to pass.

#include <cstdint>
#include <vector>

#include "common/temporal_search.hpp"
#include "odometry/disparity_offset.hpp"
#include "odometry/motion_step.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

/// A motion has to be supported by the edges that it brings into view. One that little more supports has to agree with
/// edges found anywhere too. Of several, the one that explains the larger area of the image wins.
class Acceptance {
 public:
  /// Refers to the offset, which must outlive it.
  Acceptance(const Config& config, const DisparityOffset& offset) : config_(config), offset_(offset) {}

  /// Sets the step's support. Where it lies under temporal.min_support the step has no consensus: within the few pixels
  /// of a search a wrong motion finds some support too, a true one has to find more.
  /// \param predicted where the search expected the base's edges in the left image
  void test_support(const EdgePositions& predicted, MotionStep& step) const;

  /// Sets the step's explained area: the mean, over the image's cells, of the ratio of predicted edges whose quads
  /// agree closely with the motion, and its moving ratio. A thing counts by the area that it covers, not by the edges
  /// that it is covered with.
  void measure_area(const EdgePositions& predicted, MotionStep& step);

  /// Whether a part of the image stands still that the motion would have moved. Nothing stands still by chance, and
  /// what is far away moves with the motion found as well: either the camera did not move, or something moves with it.
  bool contradicts_static_scene(const MotionStep& step);

  /// Whether a motion near the prediction is believed without asking further.
  bool is_confident(const MotionStep& step) const;

  /// Takes note of the support of the motion that was found in the end; after a failure nothing is known.
  void remember(const MotionStep& found);

  /// Whether so much of the image moves otherwise that it may hold the world's motion: another one has to be looked
  /// for.
  static bool has_secondary_motion(const MotionStep& step);
  /// Whether most of the image moves otherwise.
  static bool is_minority_motion(const MotionStep& step);

  /// Whether another motion explains nearly as large an area as the one found, and is none that a fit would have led
  /// to as well. \param base_from_other between the rigs that both are measured against
  bool are_competing(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& base_from_other);
  /// Whether most inliers of the motion found agree with another one as well.
  bool are_same_motion(const MotionStep& found, const MotionStep& other, const Eigen::Isometry3d& base_from_other);

  /// Whether edges found anywhere agree with a motion: in as many cells of the image as an estimate needs inliers. A
  /// found edge could lie anywhere, so a wrong motion meets next to none of them; neighbours, which may err together,
  /// count once.
  bool agrees_with_global_matches(const MotionStep& global_matches, const MotionQuery& query, const MotionStep& step);

 private:
  /// temporal.confident_support, or less where the scene's edges do not let any motion reach as much.
  double confident_support() const;

  struct Cell {
    double edges = 0, found = 0, explained = 0;
  };

  Config config_;
  const DisparityOffset& offset_;
  static constexpr double kUnknownSupport = 1;
  double reached_support_ = kUnknownSupport;     ///< lately
  std::vector<Cell> cells_;                      ///< kept for their memory, as are these
  std::vector<std::uint8_t> agrees_, is_still_;  ///< one per quad
};

}  // namespace quadedge::odometry
