/// \file synthetic.cpp  Checks the options, builds rig, scene and path; exposes a view, then tone, noise, rounding.
#include "quadedge/synthetic.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/printed.hpp"
#include "geometry/calibration.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"
#include "scenes/hash.hpp"
#include "scenes/lenses.hpp"
#include "scenes/path.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"

namespace quadedge {
namespace {

constexpr std::int64_t kFramePeriod = 50'000'000;  // [ns]

void require(bool allowed, const char* name, double value, const char* range) {
  if (allowed) return;
  throw UsageError(printed("synthetic sequence: %s = %g, allowed: %s", name, value, range));
}

void require_known(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  throw UsageError("synthetic sequence: unknown " + what + " '" + name + "', allowed: " + joined(known));
}

void check(const SyntheticOptions& options) {
  if (synthetic::scene_makers().count(options.scene) == 0) require_known("scene", options.scene, synthetic_scenes());
  require_known("path", options.path, synthetic_paths());
  require(options.frames >= 1, "frames", options.frames, "at least 1");
  require(options.width >= 8 && options.width <= 8192, "width", options.width, "8 to 8192 px");
  require(options.height >= 8 && options.height <= 8192, "height", options.height, "8 to 8192 px");
  require(options.focal >= 4.0 && options.focal <= 1e5, "focal", options.focal, "4 to 100000 px");
  require(options.baseline >= 1e-3 && options.baseline <= 0.5, "baseline", options.baseline, "0.001 to 0.5 m");
  require_known("lens", options.lens, synthetic_lenses());
  require(options.right_rotation.norm() <= 20.0, "right_rotation", options.right_rotation.norm(), "up to 20 degrees");
  require(options.noise >= 0.0 && options.noise <= 100.0, "noise", options.noise, "0 to 100 grey levels");
  require(options.gain >= 0.1 && options.gain <= 10.0, "gain", options.gain, "0.1 to 10");
  require(options.right_gain >= 0.1 && options.right_gain <= 10.0, "right_gain", options.right_gain, "0.1 to 10");
  require(options.light >= 0.01 && options.light <= 10.0, "light", options.light, "0.01 to 10");
  require(options.gamma >= 0.1 && options.gamma <= 10.0, "gamma", options.gamma, "0.1 to 10");
  require(options.bits == 8 || options.bits == 12 || options.bits == 16, "bits", options.bits, "8, 12, 16");
  require(options.contrast > 0.0 && options.contrast <= 1.0, "contrast", options.contrast, "above 0, at most 1");
  require(options.blur >= 0.0 && options.blur <= 50.0, "blur", options.blur, "0 to 50 px");
  require(options.mover >= 0.0 && options.mover <= 0.6, "mover", options.mover, "0 to 0.6");
  require(options.supersampling >= 1 && options.supersampling <= 64, "supersampling", options.supersampling, "1 to 64");
  require(options.threads >= 0 && options.threads <= 1024, "threads", options.threads, "0 (one per processor) to 1024");
}

/// Camera response to an exposure: saturation, gamma, contrast. Grey levels, 0 to 255.
double tone(double grey, const SyntheticOptions& options) {
  constexpr double kMax = kMaxValue8, kMiddle = 128.0;
  grey = std::clamp(grey, 0.0, kMax);
  if (options.gamma != 1.0) grey = kMax * std::pow(grey / kMax, 1.0 / options.gamma);
  if (options.contrast != 1.0) grey = kMiddle + options.contrast * (grey - kMiddle);
  return grey;
}

/// The options with the numbers that the rig states.
SyntheticOptions with_rig(SyntheticOptions options) {
  require_known("rig", options.rig, synthetic_rigs());
  if (options.rig == "rectified") return options;
  const StereoCalibration rig = synthetic::eth3d_slam_rig();
  const PinholeCamera& left = rig.left.camera;
  options.width = left.width;
  options.height = left.height;
  options.focal = left.fx;
  options.baseline = rig.right_from_left.translation().norm();
  options.lens = "pinhole";
  options.right_rotation.setZero();
  return options;
}

StereoCalibration calibrate(const SyntheticOptions& options) {
  StereoCalibration calibration;
  if (options.rig != "rectified") {
    calibration = synthetic::eth3d_slam_rig();
    calibration.files = "the rendered rig";
    return calibration;
  }
  calibration.left = synthetic::make_lens(options.lens, options.focal);
  // As in a real camera, the optical axis misses the middle of the image slightly.
  PinholeCamera& camera = calibration.left.camera;
  camera.cx = 0.5 * (options.width - 1) + 0.011 * options.width;
  camera.cy = 0.5 * (options.height - 1) - 0.013 * options.height;
  camera.width = options.width;
  camera.height = options.height;
  calibration.right = calibration.left;
  calibration.right_from_left.translation().x() = -options.baseline;
  if (const double degrees = options.right_rotation.norm(); degrees > 0.0) {
    const Eigen::AngleAxisd turn(-degrees * kDegree, options.right_rotation / degrees);
    calibration.right_from_left = rounded_transform(turn * calibration.right_from_left);
  }
  calibration.files = "the rendered rig";
  return calibration;
}

StereoRig rig_of(const StereoCalibration& calibration, int bits) {
  StereoRig rig = make_rig(calibration);
  rig.max_value = (1 << bits) - 1;
  return rig;
}

/// Exposure time for the requested blur [frame periods].
double exposure_of(const SyntheticOptions& options, const synthetic::CameraPath& path, const PinholeCamera& camera) {
  if (options.blur == 0.0) return 0.0;
  const double motion = path.mean_image_motion(camera);
  if (options.blur > motion) {
    throw UsageError(printed(
        "synthetic sequence: blur = %g, allowed: 0 to %g px, the image motion per frame on path %s in %d x %d px, "
        "because the exposure time cannot exceed a frame period",
        options.blur, std::floor(100.0 * motion) / 100.0, options.path.c_str(), options.width, options.height));
  }
  return options.blur / motion;
}

}  // namespace

const std::vector<std::string>& synthetic_scenes() {
  static const std::vector<std::string> scenes = {"room", "cables", "facade", "yard"};
  return scenes;
}

const std::vector<std::string>& synthetic_paths() {
  static const std::vector<std::string> paths = {"ellipse", "handheld", "drive", "loop"};
  return paths;
}

class SyntheticSequence::Implementation {
 public:
  explicit Implementation(const SyntheticOptions& asked)
      : options(with_rig(asked)),
        calibration(calibrate(options)),
        rig(rig_of(calibration, asked.bits)),
        left_rays(calibration.left),
        right_rays(calibration.right),
        scene(synthetic::make_scene(asked.scene, asked.seed, options.focal)),
        path(asked.path, asked.seed, asked.frames, scene.lane),
        exposure(exposure_of(options, path, rig.left)) {
    rig.max_disparity = std::ceil(rig.left.fx * options.baseline / scene.nearest);
    if (options.mover > 0.0) board.emplace(rig.left, options.mover, options.seed);
  }

