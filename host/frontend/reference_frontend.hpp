#pragma once
/// \file reference_frontend.hpp  The front end in C++, used as the reference for the whole pipeline (`--device
/// reference`).

#include "frontend/coarse_gate.hpp"
#include "frontend/frontend.hpp"
#include "frontend/range_follower.hpp"
#include "reference/candidate_filters.hpp"
#include "reference/edge_threshold.hpp"
#include "reference/stereo_candidates.hpp"
#include "reference/stereo_clusters.hpp"
#include "reference/stereo_relaxation.hpp"

namespace quadedge::frontend {

/// A rig with its images and the descriptors of its stereo edges.
struct ReferenceRig : Rig {
  Image left, right;
  reference::EdgeDescriptions left_descriptions, right_descriptions;
  std::vector<std::uint8_t> wide;  ///< wide descriptors of all edges, only of a restored rig
};

/// Optimised for clarity, not speed; single-threaded.
class ReferenceFrontend : public Frontend {
 public:
  ReferenceFrontend(const StereoRig& rig, const Config& config);

  RigHandle process(const StereoFrame& frame) override;
  void match(const Rig& base, const TemporalSearch& search, TemporalMatches& matches) override;
  void match_globally(const Rig& base, int edges, TemporalMatches& matches) override;
  void match_globally(const Rig& base, const GlobalSearch& among, TemporalMatches& matches) override;
  KeptRig keep() override;
  RigHandle restore(const KeptRig& kept) override;
  EdgeSet edges(Side side) override { return side == Side::right ? right_edges_ : left_edges_; }
  std::size_t device_bytes() const override { return 0; }

 private:
  /// Detects the edges of both images, limited by the budget.
  void detect(ReferenceRig& now, double threshold);
  /// The stereo cascade, within the current disparity range. \returns false if the frame is to be searched again
  bool search_stereo(ReferenceRig& now, const reference::EdgeDescriptions& left,
                     const reference::EdgeDescriptions& right);
  void tap_candidates();
  void tap_clusters();

  Config config_;
  reference::EdgeThreshold threshold_;
  RangeFollower range_;
  CoarseGate gate_;
  EdgeSet left_edges_, right_edges_;
  // Of the last search_stereo(), for taps:
  reference::Candidates candidates_;
  reference::CandidateScores scores_;
  reference::StereoClusters clusters_;
  reference::StereoRelaxation relaxation_;
  RigPool<ReferenceRig> rigs_;
};

}  // namespace quadedge::frontend
