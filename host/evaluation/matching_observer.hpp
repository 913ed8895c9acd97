#pragma once
/// \file matching_observer.hpp  Judges what the pipeline's filters leave, while it runs.

#include <map>
#include <optional>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "evaluation/matching_result.hpp"
#include "quadedge/config.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// A tap of one StereoOdometry. Per frame: begin(), StereoOdometry::track(), end(). The pipeline learns nothing from
/// it, and it decides nothing: the pipeline tells what each search looked for and which one gave the motion.
class MatchingObserver : public Tap {
 public:
  /// \param distributions also collect the cues of all candidates
  MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance,
                   bool distributions = false);

  /// The truth of the frame that is tracked next. \param frame its number, as the pipeline counts
  void begin(int frame, FrameTruth truth);
  /// Takes the pipeline's own result of the frame and returns what was measured. Of the searches in time only the one
  /// that the frame's motion was taken from counts; a lost frame has none.
  FrameMatching end(const FrameResult& result);
  /// The final stereo edges of known truth of the frame that ended last.
  const std::vector<FinalMatch>& final_matches() const { return final_matches_; }

  void edges(const EdgeSet& left, const EdgeSet& right) override;
  void stereo_filter(StereoFilter filter, const CandidateLists& candidates) override;
  void stereo(const StereoEdges& edges) override;
  void temporal_search(const ObservedSearch& search) override;
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) override;
  void quads(const TemporalMatches& matches) override;

 private:
  /// A frame that others may be matched with.
  struct Rig {
    FrameTruth truth;
    StereoEdges edges;
    std::vector<std::uint8_t> veridical;                                ///< per stereo edge
    Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();  ///< as the pipeline found it
  };
  /// One search of the current frame: the truth of what it looks for, and what it leaves.
  struct Search {
    int base_frame = 0;
    EdgePositions expected[2];  ///< these and the next two: left, right
    TruePositions later[2];
    Pools pools[2], quad_pools;
    /// Nothing where the motion is unknown, or only a part of the edges is looked for: that makes a prediction, never a
    /// pose.
    std::optional<TemporalMatching> measured;
    std::vector<CueDistribution> cues;
  };
  Rig& current() { return rigs_.at(frame_); }
  bool is_known_motion(const Rig& base) { return base.truth.world_from_left && current().truth.world_from_left; }
  const PinholeCamera& camera(Side side) const { return side == Side::left ? rig_.left : rig_.right; }

  void start_temporal(const Rig& base, Search& search);
  void judge_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates);
  void collect_stereo(StereoFilter filter, const CandidateLists& candidates);
  void collect_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates);
  void measure_quads(const TemporalMatches& matches);

  StereoRig rig_;
  Config config_;
  MatchingTolerance tolerance_;
  std::vector<CueDistribution> empty_cues_;
  int frame_ = -1;
  std::map<int, Rig> rigs_;  ///< by the number of the frame: the current one, and those that it may be matched with
  FrameMatching measured_;
  std::vector<FinalMatch> final_matches_;

  EdgeSet left_, right_;
  TruePositions stereo_truth_;
  Pools stereo_pools_;
  std::map<int, Search> searches_;  ///< of the current frame, by their number
  Search* search_ = nullptr;        ///< the one that goes on
};

}  // namespace quadedge::evaluation
