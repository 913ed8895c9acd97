/// \file source_options.cpp  Declares the options of all inputs; opens a recording, a single pair or a rendered scene.
#include "cli/source_options.hpp"

#include <charconv>
#include <cmath>
#include <cstdio>

#include "cli/console.hpp"
#include "cli/frame_source.hpp"
#include "data/find_sequences.hpp"
#include "quadedge/error.hpp"

namespace quadedge::cli {
namespace {

/// One side of "A:B"; `missing` where it is omitted.
int frame_number(const std::string& text, int missing, const std::string& whole) {
  if (text.empty()) return missing;
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0) {
    throw UsageError("--frames " + whole + ": expected A:B, the first frame and the one after the last, such as 10:50");
  }
  return value;
}

/// Sets the range of frames to "A:B", either of which may be omitted; empty: all. \throws UsageError
void set_frames(DatasetOptions& options, const std::string& frames) {
  if (frames.empty()) return;
  const auto colon = frames.find(':');
  if (colon == std::string::npos) frame_number("?", 0, frames);
  options.first_frame = frame_number(frames.substr(0, colon), 0, frames);
  options.last_frame = frame_number(frames.substr(colon + 1), -1, frames);
}

}  // namespace

void SourceOptions::declare_path(Options& options, const std::string& help, const std::string& name) {
  options.positional(name, path_, help + "; -: images from a pipe", false);
}

void SourceOptions::declare_layout(Options& options, bool has_frames) {
  auto formats = dataset_formats();
  formats.insert(formats.begin(), "auto");
  options.choice("--format", layout_.format, formats, "dataset layout; auto: recognised");
  options.text("--sequence", layout_.sequence, "KITTI: name of the sequence if PATH holds several", "NAME");
  if (has_frames)
    options.text("--frames", frames_, "frames from A up to but not including B; either may be omitted", "A:B");
}

void SourceOptions::declare(Options& options) {
  options.group("Your own cameras (doc/your-own-data.md)");
  options.text("--left", own_.left, "folder of left images, or left video", "A");
  options.text("--right", own_.right, "folder of right images, or right video", "B");
  options.text("--video", own_.video, "video with both views in each picture", "FILE");
  options.text("--split", own_.split, "arrangement of the two views in a picture: left-right or top-bottom", "WORD");
  declare_cameras(options);
  options.number("--fps", own_.fps,
                 "pairs per second, for sources without timestamps and in place of a video's own; images keep the "
                 "timestamps of their names, times.txt or data.csv, if these can be read; 0: the source's own");
  options.text("--times", own_.times, "timestamps that replace all others: seconds, one per line, or EuRoC's data.csv",
               "FILE");
  options.number("--tolerance", own_.tolerance_ms,
                 "largest difference between the timestamps of a pair of image files [ms]; others are dropped; 0: half "
                 "a period");
  options.flag("--live", own_.live,
               "the pipe comes from a camera: drop the oldest pairs when tracking falls behind; without it every pair "
               "is read, and the writer waits");
}

void SourceOptions::declare_cameras(Options& options) {
  options.files("--calibration", own_.calibration,
                "calibration of both cameras in any of the formats in doc/your-own-data.md, replaces that of a "
                "recorded sequence; one file, or left and right",
                "FILE[,FILE]");
  options.flag("--rectified", own_.rectified,
               "the images are rectified: the calibration's P describes them, not K and D");
  options.number(
      "--fov", own_.fov,
      "horizontal field of view of the pinhole images [degrees]; 0: the scale of the lens at its centre, up to 120 "
      "degrees");
  options.files("--mask", own_.mask, "mask image, black where edges are excluded; one file, or left and right",
                "FILE[,FILE]");
}

void SourceOptions::declare_restarts(Options& options) {
  options.flag(
      "--restarts", own_.restarts,
      "timestamps of --times may go back, as where a clock was set: a new segment of the trajectory starts there");
}

void SourceOptions::declare_masks(Options& options) {
  options.text("--masks", masks_,
               "folder with a mask per image: left/NAME.png, right/NAME.png, black where nothing is to be tracked; a "
               "camera without such a folder has none",
               "FOLDER");
}

StereoSource SourceOptions::own_camera() const {
  StereoSource source = own_;
  source.pipe = path_ == "-";
  if (!path_.empty() && !source.pipe) throw UsageError(path_ + ": PATH excludes --left, --right and --video");
  return source;
}

DatasetOptions SourceOptions::layout() const {
  if (!own_.split.empty() || own_.fps != 0 || !own_.times.empty() || own_.live || own_.restarts ||
      own_.tolerance_ms != 0) {
    throw UsageError(
        path_ +
        ": a recorded sequence has its own timestamps; --split, --fps, --times, --restarts, --tolerance and "
        "--live are for --left, --right, --video and -");
  }
  DatasetOptions options = layout_;
  set_frames(options, frames_);
  options.calibration = own_.calibration;
  options.rectified = own_.rectified;
  options.fov = own_.fov;
  options.mask = own_.mask;
  return options;
}

