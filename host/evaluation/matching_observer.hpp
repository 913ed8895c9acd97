#pragma once
/// \file matching_observer.hpp  Judges what the pipeline's filters leave, while it runs.

#include <optional>

#include "evaluation/edge_truth.hpp"
#include "evaluation/matching_result.hpp"
#include "quadedge/config.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// A tap of one StereoOdometry. Per frame: begin(), StereoOdometry::track(), end(). The pipeline learns nothing from it.
class MatchingObserver : public Tap {
 public:
  MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance);

  /// The truth of the frame that is tracked next.
  void begin(FrameTruth truth);
  /// Takes the pipeline's own result of the frame and returns what was measured.
  FrameMatching end(const FrameResult& result);

  void edges(const EdgeSet& left, const EdgeSet& right) override;
  void stereo_filter(int order, const std::string& name, const CandidateLists& candidates) override;
  void stereo(const StereoEdges& edges) override;
  void temporal_filter(int order, const std::string& name, int side, const CandidateLists& candidates) override;
  void quads(const TemporalMatches& matches) override;

 private:
  /// A frame that others are matched with.
  struct Rig {
    FrameTruth truth;
    StereoEdges edges;
    std::vector<std::uint8_t> veridical;  ///< per stereo edge
  };
  void start_temporal();
  void measure_constraints(const TemporalMatches& matches, const std::vector<std::uint8_t>& known,
                           const std::vector<std::uint8_t>& veridical);

  StereoRig rig_;
  Config config_;
  MatchingTolerance tolerance_;
  Rig current_;
  std::optional<Rig> base_;
  FrameMatching measured_;

  EdgeSet left_, right_;
  TruePlaces stereo_truth_;
  Pools stereo_pools_;
  TruePlaces later_left_, later_right_;
  Pools left_pools_, right_pools_, quad_pools_;
  bool complete_search_ = false;  ///< the lists have a row for every previous stereo edge
};

}  // namespace quadedge::evaluation
