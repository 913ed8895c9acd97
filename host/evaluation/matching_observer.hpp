#pragma once
/// \file matching_observer.hpp  Evaluates the results of the pipeline's filters while it runs over a pair or a
/// sequence.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "evaluation/edge_truth.hpp"
#include "evaluation/matching_result.hpp"
#include "evaluation/matching_source.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::evaluation {

/// A tap of one StereoOdometry. To be called per frame: begin(), StereoOdometry::track(), end(). It has no effect on
/// the pipeline; the pipeline reports what each search looks for and which search gave the motion.
class MatchingObserver : public Tap {
 public:
  /// \param distributions also collect the cues of all candidates
  MatchingObserver(const StereoRig& rig, const Config& config, const MatchingTolerance& tolerance,
                   bool distributions = false);

  /// Sets the ground truth of the next frame. \param frame its number in the pipeline
  void begin(int frame, FrameTruth truth);
  /// Takes the pipeline's result of the frame and returns the measurements. Only the temporal search that gave the
  /// motion of the frame is evaluated; a lost frame has none.
  FrameMatching end(const FrameResult& result);
  /// The final stereo edges with ground truth of the last frame.
  const std::vector<FinalMatch>& final_matches() const { return final_matches_; }

  void edges(const EdgeSet& left, const EdgeSet& right) override;
  void stereo_filter(StereoFilter filter, const CandidateLists& candidates) override;
  void stereo(const StereoEdges& edges) override;
  void temporal_search(const ObservedSearch& search) override;
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) override;
  void quads(const TemporalMatches& matches) override;

 private:
  /// A frame with which others may be matched.
  struct ObservedFrame {
    FrameTruth truth;
    StereoEdges edges;
    std::vector<std::uint8_t> veridical;                                ///< one per stereo edge
    Eigen::Isometry3d world_from_left = Eigen::Isometry3d::Identity();  ///< as estimated by the pipeline
  };
  /// One search of the current frame: the ground truth of its edges, and its results.
  struct Search {
    int base_frame = 0;
    EdgePositions expected[2];  ///< this and the next two: left, right
    TruePositions later[2];
    Pools pools[2], quad_pools;
    /// Nothing if the true motion is unknown, or if only a subset of the edges is searched for, which gives a
    /// prediction but never a pose.
    std::optional<TemporalMatching> measured;
    std::vector<CueDistribution> cues;
  };
  ObservedFrame& current() { return frames_.at(frame_); }
  bool is_known_motion(const ObservedFrame& base) {
    return base.truth.world_from_left && current().truth.world_from_left;
  }
  const PinholeCamera& camera(Side side) const { return side == Side::left ? rig_.left : rig_.right; }

  void start_temporal(const ObservedFrame& base, Search& search);
  void judge_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates);
  void collect_stereo(StereoFilter filter, const CandidateLists& candidates);
  void collect_temporal(TemporalFilter filter, Side side, const CandidateLists& candidates);
  void measure_quads(const TemporalMatches& matches);

  StereoRig rig_;
  Config config_;
  MatchingTolerance tolerance_;
  std::vector<CueDistribution> empty_cues_;
  int frame_ = -1;
  std::map<int, ObservedFrame> frames_;  ///< by frame number: the current frame, and those that it may be matched with
  FrameMatching measured_;
  std::vector<FinalMatch> final_matches_;

  EdgeSet left_, right_;
  TruePositions stereo_truth_;
  Pools stereo_pools_;
  std::map<int, Search> searches_;  ///< of the current frame, by number
  Search* search_ = nullptr;        ///< the search in progress
};

/// Options of evaluate_matching().
struct MatchingOptions {
  int frames = 0;  ///< number of frames to use from each source; 0: all
  MatchingTolerance tolerance;
  bool distributions = false;  ///< whether to collect distributions of the cues
  int draw_frame = -1;         ///< frame to keep for drawing (the last one if there are fewer frames); -1: none
  std::function<void(int done, int total)> progress;
};

/// Tracks the frames of a source with a tap on the pipeline. If the configuration does not limit the disparity, the
/// source's limit applies. \throws UsageError for the reference device, whose stages have no taps; DataError;
/// DeviceError
MatchingResult evaluate_matching(const MatchingSource& source, Device& device, Config config,
                                 const MatchingOptions& options = {});

}  // namespace quadedge::evaluation
