#pragma once
/// \file matching_observer.hpp  Judges what the pipeline's filters leave, while it runs.

#include <optional>
#include <string>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "evaluation/matching_result.hpp"
#include "quadedge/config.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// A tap of one StereoOdometry. Per frame: begin(), StereoOdometry::track(), end(). The pipeline learns nothing from
/// it.
class MatchingObserver : public Tap {
 public:
  /// \param distributions also collect the cues of all candidates
  MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance,
                   bool distributions = false);

  /// The truth of the frame that is tracked next.
  void begin(FrameTruth truth);
  /// Takes the pipeline's own result of the frame and returns what was measured.
  FrameMatching end(const FrameResult& result);
  /// The final stereo edges of known truth of the frame that ended last.
  const std::vector<FinalMatch>& final_matches() const { return final_matches_; }

  void edges(const EdgeSet& left, const EdgeSet& right) override;
  void stereo_filter(int order, const std::string& name, const CandidateLists& candidates) override;
  void stereo(const StereoEdges& edges) override;
  void temporal_search(const ExpectedEdges& left, const ExpectedEdges& right, double radius, int step) override;
  void temporal_filter(int order, const std::string& name, int side, const CandidateLists& candidates) override;
  void quads(const TemporalMatches& matches) override;

 private:
  /// A frame that others are matched with.
  struct Rig {
    FrameTruth truth;
    StereoEdges edges;
    std::vector<std::uint8_t> veridical;                                ///< per stereo edge
    Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();  ///< as the pipeline found it
  };
  void start_temporal();
  void collect_stereo(int order, const CandidateLists& candidates);
  void collect_temporal(int order, bool right, const CandidateLists& candidates);
  CueDistribution* cue(CueTable table, int order);
  bool is_known_motion() const { return base_ && base_->truth.world_from_left && current_.truth.world_from_left; }
  void measure_quads(const TemporalMatches& matches);

  StereoRig rig_;
  Config config_;
  MatchingTolerance tolerance_;
  std::vector<CueDistribution> empty_cues_;
  Rig current_;
  std::optional<Rig> base_;
  FrameMatching measured_;
  std::vector<FinalMatch> final_matches_;

  EdgeSet left_, right_;
  TruePlaces stereo_truth_;
  Pools stereo_pools_;
  TruePlaces later_left_, later_right_;
  Pools left_pools_, right_pools_, quad_pools_;
  ExpectedEdges expected_left_, expected_right_;
  bool complete_search_ = false;  ///< the lists have a row for every previous stereo edge
};

}  // namespace quadedge::evaluation
