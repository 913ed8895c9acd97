#pragma once
/// \file quads.hpp  Quads as the pose estimator sees them: structures of arrays for scoring, full measurements for
/// fitting.

#include <cstdint>
#include <optional>
#include <vector>

#include "pose/oriented_point.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::pose {

/// What decides whether a quad is used and how its tangent is seen.
struct QuadLimits {
  explicit QuadLimits(const Config& config);
  double min_epipolar_angle;  ///< see measure() [rad]
  double direction_sigma;     ///< noise of an edge's direction [rad]
  /// Standard deviation of the depth slopes that scenes have: surfaces turn away by 45 degrees, whatever the camera.
  static constexpr double kSlopePrior = 1.0;
};

/// What scoring a hypothesis reads, one row per quad, single precision (1e-4 px).
struct ScoringArrays {
  std::vector<float> ray_x, ray_y;   ///< K^-1 (x, y, 1) of the previous left pixel, third component 1
  std::vector<float> inverse_depth;  ///< previous, 1/m
  /// Previous tangent with its most plausible depth slope, previous left camera's frame, unit norm. The slope of a far
  /// edge is noise divided by a small parallax; left as measured it turns the projected tangent at the next parallax
  /// and costs true quads the orientation test. So here the measured slope is weighed against QuadLimits::kSlopePrior
  /// by its own uncertainty.
  std::vector<float> tangent_x, tangent_y, tangent_z;
  std::vector<float> left_x, left_y, left_cos, left_sin;      ///< current left pixel and unit direction in the image
  std::vector<float> right_x, right_y, right_cos, right_sin;  ///< current right pixel and unit direction in the image
  /// An edge stands for the piece of its curve that reaches so far to both sides, along which its place is a matter of
  /// chance: nearly half of the distance to its neighbours [px]. 0 where all edges of a curve take part.
  float half_length = 0;

  std::size_t size() const { return ray_x.size(); }
  void reserve(std::size_t rows);
  void clear();
  void resize(std::size_t rows);
  /// Appends row `row` of `other`.
  void append_row(const ScoringArrays& other, std::size_t row);
};

/// Quads: the stereo edge of the previous (or key) rig and the one of the current rig that shows the same place of the
/// scene. All arrays have one row per quad; every point lies in front of both cameras of its rig.
struct QuadObservations {
  std::vector<StereoMeasurement> previous, current;  ///< in the left camera's frame of their time
  ScoringArrays scoring;
  std::vector<float> ncc;                        ///< similarity, higher is better
  std::vector<std::int32_t> competing_clusters;  ///< how many other matches the previous edge has (0: unambiguous)
  std::vector<std::int32_t> match;               ///< the caller's number for the quad (row of TemporalMatches)

  std::size_t size() const { return previous.size(); }
  /// Appends a quad from its four edges. Pixels and radians. \returns false, and appends nothing, when one of the two
  /// stereo edges has no depth or no tangent (see measure()).
  bool append(const StereoRig& rig, const StereoObservation& previous_edge, const StereoObservation& current_edge,
              float ncc_value, std::int32_t competing, std::int32_t match_number, const QuadLimits& limits);
  void resize(std::size_t quads);
  /// Sets quad `i`, see append().
  void set(std::size_t i, const StereoMeasurement& before, const StereoMeasurement& after,
           const StereoObservation& current_edge, float ncc_value, std::int32_t competing, std::int32_t match_number,
           const QuadLimits& limits);
};

/// The measurements of all stereo edges of a rig; nothing for an edge without depth or tangent.
using MeasuredEdges = std::vector<std::optional<StereoMeasurement>>;

/// \param min_epipolar_angle see measure() [rad]
void measure_edges(const StereoRig& rig, const StereoEdges& edges, double min_epipolar_angle, MeasuredEdges& measured);

/// All quads of two rigs: the stereo edges that `matches` pairs, each at its detected position. Across the edge, where
/// a quad is measured, detection is more exact than the photometric refinement of the match (KITTI 06, frame to
/// frame: 1.6 cm per frame against 2.3 cm), whose patches lie beside the edge; the refinement tells right matches from
/// wrong ones. Matches without depth are left out, QuadObservations::match says which row a quad came from.
QuadObservations build_quads(const StereoRig& rig, const StereoEdges& previous, const StereoEdges& current,
                             const TemporalMatches& matches, const QuadLimits& limits);

/// build_quads() with all edges measured beforehand, and with buffers that are kept between calls.
class QuadBuilder {
 public:
  /// \param current_measured of the edges `current`
  void build(const MeasuredEdges& previous, const StereoEdges& current, const MeasuredEdges& current_measured,
             const TemporalMatches& matches, const QuadLimits& limits, QuadObservations& quads);
  /// \param spacing the larger distance of the lines on which the edges of the two rigs lie; 0: all edges [px]
  static float half_length(double spacing);

 private:
  std::vector<std::size_t> rows_;
};

}  // namespace quadedge::pose
