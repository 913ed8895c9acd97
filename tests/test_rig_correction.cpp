#include "geometry/calibration.hpp"
#include "matching.hpp"
#include "rig/rig_correction.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// What twelve frames show of a right camera that is turned by `turn` [degrees] about its axes and whose fy is `focal`
/// times that of the calibration, in general on a rig that is not rectified.
rig::RigCorrection found_for(const Eigen::Vector3d& turn, double focal, double noise) {
  StereoRig calibrated = flat_rig(640, 480, 600, 0.1);
  calibrated.right_from_left.linear() = rotation_by({0.02, -0.03, 0.01});
  PinholeCamera right = calibrated.right;
  right.fy *= focal;
  const Eigen::Isometry3d right_from_left = rotation_by(-turn * kDegree) * calibrated.right_from_left;
  Random random(5);
  rig::RowModel rows(calibrated.right);
  for (int frame = 0; frame < 12; ++frame) {
    std::vector<rig::CornerMatch> matches(100);
    for (rig::CornerMatch& match : matches) {
      const Eigen::Vector3d point = random(2, 30) * calibrated.left.ray({random(20, 620), random(20, 460)});
      const auto in_right = [&](double depth) {
        return calibrated.right.project(calibrated.right_from_left * Eigen::Vector3d(depth * point));
      };
      const Eigen::Vector2d along = (in_right(1) - in_right(2)).normalized(), normal(along.y(), -along.x());
      match.right = right.project(right_from_left * point);
      match.across = normal.dot(match.right - in_right(1)) + random(-noise, noise);
    }
    rows.add(matches);
  }
  return rig::correction_of(calibrated, rows);
}

}  // namespace

TEST_CASE("rig correction: pitch, roll and focal length follow from the rows", "[rig]") {
  const rig::RigCorrection found = found_for({0.1, 0, -0.15}, 1.002, 0.2);
  CHECK(found.parts[rig::RigCorrection::pitch] == Approx(0.1 * kDegree).epsilon(0.1));
  CHECK(found.parts[rig::RigCorrection::roll] == Approx(-0.15 * kDegree).epsilon(0.1));
  CHECK(found.parts[rig::RigCorrection::focal] == Approx(0.002).epsilon(0.1));
  StereoCalibration calibration = pinhole_calibration(flat_rig(640, 480, 600, 0.1));
  calibration = found.applied(calibration);
  CHECK(calibration.right.camera.fy == Approx(601.2).margin(0.12));
  CHECK((rounded_rotation(calibration.right_from_left) / kDegree - Eigen::Vector3d(-0.1, 0, 0.15)).norm() < 0.015);
}

TEST_CASE("rig correction: a sound rig, and what is uncertain, is left as it is", "[rig]") {
  for (int part = 0; part < rig::RigCorrection::kParts; ++part) {
    CHECK_FALSE(found_for({0, 0, 0}, 1, 0.2).is_certain(part));
    CHECK_FALSE(found_for({0.015, 0, 0.02}, 1.0003, 0.2).is_certain(part));  // 0.16 px and less
  }
  const rig::RigCorrection one = found_for({0, 0, 0.15}, 1, 0.2);
  CHECK(one.is_certain(rig::RigCorrection::roll));
  const StereoCalibration calibration = pinhole_calibration(flat_rig(640, 480, 600, 0.1));
  CHECK(one.applied(calibration).right.camera.fy == calibration.right.camera.fy);
}
