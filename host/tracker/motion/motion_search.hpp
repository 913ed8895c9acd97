#pragma once
/// \file motion_search.hpp  Finds the motion of the current stereo edges since an earlier frame.

#include <optional>
#include <utility>
#include <vector>

#include "edges/frontend.hpp"
#include "motion/motion_evidence.hpp"
#include "motion/motion_proposals.hpp"
#include "motion/motion_selection.hpp"
#include "motion/motion_step.hpp"
#include "quadedge/config.hpp"
#include "rig/image_jump.hpp"

namespace quadedge::odometry {

/// Tries hypotheses about the motion level by level. Each proposal, made from a subset of the edges, is confirmed
/// with all edges; select() chooses among the verdicts and says whether more has to be tried.
class MotionSearch : public MotionFinder {
 public:
  /// Refers to the front end, which must outlive the object. \param rig the calibration
  MotionSearch(const Config& config, frontend::GlobalFrontend& frontend, const StereoRig& rig);

  struct State;
  StepHandle find(const MotionQuery& query) override;
  /// Takes a step of a search, a few milliseconds, between which others may be made. \returns whether it was the last
  bool advance(State& state);
  void remember(const MotionStep& found) override { record_.remember(found); }
  double take_pose_ms() override { return fits_.take_pose_ms(); }
  void hide(const PixelMask& left) override {
    hidden_ = left;
    record_.remember_mask();
  }
  void restart() override {
    hidden_ = {};
    record_ = TrackRecord(config_);
  }

 private:
  enum class Hypothesis {
    near_prediction,
    few_global_matches,
    still_camera,
    global_matches,
    rest_of_global_matches,
    large_radius,
    rest_of_confirmed
  };
  /// What is tried from a level on, if it needs global matches, or is their substitute, only with or without them.
  struct Trial {
    Hypothesis hypothesis;
    SearchLevel level;
    std::optional<bool> with_global;
  };
  /// In an order in which each has what it builds on.
  static constexpr Trial kTrials[] = {{Hypothesis::near_prediction, SearchLevel::prediction, {}},
                                      {Hypothesis::still_camera, SearchLevel::inexpensive, {}},
                                      {Hypothesis::large_radius, SearchLevel::inexpensive, false},
                                      {Hypothesis::global_matches, SearchLevel::everything, true},
                                      {Hypothesis::rest_of_global_matches, SearchLevel::everything, true},
                                      {Hypothesis::rest_of_confirmed, SearchLevel::inexpensive, {}}};
  /// A motion that was proposed, and the result of the confirmation.
  struct Candidate {
    Hypothesis hypothesis;
    StepHandle proposed;
    StepHandle confirmed;              ///< null if the proposal has no motion, or if it led to the known motion
    bool has_support_of_base = false;  ///< whether that has been asked for

    bool is_confirmed() const { return confirmed && confirmed->ok(); }
    StepHandle& outcome() { return confirmed ? confirmed : proposed; }
    const MotionStep& outcome() const { return confirmed ? *confirmed : *proposed; }
  };
  using Candidates = std::vector<Candidate>;
  /// What is known of other motions while one is confirmed.
  struct Others {
    const MotionStep* known = nullptr;          ///< a motion that has been confirmed
    const ExplainedCells* explained = nullptr;  ///< if not null, only edges where it explains nothing are matched
    double least_area = 0;                      ///< a motion that explains less after a round gets no further one
  };

  StepHandle find_by_few_matches(const MotionQuery& query);
  static bool is_close_to_another(Hypothesis hypothesis);
  void try_prediction(MotionQuery& query, Candidates& candidates);
  bool follow_displacement(const MotionStep& near_prediction, MotionQuery& query);
  void check(const MotionQuery& query, StepHandle& found);
  Ambiguity try_periods(const MotionQuery& query, StepHandle& found);
  void attempt(Hypothesis hypothesis, const MotionQuery& query, Candidates& candidates);
  StepHandle propose(Hypothesis hypothesis, const MotionQuery& query, const Candidates& candidates);
  StepHandle confirm(const MotionQuery& query, const Eigen::Isometry3d& current_from_base, bool closely,
                     const Others& others);
  StepHandle match_at_rest(const MotionQuery& query);
  bool may_stand_still(const MotionQuery& query);
  bool use_support_of_base(const MotionQuery& query, Candidate& by_key);
  StepHandle confirm_with(const frontend::FrameEdgesHandle& base, const MotionQuery& query, PoseConfig limits,
                          Eigen::Isometry3d current_from_base, const Others& others);
  std::vector<Verdict> verdicts_on(const Candidates& candidates, const MotionQuery& query) const;
  /// Completes the verdict on the motion chosen. Returns its index.
  std::size_t choose(const Candidates& candidates, const MotionQuery& query, std::vector<Verdict>& verdicts) const;
  Ambiguity search_free_cells(const MotionQuery& query, const MotionStep& chosen);
  Ambiguity search_still_edges(const MotionQuery& query, const MotionStep& chosen);
  OtherPart compare_in_free_cells(const MotionQuery& query, const MotionStep& chosen, const MotionStep& matches,
                                  const MotionStep& proposed);

  Config config_;
  frontend::GlobalFrontend& frontend_;
  rig::JumpMeter jump_meter_;
  MotionFits fits_;
  MotionProposals proposals_;
  MotionEvidence evidence_;
  TrackRecord record_;
  PixelMask hidden_;
  TemporalSearch search_, next_search_, known_search_;  ///< kept between calls
};

/// A search under way, which begins with its query. The MotionSearch that advances it must outlive it.
struct MotionSearch::State {
  MotionQuery query;           ///< with the displacement of the current right image that was found
  StepHandle found = nullptr;  ///< the motion chosen, which only the last step judges finally

  explicit State(MotionQuery asked) : query(std::move(asked)) {}

 private:
  friend class MotionSearch;
  Candidates candidates_;
  SearchLevel level_ = SearchLevel::prediction;
  std::size_t next_ = 0;  ///< number of a trial
};

}  // namespace quadedge::odometry
