#pragma once
/// \file reference_frontend.hpp  The frontend in plain C++: the oracle as a whole pipeline (`--device reference`).

#include "frontend/frontend.hpp"
#include "reference/candidate_filters.hpp"
#include "reference/temporal_candidates.hpp"

namespace quadedge::frontend {

/// Slow, clear, single-threaded.
class ReferenceFrontend : public Frontend {
 public:
  ReferenceFrontend(const StereoRig& rig, const Config& config);

  void process(const StereoFrame& frame) override;
  void keep(bool as_key) override;
  void previous_to_key() override;
  void match(Base base, const TemporalSearch& search, TemporalMatches& matches) override;
  void match_anywhere(Base base, TemporalMatches& matches) override;
  EdgeSet edges(bool right) override { return right ? right_edges_ : left_edges_; }
  std::size_t device_bytes() const override { return 0; }

 private:
  /// Images and descriptions of one rig's stereo edges.
  struct RigMemory {
    Image left, right;
    reference::EdgeDescriptions left_descriptions, right_descriptions;
  };

  reference::Candidates side_candidates(int side, const TemporalSearch& search) const;

  StereoRig rig_;
  Config config_;
  EpipolarGeometry epipolar_;
  EdgeSet left_edges_, right_edges_;
  RigMemory now_, before_, key_memory_;
};

}  // namespace quadedge::frontend
