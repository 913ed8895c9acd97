#pragma once
/// \file paper_frontend.hpp  The front end of the paper's method (doc/paper.md), in plain C++ on all processors.

#include "edges/frontend.hpp"
#include "paper/cascades.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge::frontend {

/// The edges of a frame with their images and the descriptions of the stereo edges.
struct PaperFrameEdges : FrameEdges {
  std::optional<paper::Picture> left, right;
  paper::Described left_described, right_described;
};

/// It has no global search and keeps no frames: those functions throw std::logic_error.
class PaperFrontend : public Frontend {
 public:
  PaperFrontend(const StereoRig& rig, const Config& config);

  FrameEdgesHandle process(const StereoFrame& frame) override;
  FrameEdgesHandle latest() const override { return frames_.current_handle(); }
  /// The search of the paper: around the previous positions, whatever `search` contains.
  void match(const FrameEdges& base, const FrameEdges& current, const TemporalSearch& search,
             TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, int edges, TemporalMatches& matches) override;
  void match_globally(const FrameEdges& base, const FrameEdges& current, const GlobalSearch& among,
                      TemporalMatches& matches) override;
  KeptFrameEdges keep() override;
  FrameEdgesHandle restore(const KeptFrameEdges& kept) override;
  EdgeSet edges(Side side) override { return side == Side::right ? right_edges_ : left_edges_; }
  std::size_t device_bytes() const override { return 0; }

 private:
  EdgeSet detect(const Image& image, const PixelMask& mask);
  void tap_stereo(const paper::StereoMatching& matching);
  void tap_temporal(const paper::StereoEdgesInView& before, const paper::StereoEdgesInView& now,
                    const paper::SideMatching& matching, Side side);
  void tap_quads(const paper::SideMatching& left, const paper::SideMatching& right);

  Config config_;
  EpipolarGeometry geometry_;
  reference::EdgeThreshold threshold_;
  EdgeSet left_edges_, right_edges_;
  FrameEdgesPool<PaperFrameEdges> frames_;
};

}  // namespace quadedge::frontend
