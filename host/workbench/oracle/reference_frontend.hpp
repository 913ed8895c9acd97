#pragma once
/// \file reference_frontend.hpp  The front end in C++, used as the reference for the whole pipeline (`--device
/// reference`).

#include "edges/noise_gate.hpp"
#include "edges/paper_frontend.hpp"
#include "edges/staged_frontend.hpp"
#include "paper/cascades.hpp"
#include "reference/candidates.hpp"
#include "reference/edge_detection.hpp"
#include "reference/stereo_matching.hpp"
#include "reference/temporal_matching.hpp"

namespace quadedge::frontend {

/// The edges of a frame with their images and the descriptors of the stereo edges.
struct ReferenceFrameEdges : FrameEdges {
  Image left, right;
  reference::EdgeDescriptions left_descriptions, right_descriptions;
  std::vector<std::uint8_t> wide;  ///< wide descriptors of all edges, only of a restored frame
};

/// Optimised for clarity, not speed; single-threaded.
class ReferenceFrontend : public StagedFrontend {
 public:
  ReferenceFrontend(const StereoRig& rig, const Config& config);

  FrameEdgesHandle latest() const override { return frames_.current_handle(); }
  KeptFrameEdges keep() override;
  EdgeSet edges(Side side) override { return side == Side::right ? right_edges_ : left_edges_; }
  std::size_t device_bytes() const override { return 0; }

 private:
  FrameEdges& start(const StereoFrame& frame) override;
  void detect(FrameEdges& current) override;
  void describe(const FrameEdges& current, bool by_sift) override;
  RelaxationTally find_stereo_edges(FrameEdges& current, const EpipolarGeometry& geometry, const DisparityProbe& probe,
                                    const std::optional<CoarseDisparityArguments>& coarse) override;
  void finish(FrameEdges& current) override;
  void tap_stereo() override;
  void describe_by_sift(FrameEdges& frame_edges) override;
  void search_in_time(FrameEdges& base, FrameEdges& current, const TemporalSearch& search,
                      TemporalMatches& matches) override;
  TemporalMatches search_globally(const FrameEdges& base, const WideSubset& of_base, const FrameEdges& current,
                                  const WideSubset& of_current) override;
  std::shared_ptr<FrameEdges> spare() override { return frames_.restored(); }
  void load(const KeptFrameEdges& kept, FrameEdges& restored) override;
  ReferenceFrameEdges& own(const FrameEdges& frame_edges) override { return frames_.own(frame_edges); }
  void tap_temporal(const TemporalSearch& search, const FrameEdges& current,
                    const reference::TemporalMatchResult& result);

  reference::EdgeThreshold threshold_, smoothed_threshold_;
  NoiseGate noise_gate_;
  EdgeSet left_edges_, right_edges_;
  reference::EdgeDescriptions left_described_, right_described_;
  // Of the last find_stereo_edges(), for taps:
  reference::Candidates candidates_;
  reference::CandidateScores scores_;
  reference::StereoClusters clusters_;
  reference::StereoRelaxation relaxation_;
  StereoEdges seen_;  ///< the stereo edges where they lie in the right image
  FrameEdgesPool<ReferenceFrameEdges> frames_;
};

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
