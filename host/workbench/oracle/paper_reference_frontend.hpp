#pragma once
/// \file paper_reference_frontend.hpp  The front end of the paper's method in plain C++ on all processors.

#include "edges/paper_frontend.hpp"
#include "paper/cascades.hpp"
#include "reference/edge_detection.hpp"

namespace quadedge::frontend {

/// The edges of a frame with their images and the descriptions of the stereo edges.
struct PaperFrameEdges : FrameEdges {
  std::optional<paper::Picture> left, right;
  paper::Described left_described, right_described;
};

/// The oracle of PaperDeviceFrontend.
class PaperReferenceFrontend : public PaperFrontend {
 public:
  PaperReferenceFrontend(const StereoRig& rig, const Config& config);

  FrameEdgesHandle latest() const override { return frames_.current_handle(); }
  EdgeSet edges(Side side) override { return side == Side::right ? right_edges_ : left_edges_; }
  std::size_t device_bytes() const override { return 0; }

 private:
  FrameEdges& detect(const StereoFrame& frame) override;
  void find_stereo_edges(FrameEdges& current, paper::StereoMatching* all) override;
  void find_quads(const FrameEdges& base, const FrameEdges& current, std::array<paper::SideMatching, 2>* all,
                  TemporalMatches& matches) override;
  CandidateLists near_lines(const EpipolarGeometry& geometry) override;
  CandidateLists near_previous(const FrameEdges& before, const FrameEdges& now, Side side) override;
  EdgeSet detect(const Image& image, const PixelMask& mask);

  reference::EdgeThreshold threshold_;
  Image left_, right_;  ///< of the current frame
  EdgeSet left_edges_, right_edges_;
  FrameEdgesPool<PaperFrameEdges> frames_;
};

}  // namespace quadedge::frontend