  SyntheticOptions options;
  StereoCalibration calibration;
  StereoRig rig;
  synthetic::PixelRays left_rays, right_rays;
  synthetic::Scene scene;
  synthetic::CameraPath path;
  double exposure;  // [frame periods]
  std::optional<synthetic::MovingBoard> board;
};

SyntheticSequence::SyntheticSequence(const SyntheticOptions& options) {
  check(options);
  implementation_ = std::make_unique<Implementation>(options);
  if (const int longest = implementation_->path.longest(); options.frames > longest) {
    const std::string range = printed("1 to %d on path %s in the scene %s, whose lane is %g m long", longest,
                                      options.path.c_str(), options.scene.c_str(), implementation_->scene.lane.length);
    require(false, "frames", options.frames, range.c_str());
  }
}

SyntheticSequence::~SyntheticSequence() = default;

std::string SyntheticSequence::name() const {
  const SyntheticOptions& options = implementation_->options;
  return options.path == "ellipse" ? options.scene : options.scene + "-" + options.path;
}

const StereoRig& SyntheticSequence::rig() const { return implementation_->rig; }

const StereoCalibration& SyntheticSequence::calibration() const { return implementation_->calibration; }

const SyntheticOptions& SyntheticSequence::options() const { return implementation_->options; }

int SyntheticSequence::frames() const { return implementation_->options.frames; }

std::int64_t SyntheticSequence::stamp_ns(int frame) const { return frame * kFramePeriod; }

Eigen::Isometry3d SyntheticSequence::world_from_left(int frame) const {
  return implementation_->path.world_from_left(frame);
}

StereoPair SyntheticSequence::pair(int frame) const {
  return {frame, stamp_ns(frame), render(frame, Side::left).image, render(frame, Side::right).image};
}

RenderedView SyntheticSequence::render(int frame, Side side) const {
  const SyntheticOptions& options = implementation_->options;
  require(frame >= 0 && frame < options.frames, "frame", frame, "0 to frames - 1");
  const synthetic::MovingBoard* board = implementation_->board ? &*implementation_->board : nullptr;
  const synthetic::PixelRays& rays = side == Side::right ? implementation_->right_rays : implementation_->left_rays;
  synthetic::Radiance radiance = synthetic::expose({implementation_->scene, board, rig(), rays, implementation_->path,
                                                    implementation_->exposure, options.supersampling, options.threads},
                                                   frame, side);
  const double gain =
      options.light * (frame % 2 == 1 ? options.gain : 1.0) * (side == Side::right ? options.right_gain : 1.0);

  RenderedView view;
  view.image = Image(rays.width(), rays.height(), rig().max_value);
  view.depth = std::move(radiance.depth);
  const std::uint64_t key = synthetic::combine(synthetic::combine(options.seed, frame), index_of(side));
  for (std::size_t i = 0; i < radiance.grey.size(); ++i) {
    double grey = gain * radiance.grey[i];
    if (options.noise > 0.0)
      grey += options.noise * synthetic::normal(synthetic::combine(key, static_cast<std::int64_t>(i)));
    const double value = tone(grey, options) * view.image.max_value / kMaxValue8;
    view.image.set(static_cast<int>(i) % rays.width(), static_cast<int>(i) / rays.width(),
                   static_cast<int>(std::floor(value + 0.5)));
  }
  return view;
}

}  // namespace quadedge