Dataset SourceOptions::open() const {
  if (!is_given()) throw UsageError("no input: expected PATH, or --left, --right and --calibration");
  Dataset dataset = is_own_camera() ? open_own_camera() : open_dataset(path_, layout());
  if (!masks_.empty()) add_masks(dataset, masks_);
  return dataset;
}

Dataset SourceOptions::open_own_camera() const {
  StereoSource source = own_camera();
  if (has_layout()) throw UsageError("--format and --sequence are for datasets in a published layout");
  DatasetOptions range;
  set_frames(range, frames_);
  source.first_frame = range.first_frame;
  source.last_frame = range.last_frame;
  Dataset dataset = open_stereo_source(source);
  for (const auto& warning : dataset.warnings) note("warning: " + warning);
  return dataset;
}

void SourceOptions::replace_calibration(Dataset& dataset, const StereoCalibration& calibration) const {
  StereoRig rig = make_rig(calibration, own_.fov);
  rig.max_value = dataset.rig.max_value;
  rig.max_disparity = dataset.rig.max_disparity;
  if (!own_.mask.empty()) mask_rig(rig, own_.mask);
  dataset.rig = std::move(rig);
  dataset.calibration = calibration;
}

std::vector<std::string> SourceOptions::words() const { return data::source_words(own_); }

Dataset SourceOptions::still_pair(const std::string& left, const std::string& right) const {
  StereoSource source = own_;
  source.left = left;
  source.right = right;
  source.fps = 1;  // one pair needs no stamps
  return open_stereo_source(source);
}

void declare_scene(Options& options, SyntheticOptions& scene, SceneTexts& texts) {
  options.choice("--scene", scene.scene, synthetic_scenes(),
                 "room; cables: thin curves in front of a plain wall; facade: siding, brick, a fence and shrubs; "
                 "yard: a plain wall, a railing and wires");
  options.number("--frames", scene.frames, "number of frames");
  declare_view(options, scene, texts.size);
  options.choice("--rig", scene.rig, synthetic_rigs(),
                 "cameras; eth3d-slam: those of cables_2, of different size and not rectified, which exclude the "
                 "following options and --size");
  options.number("--focal", texts.focal, "focal length [px]; 0: the same field of view for every size");
  options.number("--baseline", scene.baseline, "distance between the cameras [m]");
  options.choice("--lens", scene.lens, synthetic_lenses(),
                 "lens of both cameras; wide ones see more than the pinhole camera");
  options.text("--right-rotation", texts.right_rotation,
               "rotation vector of the right camera, in the axes of the left one [degrees]", "X,Y,Z");
  options.group("Disturbances of the rendered images");
  options.number("--noise", scene.noise, "standard deviation of the camera noise [grey levels]");
  options.number("--gain", scene.gain, "light factor of every second frame");
  options.number("--right-gain", scene.right_gain, "exposure factor of the right camera");
  options.number("--light", scene.light, "light factor of all frames");
  options.number("--gamma", scene.gamma, "grey levels become 255 (v / 255)^(1 / gamma)");
  options.number("--bits", scene.bits, "bits per pixel: 8, 12 or 16");
  options.number("--contrast", scene.contrast,
                 "contrast factor around grey level 128, applied to the finished image, noise included");
  options.number("--blur", scene.blur,
                 "mean length of the motion blur along the path [px]; at most the motion between frames");
  options.number("--mover", scene.mover,
                 "fraction of the image covered by a rectangle that moves independently, 0 to 0.6");
}

void set_texts(SyntheticOptions& scene, const SceneTexts& texts) {
  const SyntheticOptions defaults;
  const bool states_cameras = !texts.size.empty() || !texts.right_rotation.empty() || texts.focal != 0 ||
                              scene.baseline != defaults.baseline || scene.lens != defaults.lens;
  if (scene.rig != defaults.rig && states_cameras)
    throw UsageError("--rig " + scene.rig + " excludes --size, --focal, --baseline, --lens and --right-rotation");
  set_size(scene, texts.size);
  if (texts.focal != 0) scene.focal = texts.focal;
  if (texts.right_rotation.empty()) return;
  double x = 0, y = 0, z = 0;
  int length = 0;
  if (std::sscanf(texts.right_rotation.c_str(), "%lf,%lf,%lf%n", &x, &y, &z, &length) != 3 ||
      length != static_cast<int>(texts.right_rotation.size()) || !std::isfinite(x + y + z)) {
    throw UsageError("--right-rotation " + texts.right_rotation + ": expected X,Y,Z in degrees, for example 0,2,0");
  }
  scene.right_rotation = {x, y, z};
}

void declare_view(Options& options, SyntheticOptions& scene, std::string& size) {
  options.choice(
      "--path", scene.path, synthetic_paths(),
      "camera path in a built-in scene; drive: to the end of the scene (61 frames, facade and yard: 103); loop: "
      "returns to the first pose");
  options.text("--size", size, "image size of built-in scenes [px]; default 942x489", "WxH");
}

}  // namespace quadedge::cli
