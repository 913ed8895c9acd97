#pragma once
/// \file staged_frontend.hpp  The control flow of a front end, over stages that the device and the C++ reference
/// implement.

#include <optional>

#include "edges/frontend.hpp"
#include "edges/range_follower.hpp"
#include "geometry/disparity_range.hpp"

namespace quadedge::frontend {

/// Stereo edges that take part in a global search: every step-th of a frame's own edges, or of some of them.
struct WideSubset {
  const StereoEdges& edges;
  int step;
};

/// Decides what is computed, how often a frame is searched, and which counts it has.
class StagedFrontend : public Frontend {
 public:
  FrameEdgesHandle process(const StereoFrame& frame) override;
  void match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch& search,
             TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, int edges, TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, const GlobalSearch& among,
                      TemporalMatches& matches) override;
  FrameEdgesHandle restore(const KeptFrameEdges& kept) override;

 protected:
  StagedFrontend(const StereoRig& rig, const Config& config);

  /// Starts the next frame, with the undistorted images of `frame`.
  virtual FrameEdges& start(const StereoFrame& frame) = 0;
  /// Detects and selects the edges of both images. Sets their spacing and all counts of edges.
  virtual void detect(FrameEdges& current) = 0;
  /// Describes the edges of both images by patches and, if asked, by SIFT.
  virtual void describe(const FrameEdges& current, bool by_sift) = 0;
  /// The stereo cascade, from the candidates to the stereo edges. \param coarse search of the coarse disparity that is
  /// consulted, if any
  virtual RelaxationTally find_stereo_edges(FrameEdges& current, const EpipolarGeometry& geometry,
                                            const DisparityProbe& probe,
                                            const std::optional<CoarseDisparityArguments>& coarse) = 0;
  /// Describes the stereo edges for the searches in time.
  virtual void finish(FrameEdges& current) = 0;
  /// Passes the stereo cascade to the tap, up to the last filter.
  virtual void tap_stereo() = 0;
  /// Computes SIFT descriptors of a frame's stereo edges, unless they exist.
  virtual void describe_by_sift(FrameEdges& frame_edges) = 0;
  virtual void search_in_time(FrameEdges& base, FrameEdges& current, const TemporalSearch& search,
                              TemporalMatches& matches) = 0;
  /// Matches by wide descriptors. Of a restored base all edges take part.
  virtual TemporalMatches search_globally(const FrameEdges& base, const WideSubset& of_base, const FrameEdges& current,
                                          const WideSubset& of_current) = 0;
  /// Edges that are not in use, for those that are restored.
  virtual std::shared_ptr<FrameEdges> spare() = 0;
  /// Takes over the kept descriptions of a frame whose edges are restored.
  virtual void load(const KeptFrameEdges& kept, FrameEdges& restored) = 0;
  /// The edges, to be changed. \throws std::invalid_argument for those of another front end
  virtual FrameEdges& own(const FrameEdges& frame_edges) = 0;

  EpipolarGeometry corrected_geometry() const { return corrected(range_.geometry(), rows().error(), calibration_); }
  bool corrects_rows() const { return rows().error().largest() > 0; }
  /// All edges of a frame that a search for about `wanted` uses.
  static WideSubset about(int wanted, const FrameEdges& frame_edges) {
    return {frame_edges.edges, global_step(frame_edges.edges.size(), wanted)};
  }

  Config config_;
  RangeFollower range_;

 private:
  /// Runs the stereo cascade. \returns false if the frame is to be searched again
  bool search_stereo(FrameEdges& current);

  CoarseGate gate_;
};

}  // namespace quadedge::frontend
