#pragma once
/// \file motion_selection.hpp  Chooses the camera's motion among those that were tried (doc/method.md section 7).

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace quadedge::motion {

/// What a motion explains of the images.
struct Verdict {
  bool found = false;           ///< whether the motion was confirmed; if not, the rest has no meaning
  bool has_all_inliers = true;  ///< false: confirmed with close agreement, which uses fewer quads than there are
  double support = 0;           ///< inliers divided by the base's edges that the motion brings into view
  double explained_area = 0;    ///< mean over the image cells of the fraction of edges that agree closely
  double moving_ratio = 0;      ///< fraction of the edges in view in cells that hardly follow the motion
  double static_ratio = 0;      ///< fraction of the quads that are static although the motion would have moved them
  bool agrees_globally = true;  ///< with the global matches, if there are any
  double global_ratio = 0;      ///< fraction of the global matches that agree; 0 if there are none
};

/// How much is tried to find a motion. Each level includes those before.
enum class Effort {
  prediction,   ///< the search near the prediction only
  inexpensive,  ///< hypotheses that cost little beside the rest of a frame
  everything    ///< global matches, which take as long as the rest of a frame
};

/// What is known about the prediction.
struct Expectation {
  std::optional<std::size_t> trial;  ///< index of the verdict on it; nothing without a prediction
  bool is_doubtful = false;          ///< whether the last motion, which it repeats, was ambiguous
  double confident_support = 0;      ///< support from which it is accepted without further tests
};

/// Why a motion may not be the camera's.
enum class Ambiguity {
  none,
  moving_image,      ///< most of the image moves differently
  static_scene,      ///< a part of the image is static that the motion would have moved
  competing_motion,  ///< another motion explains nearly as much
  motion_elsewhere   ///< another motion explains parts of the image of which the motion explains nothing
};

/// An ambiguity and the ratio that shows it: the verdict's, the area that only the competing motion explains in units
/// of the chosen one's, or the fraction of the image that moves otherwise.
struct Doubt {
  Ambiguity kind = Ambiguity::none;
  double ratio = 0;

  bool exists() const { return kind != Ambiguity::none; }
};

/// A doubt in words, for a frame's message.
std::string to_string(const Doubt& doubt);

/// The choice among the verdicts.
struct Selection {
  std::size_t trial = 0;  ///< index of its verdict
  bool accepted = false;  ///< whether it is the motion of the camera as far as the images tell
  Doubt doubt;
  Effort needed = Effort::everything;  ///< if less was tried, the choice is preliminary
};

/// Comparisons of two trials by their numbers.
struct Comparison {
  /// Whether most inliers of the first trial's motion agree with the second one's.
  std::function<bool(std::size_t, std::size_t)> is_same;
  /// Explained area of the first trial's motion in cells that do not follow the second one's, without edges that the
  /// latter explains closely as well.
  std::function<double(std::size_t, std::size_t)> area_beside;
};

/// Takes the motion that explains the largest area of the image. `verdicts` are in the order of the trials.
Selection select(const std::vector<Verdict>& verdicts, const Expectation& expectation, const Comparison& comparison);

/// What was found in the image cells that do not follow the chosen motion.
struct Elsewhere {
  double area = 0;    ///< fraction of all cells that follow another motion
  double ratio = 0;   ///< fraction of the cells searched that follow it
  double spread = 0;  ///< of these cells over the image, in units of that of all cells
};

/// Whether it is a motion that may be the camera's. \param is_doubtful whether the last motion was ambiguous
/// \returns no doubt, or motion_elsewhere
Doubt doubt_about(const Elsewhere& elsewhere, bool is_doubtful);

}  // namespace quadedge::motion
