#pragma once
/// \file motion_selection.hpp  Chooses the camera's motion among those that were confirmed, accepts or refuses it, and
/// says how much has to be tried (doc/method.md section 7).

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "motion/motion_estimate.hpp"
#include "quadedge/config.hpp"

namespace quadedge::odometry {

struct MotionStep;

using pose::Refusal;

/// How much is tried to find a motion. Each level includes those before.
enum class SearchLevel {
  prediction,   ///< the search near the prediction only
  inexpensive,  ///< hypotheses that cost little beside the rest of a frame
  everything    ///< global matches, which take as long as the rest of a frame
};

/// Why a motion may not be the camera's.
enum class AmbiguityKind {
  none,
  moving_image,      ///< most of the image moves differently
  moving_sides,      ///< the camera seems to stand still, while a part of the image on all sides moves
  static_scene,      ///< a part of the image is static that the motion would have moved
  competing_motion,  ///< another motion explains nearly as much
  repeated_scene,    ///< a motion that differs by a period of the scene explains the same
  other_part,        ///< another motion explains parts of the image of which the motion explains nothing
  recent_other_part  ///< one did in one of the last frames
};

/// An ambiguity and the ratio that shows it: the verdict's, the area that only the competing motion explains in units
/// of the chosen one's, or the fraction of the image that moves otherwise.
struct Ambiguity {
  AmbiguityKind kind = AmbiguityKind::none;
  double ratio = 0;

  bool exists() const { return kind != AmbiguityKind::none; }
};

/// What is known of a motion that was tried. What is measured after the reason to refuse it has its default.
struct Verdict {
  double support = 0;       ///< inliers divided by the base's edges that the motion brings into view
  double area = 0;          ///< mean over the image cells of the fraction of edges that agree closely
  double moving_ratio = 0;  ///< fraction of the edges in view in cells that hardly follow the motion
  double static_ratio = 0;  ///< fraction of the quads that are static although the motion would have moved them
  double still_ratio = 0;   ///< fraction of the quads that are static as the motion would have them
  double around_ratio = 0;  ///< fraction of the image cells that move, beyond noise, if they lie on all sides; else 0
  int inliers = 0;
  int followed = 0;                                ///< number of image cells that follow the motion
  int moving_cells = 0;                            ///< number of those that move, beyond noise
  std::optional<Eigen::Vector4d> moving_box = {};  ///< of the largest group of these: left, top, right, bottom [px]

  bool has_all_inliers = true;  ///< false: confirmed with close agreement, which uses fewer quads than there are
  bool agrees_globally = true;  ///< with the global matches, if there are any
  double global_ratio = 0;      ///< fraction of the global matches that agree; 0 if there are none
  double rival_ratio = 0;       ///< global matches of another motion that they propose, over those that agree

  Refusal refusal = Refusal::no_consensus;
  // Of the motion that select() chose:
  Ambiguity ambiguity;
  bool is_predicted = false;  ///< whether it is the prediction's, which repeats a motion that was not ambiguous
  SearchLevel needed = SearchLevel::everything;  ///< if less was tried, the choice is preliminary

  bool is_confirmed() const { return refusal == Refusal::none; }
  /// Refuses the motion, unless there was a reason before.
  void refuse(Refusal reason) {
    if (is_confirmed()) refusal = reason;
  }
};

/// What is known about the prediction.
struct Expectation {
  std::optional<std::size_t> predicted;  ///< index of the verdict on it; nothing without a prediction
  bool was_ambiguous = false;            ///< whether the last motion, which it repeats, was ambiguous
  double confident_support = 0;          ///< support from which it is accepted without further tests
};

/// In words, for a frame's message.
std::string to_string(const Ambiguity& ambiguity);
/// Why the motion was refused, in words.
std::string refusal_text(const Verdict& verdict);

/// Comparisons of two motions by the indices of their verdicts.
struct Comparison {
  /// Whether most inliers of the first motion agree with the second one.
  std::function<bool(std::size_t, std::size_t)> is_same;
  /// Explained area of the first motion in cells that do not follow the second one, without edges that the latter
  /// explains closely as well.
  std::function<double(std::size_t, std::size_t)> area_beside;
  /// Whether the motions differ by a period of a scene that repeats, which does not tell them apart.
  std::function<bool(std::size_t, std::size_t)> is_repeated;
};

/// Takes the motion that explains the largest area of the image and completes the verdict on it.
/// \param verdicts in the order in which the motions were tried, at least one \returns the index of the verdict
std::size_t select(std::vector<Verdict>& verdicts, const Expectation& expectation, const Comparison& comparison);

/// The final answer: an ambiguous motion is refused if it is not accepted. \param later an ambiguity found since
void decide(bool accepts_ambiguous, const Ambiguity& later, Verdict& chosen);

/// A motion found in the image cells that do not follow the chosen motion.
struct OtherPart {
  double area = 0;         ///< fraction of all cells that follow it
  double ratio = 0;        ///< fraction of the cells searched that follow it
  double spread = 0;       ///< of these cells over the image, in units of that of all, in x or y, the smaller one
  double chosen_area = 0;  ///< fraction of all cells that follow the chosen motion
  // Of the global matches between the cells searched:
  double balance = 0;            ///< number of those that only it explains over that of those of the chosen motion
  double match_spread = 0;       ///< of the cells with the former, in units of that of all, in x or y, the smaller one
  bool agrees_globally = false;  ///< whether the former lie in as many places as an estimate needs inliers
  bool is_rest = false;          ///< whether it was found in what another motion, which was no other part, left of them
};

/// Whether it may be the camera's. \param was_ambiguous whether the last motion was \param at_start whether no motions
/// before speak for the chosen one \returns nothing or other_part
Ambiguity ambiguity_of(const OtherPart& part, bool was_ambiguous, bool at_start = false);

/// What the motions of earlier frames say about the next prediction: the support that recent ones had, and whether the
/// last one was ambiguous.
class TrackRecord {
 public:
  explicit TrackRecord(const Config& config);

  /// Records the motion that was chosen; a failure resets the support.
  void remember(const MotionStep& found);
  /// A part of the image is masked from now on. If the last motion was ambiguous, so are the next ones, which the edges
  /// of the frames before still decide.
  void remember_mask();

  /// Support from which a motion near the prediction is accepted without further tests: temporal.confident_support, or
  /// less if recent motions had low support and no other motion was found; 0 if there is no global search to ask.
  double confident_support() const;
  /// Whether the parts of the image that do not follow a motion have to be searched for another one.
  bool is_check_due(const Verdict& chosen) const;
  /// Whether the last motion, which the prediction repeats, was ambiguous.
  bool was_ambiguous() const { return was_ambiguous_; }
  /// Whether these are the first motions of the recording, or after a loss.
  bool at_start() const { return start_frames_ > 0; }
  /// recent_other_part if one of the last searches found another motion, which is seldom gone so soon; else nothing.
  Ambiguity recent_other_part() const;

 private:
  TemporalConfig limits_;
  double recent_support_ = 0;  ///< since the last failure
  bool was_ambiguous_ = false;
  int start_frames_;  ///< frames until motions before speak for one
  int frames_to_check_ = 0;
  int doubtful_checks_ = 0;  ///< searches that have to find nothing until the motion found last is forgotten
  int rechecks_;             ///< searches in the next frames; 0: the last ones found no other motion
  double checked_moving_ratio_ = 0;
};

}  // namespace quadedge::odometry
