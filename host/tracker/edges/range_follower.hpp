#pragma once
/// \file range_follower.hpp  The disparity range of every frame, chosen from the images, and the frames in which a
/// coarse disparity is consulted. doc/method.md section 3.

#include <vector>

#include "geometry/disparity_range.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// Chooses how far the stereo cascade searches. A range in the configuration is kept. Without one the search starts
/// with that of the rig; a few left edges, the probes, always search up to the limit, and show in the same frame if
/// the range is too small for the scene. Depends only on the rig and the stereo edges of the frames so far.
class RangeFollower {
 public:
  /// \throws DataError if the numbers of the rig give an absurd range
  RangeFollower(const StereoRig& rig, const Config& config);

  /// Begins a frame with the range that the previous frames suggest.
  void start_frame();
  /// Whether the range covers the scene of this frame, given the stereo edges found within it and by the probes. If
  /// not, the range is larger now and the frame is to be searched again; the second answer is always true.
  /// \param left_edges number of edges of the left image
  bool suffices(const StereoEdges& edges, int left_edges);

  /// With the range of the current frame as the limit of the search.
  const EpipolarGeometry& geometry() const { return geometry_; }
  DisparityProbe probe(int left_edges) const;
  /// The range of the current frame, in the middle of the left image [px].
  double disparity() const;

 private:
  float covering(float disparity) const;

  EpipolarGeometry geometry_;
  float middle_x_, middle_y_;  ///< principal point of the left camera [px]
  float limit_ = 0;            ///< no range exceeds it [px]; 0: the range is fixed
  float next_ = 0;             ///< range of the next frame [px]
  bool is_second_search_ = false;
  std::vector<float> probed_, found_;  ///< disparities of the probes and of all stereo edges [px]
};

/// Is open for frames in which neighbours leave stereo.coarse_ties of the edges undecided, and never for a rig that is
/// not rectified. A frame starts as the one before it ended and is searched again if that was wrong, so that its result
/// does not depend on the frames before it.
class CoarseGate {
 public:
  CoarseGate(const StereoConfig& config, bool is_rectified)
      : limit_(is_rectified && config.relaxation_rounds > 0 ? config.coarse_ties : 1) {}

  bool is_open() const { return is_open_; }
  /// Whether the frame was searched as it needs. If not, the gate is as it should be now, and the frame is to be
  /// searched again; for the same tally the second answer is true.
  bool suffices(const RelaxationTally& tally) {
    const bool was_open = is_open_;
    is_open_ = limit_ < 1 && tally.undecided >= limit_ * tally.edges;
    return was_open == is_open_;
  }

 private:
  double limit_;
  bool is_open_ = false;
};

}  // namespace quadedge::frontend
