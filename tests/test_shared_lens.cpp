/// \file test_shared_lens.cpp  Lens errors that both cameras share, in made-up motions and in recordings.

#include "dataset_files.hpp"
#include "generated_quads.hpp"
#include "motion/motion.hpp"
#include "motion/shared_lens.hpp"
#include "rig/rig_finding.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

/// Where a camera whose radial distortion is uncorrected shows a pixel.
Eigen::Vector2d distorted(const PinholeCamera& camera, const Eigen::Vector2d& pixel, double k1) {
  const Eigen::Vector2d centre(camera.cx, camera.cy), from_centre = pixel - centre;
  return centre + from_centre * (1 + k1 * from_centre.squaredNorm() / (camera.fx * camera.fx));
}

/// The lenses as known after `motions` that turn by `turn` [rad] each, seen with the noise of edges by `truth`
/// and measured with `given`.
rig::SharedLens learned(const StereoRig& truth, const StereoRig& given, double turn, double k1 = 0, int motions = 36) {
  generated::Random random(8);
  rig::SharedLens lens;
  const generated::Noise noise{0.08, 0.3, 0.02};
  for (int step = 0; step < motions; ++step) {
    Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
    motion.linear() =
        Eigen::AngleAxisd(step % 2 == 0 ? turn : -turn, Eigen::Vector3d(0.2, 1, 0.1).normalized()).toRotationMatrix();
    motion.translation() << random.uniform(-0.1, 0.1), random.uniform(-0.05, 0.05), -0.4;
    pose::QuadObservations quads;
    while (quads.size() < 400) {
      const auto point = generated::random_point(truth, 3, 30, random);
      const pose::OrientedPoint moved{motion * point.point, motion.linear() * point.tangent};
      if (moved.point.z() < 1) continue;
      auto before = generated::disturb(truth, point, noise, true, random),
           after = generated::disturb(truth, moved, noise, false, random);
      for (auto* seen : {&before, &after}) {
        seen->left = distorted(truth.left, seen->left, k1);
        seen->right = distorted(truth.right, seen->right, k1);
      }
      generated::append(quads, given, before, after, 0.9F);
    }
    pose::MotionEstimate found;
    REQUIRE(pose::MotionEstimator().estimate(given, quads, PoseConfig(), 1, motion, 0, found) == pose::Refusal::none);
    lens.add(given, quads.scoring, found.inlier, found.current_from_previous);
  }
  return lens;
}

StereoRig with_focal(double factor) {
  StereoRig rig = generated::car_rig();
  for (PinholeCamera* camera : {&rig.left, &rig.right}) camera->fx *= factor, camera->fy *= factor;
  return rig;
}

/// What is said of both lenses in a recording; nothing if it cannot be read. \param factor of the focal lengths in the
/// calibration \param cut part of the images' width and height that is cut off on each side, for a calibration of whole
/// images
std::string said_of(const std::string& recording, double factor, double cut = 0) {
  const Dataset dataset = open_dataset(recording);
  StereoRig rig = dataset.rig;
  const int left = static_cast<int>(cut * rig.left.width), top = static_cast<int>(cut * rig.left.height);
  for (PinholeCamera* camera : {&rig.left, &rig.right}) {
    camera->fx *= factor;
    camera->fy *= factor;
    camera->width -= 2 * left;
    camera->height -= 2 * top;
  }
  const auto part = [&](ImageView view) {
    view.pixels += top * view.stride + left;
    view.width -= 2 * left;
    view.height -= 2 * top;
    return view;
  };
  Device device("auto", kept_programs());
  StereoOdometry odometry(rig, device);
  FramePrefetcher frames(dataset);
  while (const auto frame = frames.next()) {
    const StereoFrame whole = frame->view();
    for (const Warning& warning : odometry.track({whole.stamp_ns, part(whole.left), part(whole.right)}).warnings)
      if (warning.kind == WarningKind::doubtful_lenses) return warning.text;
  }
  return "";
}

}  // namespace

TEST_CASE("shared lens: focal lengths that both cameras have wrong are told by turns", "[rig]") {
  const StereoRig truth = with_focal(1);
  for (const double turn : {0.02, 0.06}) {
    const rig::SharedLens sound = learned(truth, truth, turn);
    CHECK(std::abs(sound.error().value[0]) < 0.01);
    CHECK_FALSE(sound.judge());
    for (const double factor : {0.8, 0.95, 1.05, 1.25}) {
      INFO("turns of " << turn << ", focal lengths x" << factor);
      const rig::SharedLens lens = learned(truth, with_focal(factor), turn);
      // Of a fit that is linear.
      CHECK(lens.error().value[0] == Approx(1 / factor - 1).margin(0.4 * std::abs(1 / factor - 1)));
      REQUIRE(lens.judge());
      const Warning told = lens.judge()->warning;
      CHECK(told.kind == WarningKind::doubtful_lenses);
      CHECK_THAT(told.text, Contains(factor > 1 ? "too long" : "too short") && Contains("Calibrate the rig"));
    }
  }
}

TEST_CASE("shared lens: distortion that both images share is told by turns", "[rig]") {
  const StereoRig truth = with_focal(1);
  const rig::SharedLens lens = learned(truth, truth, 0.06, 0.04);
  CHECK(lens.error().value[1] == Approx(-0.04).margin(0.015));
  REQUIRE(lens.judge());
  CHECK_THAT(lens.judge()->warning.text, Contains("distortion"));
}

TEST_CASE("shared lens: a straight drive tells nothing", "[rig]") {
  const rig::SharedLens lens = learned(with_focal(1), with_focal(1.25), 0);
  CHECK(lens.error().value[0] == 0);
  CHECK(lens.error().sigma[0] > 0.4);
  CHECK_FALSE(lens.judge());
}

TEST_CASE("shared lens: recordings with their own calibration, with other focal lengths, and cropped",
          "[rig][real][device]") {
  const std::string street = dataset_files::real_data("kitti_odometry/sequences/05"),
                    flight = dataset_files::real_data("euroc_mh_01_easy");
  if (street.empty() || flight.empty()) return;
  CHECK(said_of(street, 1).empty());
  CHECK(said_of(flight, 1).empty());
  CHECK_THAT(said_of(street, 1.05), Contains("too long"));
  CHECK_THAT(said_of(street, 1.25), Contains("too long"));
  CHECK_THAT(said_of(street, 0.8), Contains("too short"));
  CHECK_FALSE(said_of(street, 1, 0.1).empty());
}
