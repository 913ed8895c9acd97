#pragma once
/// \file motion_step.hpp  The motion from an earlier frame to the current one: the query, and what is found.

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/pool.hpp"
#include "edges/frame_edges.hpp"
#include "motion/motion_estimate.hpp"
#include "motion/motion_selection.hpp"
#include "motion/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/rig_estimate.hpp"
#include "rig/image_jump.hpp"

namespace quadedge::odometry {

/// What is known about the current frame before its edges are matched with earlier ones.
struct MotionQuery {
  frontend::FrameEdgesHandle current;
  frontend::FrameEdgesHandle base;  ///< the edges that the motion starts from
  frontend::FrameEdgesHandle key;   ///< the keyframe, preferred while in view; null if the base is the keyframe
  Eigen::Isometry3d base_from_key = Eigen::Isometry3d::Identity();  ///< valid if `key` is not null
  std::optional<Eigen::Isometry3d> prediction;                      ///< current_from_base by constant velocity
  bool at_start = false;  ///< whether the base is the first frame, and nothing has been lost since
  std::uint64_t seed = 0;
  /// Only a motion near the prediction, with more support than chance gives; no global matches.
  bool only_near_prediction = false;
  bool accepts_ambiguous = true;  ///< whether an ambiguous motion is an answer
  RigEstimate rig;                ///< of the current frame, as known before its motion; of others, the same offset
  rig::DisplacementLimits displacement;  ///< of the current right image
};

/// The edges of a base that a motion brings into one cell of the image: how many there are, how many of them were found
/// again, and how many of those the motion explains.
struct ExplainedCell {
  double edges = 0, found = 0, explained = 0;

  /// Whether enough of the edges found again follow the motion.
  bool follows() const;
  /// Whether another motion may be found here: the cell does not follow, or the motion brings no edges into it.
  bool is_free() const { return !(edges > 0) || !follows(); }
};

/// The current left image in square cells of pose.scoring_cell px.
class ExplainedCells {
 public:
  /// Empties the cells and keeps the memory. \param side [px]; 0: a single cell
  void start(const PinholeCamera& camera, double side);
  void clear() { cells_.clear(); }

  /// The cell of a position [px]; null outside the image or for NaN.
  ExplainedCell* at(float x, float y);
  const ExplainedCell* at(float x, float y) const { return const_cast<ExplainedCells*>(this)->at(x, y); }
  int columns() const { return columns_; }
  double side() const { return side_; }  ///< of a cell [px]
  /// Row-major.
  const std::vector<ExplainedCell>& all() const { return cells_; }
  std::vector<ExplainedCell>& all() { return cells_; }

  /// Mean over the cells with edges of the fraction of edges that the motion explains; 0 without edges.
  double explained_area() const;
  /// Standard deviation of the positions of the cells that hold edges, or only of those that follow or do not [cells].
  double spread(std::optional<bool> following = {}) const { return spreads(following).matrix().norm(); }
  /// The same along the rows and along the columns.
  Eigen::Array2d spreads(std::optional<bool> following = {}) const;
  /// Number of cells that hold edges and follow, or do not.
  int count(bool following) const;
  /// Fraction of the edges that lie in cells that do not follow the motion; 0 without edges.
  double moving_ratio() const;

 private:
  double side_ = 1;
  int columns_ = 1, rows_ = 0;
  std::vector<ExplainedCell> cells_;
};

/// Quads between an earlier frame and the current one, and the motion that they support.
struct MotionStep {
  frontend::FrameEdgesHandle base;  ///< the earlier frame
  RigEstimate rig;                  ///< with which the current frame was measured
  TemporalMatches matches;
  pose::QuadObservations quads;  ///< without measurements except while the motion is estimated
  pose::MotionEstimate motion;
  Verdict verdict;  ///< of the estimate, then of the confirmation; in what find() returns, the final one
  // Of a motion that was confirmed with all edges:
  std::vector<std::uint8_t> agrees;  ///< one per quad: whether it agrees closely
  ExplainedCells cells;
  // Of a motion that MotionFinder::find() returns:
  bool shows_other_part = false;  ///< whether the check found another motion
  bool is_checked = false;        ///< whether the rest of the image was searched for another motion

  /// Whether the motion is accepted so far: as a proposal if the matches gave one, then by the confirmation with all
  /// edges, at last by find().
  bool ok() const { return verdict.is_confirmed(); }
  /// Mean inverse depth of the inliers in the earlier left camera [1/m]; 0 without inliers.
  double mean_inverse_depth() const;
  /// Releases the edges and keeps the memory.
  void clear();
};

/// A step's motion since `frame_edges`, which, like the step's own base, is the query's base or key.
Eigen::Isometry3d motion_since(const frontend::FrameEdgesHandle& frame_edges, const MotionQuery& query,
                               const MotionStep& step);

/// A step from a pool.
using StepHandle = Pool<MotionStep>::Handle;

/// Finds the motion of the current stereo edges since an earlier frame.
class MotionFinder {
 public:
  virtual ~MotionFinder() = default;
  /// Returns the motion of the query's current frame, accepted or refused with the reason. The finder must outlive the
  /// handle. The same query gives the same bytes until remember(), hide() or restart() is called.
  virtual StepHandle find(const MotionQuery& query) = 0;
  /// Takes note of the motion that was chosen for a frame.
  virtual void remember(const MotionStep& found) = 0;
  /// Forgets what was noted, and what is hidden.
  virtual void restart() = 0;
  /// No edges are detected in these pixels of the left image from the next frame on.
  virtual void hide(const PixelMask&) {}
  /// Time spent on motions since the last call, without the searches for matches [ms].
  virtual double take_pose_ms() = 0;
};

}  // namespace quadedge::odometry
