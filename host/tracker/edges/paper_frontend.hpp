#pragma once
/// \file paper_frontend.hpp  What both front ends of the paper's method (doc/paper.md) do alike.

#include <array>

#include "edges/frontend.hpp"
#include "edges/paper_matches.hpp"
#include "geometry/epipolar_geometry.hpp"

namespace quadedge::frontend {

/// The edges of an image are kept on the host. It has no global search and keeps no frames: those functions throw
/// std::logic_error.
class PaperFrontend : public Frontend {
 public:
  FrameEdgesHandle process(const StereoFrame& frame) override;
  /// The search of the paper: around the previous positions, whatever `search` contains.
  void match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch& search,
             TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, int edges, TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, const GlobalSearch& among,
                      TemporalMatches& matches) override;
  KeptFrameEdges keep() override;
  FrameEdgesHandle restore(const KeptFrameEdges& kept) override;

 protected:
  PaperFrontend(const StereoRig& rig, const Config& config);

  /// Detects the edges of both images and sets `counts_`, but for those of edges().
  virtual FrameEdges& detect(const StereoFrame& frame) = 0;
  /// Finds the stereo edges of the frame that was detected last. \param all for a tap, else null
  virtual void find_stereo_edges(FrameEdges& current, paper::StereoMatching* all) = 0;
  /// Both cascades in time, and the quads. \param all of either side, for a tap, else null
  virtual void find_quads(const FrameEdges& base, const FrameEdges& current, std::array<paper::SideMatching, 2>* all,
                          TemporalMatches& matches) = 0;
  /// For a tap: the candidates of all left edges of the latest frame within the limits of `geometry`.
  virtual CandidateLists near_lines(const EpipolarGeometry& geometry) = 0;
  /// For a tap: the stereo edges of `now` within the radius of each of `before`, whatever their directions.
  virtual CandidateLists near_previous(const FrameEdges& before, const FrameEdges& now, Side side) = 0;

  Config config_;
  EpipolarGeometry geometry_;

 private:
  void tap_stereo(const paper::StereoMatching& matching);
  void tap_temporal(const FrameEdges& before, const FrameEdges& now, const paper::SideMatching& matching, Side side);
  void tap_quads(const paper::SideMatching& left, const paper::SideMatching& right);
};

}  // namespace quadedge::frontend
