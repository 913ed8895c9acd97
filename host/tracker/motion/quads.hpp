#pragma once
/// \file quads.hpp  Quads for the pose estimator: structures of arrays for scoring, full measurements for fitting.

#include <cstdint>
#include <vector>

#include "geometry/measured_edges.hpp"
#include "geometry/oriented_point.hpp"
#include "motion/pose_constants.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::pose {

/// Data used for scoring a hypothesis, one row per quad, single precision (1e-4 px).
struct ScoringArrays {
  std::vector<float> ray_x, ray_y;   ///< K^-1 (x, y, 1) of the previous left pixel, without the third component
  std::vector<float> inverse_depth;  ///< of the previous edge [1/m]
  /// Previous tangent with its most plausible depth slope, in the previous left camera frame, of unit length. The
  /// measured slope of a distant edge is noise divided by a small parallax; used directly, it would rotate the
  /// projected tangent at the next parallax and make correct quads fail the orientation test. The measured slope is
  /// therefore combined with kSlopePrior according to its uncertainty.
  std::vector<float> tangent_x, tangent_y, tangent_z;
  std::vector<float> left_x, left_y, left_cos, left_sin;      ///< current left pixel and unit direction in the image
  std::vector<float> right_x, right_y, right_cos, right_sin;  ///< current right pixel and unit direction in the image
  /// An edge represents a segment of its curve that extends this far to both sides and along which its position is
  /// arbitrary: nearly half the distance to its neighbours [px]. 0 if all edges of a curve are used.
  float half_length = 0;

  std::size_t size() const { return ray_x.size(); }
  void resize(std::size_t rows);
  /// Replaces everything by rows of `other`.
  void assign_rows(const ScoringArrays& other, const std::vector<std::int32_t>& rows);
};

/// All columns of the arrays.
inline constexpr std::vector<float> ScoringArrays::*kScoringColumns[] = {
    &ScoringArrays::ray_x,     &ScoringArrays::ray_y,     &ScoringArrays::inverse_depth, &ScoringArrays::tangent_x,
    &ScoringArrays::tangent_y, &ScoringArrays::tangent_z, &ScoringArrays::left_x,        &ScoringArrays::left_y,
    &ScoringArrays::left_cos,  &ScoringArrays::left_sin,  &ScoringArrays::right_x,       &ScoringArrays::right_y,
    &ScoringArrays::right_cos, &ScoringArrays::right_sin};

/// Quads: a stereo edge of the previous (or key) rig and the stereo edge of the current frame that shows the same scene
/// point. All arrays have one row per quad; every point lies in front of both cameras of its rig.
struct QuadObservations {
  /// In the left camera frame at their time; only fits and samples read them.
  std::vector<StereoMeasurement> previous, current;
  ScoringArrays scoring;
  std::vector<float> ncc;  ///< similarity
  std::vector<std::int32_t>
      competing_clusters;           ///< further clusters of the previous edge's candidates (0: unambiguous)
  std::vector<std::int32_t> match;  ///< the caller's index of the quad (row of TemporalMatches)

  std::size_t size() const { return match.size(); }
  void resize(std::size_t quads);
  /// Sets quad `i`, made of two measured stereo edges and the current edge as detected [px, rad].
  /// \param direction_sigma noise of an edge's direction [rad]
  void set(std::size_t i, const StereoMeasurement& before, const StereoMeasurement& after,
           const StereoObservation& current_edge, float ncc_value, std::int32_t competing, std::int32_t match_number,
           double direction_sigma = kSigmaDirection);
};

/// All quads of two frames: the stereo edges paired by `matches`, each at its detected position, which across the edge
/// is more accurate than the photometric refinement of the match, because the patches lie beside the edge. Matches
/// without depth are dropped; QuadObservations::match gives the row of each quad.
QuadObservations build_quads(const StereoRig& rig, const StereoEdges& previous, const StereoEdges& current,
                             const TemporalMatches& matches);

/// build_quads() with edges measured in advance, and with buffers that are kept between calls.
class QuadBuilder {
 public:
  /// \param current_measured measurements of `current`
  void build(const MeasuredEdges& previous, const StereoEdges& current, const MeasuredEdges& current_measured,
             const TemporalMatches& matches, QuadObservations& quads);
  /// \param spacing the larger of the two rigs' edge spacings [px]
  static float half_length(double spacing);

 private:
  std::vector<std::size_t> rows_;
};

}  // namespace quadedge::pose
