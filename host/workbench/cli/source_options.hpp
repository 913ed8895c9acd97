#pragma once
/// \file source_options.hpp  Options for the input: a recorded sequence, the user's own cameras, or a rendered
/// scene.

#include <string>
#include <vector>

#include "cli/command.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/stereo_source.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge::cli {

/// PATH, which is a recorded sequence or "-", and the options for the user's own cameras.
class SourceOptions {
 public:
  /// Declares PATH, or what else the command calls it. `help` describes it.
  void declare_path(Options& options, const std::string& help, const std::string& name = "PATH");
  /// --format and --sequence, and --frames for commands that can read a part.
  void declare_layout(Options& options, bool has_frames = true);
  /// --left, --right, --video, --split, --calibration ... as a group.
  void declare(Options& options);
  /// Of these what describes the cameras of two image files: --calibration, --rectified, --fov and --mask.
  void declare_cameras(Options& options);

  /// --restarts, for commands that can start a segment where stamps go back. After declare().
  void declare_restarts(Options& options);

  /// --masks, for commands that track. After declare().
  void declare_masks(Options& options);

  /// Whether anything is given.
  bool is_given() const { return !path_.empty() || own_.is_given(); }
  /// Whether the pairs come from the user's own cameras, not from a published layout.
  bool is_own_camera() const { return path_ == "-" || own_.is_given(); }
  const std::string& path() const { return path_; }
  /// Whether stamps may go back, where a segment starts.
  bool has_restarts() const { return own_.restarts; }
  bool has_calibration() const { return !own_.calibration.empty(); }
  /// The given options and their values in turn, except PATH and --live.
  std::vector<std::string> words() const;
  /// Whether calibration, field of view or mask are given.
  bool has_camera_options() const { return has_calibration() || own_.fov != 0 || !own_.mask.empty(); }
  /// Two image files with these camera options. \throws as open_stereo_source().
  Dataset still_pair(const std::string& left, const std::string& right) const;
  /// The user's own source. \throws UsageError if PATH is given as well.
  StereoSource own_camera() const;
  /// The options of a recorded sequence. \throws UsageError for options that only apply to the user's own cameras.
  DatasetOptions layout() const;
  /// Whether a layout or a sequence is named.
  bool has_layout() const { return layout_.format != "auto" || !layout_.sequence.empty(); }
  /// Opens what is given. \throws UsageError where nothing or too much is given, and as open_dataset() and
  /// open_stereo_source() do.
  Dataset open() const;
  /// Takes another calibration for a dataset that was opened, with the same field of view and masks.
  void replace_calibration(Dataset& dataset, const StereoCalibration& calibration) const;

 private:
  Dataset open_own_camera() const;

  std::string path_, masks_, frames_;
  DatasetOptions layout_;
  StereoSource own_;  ///< calibration, field of view and mask are of recorded sequences too
};

// The options of commands that render: the scene, the path and what disturbs the camera.

/// What is read as text: "WIDTHxHEIGHT" (see set_size()), and "X,Y,Z" in degrees; the focal length, if not 0 [px].
struct SceneTexts {
  std::string size, right_rotation;
  double focal = 0;
};

/// Declares --scene, --frames, those of declare_view(), --lens and --right-rotation, and the disturbances.
void declare_scene(Options& options, SyntheticOptions& scene, SceneTexts& texts);

/// Puts the texts into the options. \throws UsageError.
void set_texts(SyntheticOptions& scene, const SceneTexts& texts);

/// Declares --path and --size (read into `size`, see set_size()).
void declare_view(Options& options, SyntheticOptions& scene, std::string& size);

}  // namespace quadedge::cli
