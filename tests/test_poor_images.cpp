#include "edge_images.hpp"
#include "frontends.hpp"
#include "rig/rig_monitor.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using matching::RenderedScene;
using rig::RigReport;

namespace {

const RenderedScene& bright_room() {
  static const RenderedScene scene("room", 320, 200, 1);
  return scene;
}

/// Clips at the largest value, as a sensor does.
Image brighter(const Image& image, double factor) {
  return filled_image(image.width, image.height, [&](int x, int y) {
    return std::min(255, static_cast<int>(std::lround(factor * image.view().value(x, y))));
  });
}

RigReport examine(const StereoRig& rig, const Image& left, const Image& right) {
  return rig::RigMonitor::examine(rig, {0, left.view(), right.view()}, bright_room().config.stereo.max_disparity);
}

StereoRig pitched() {
  StereoRig rig = bright_room().rig;
  rig.right_from_left.linear() = Eigen::AngleAxisd(0.5 * kDegree, Eigen::Vector3d::UnitX()).toRotationMatrix();
  return rig;
}

}  // namespace

TEST_CASE("poor images: clipped images do not make a right calibration doubtful") {
  const Image &left = bright_room().left[0], &right = bright_room().right[0];
  for (const double factor : {1.4, 2.0, 3.0}) {
    INFO(factor);
    CHECK(examine(bright_room().rig, brighter(left, factor), brighter(right, factor)).findings.empty());
    for (const auto& finding : examine(bright_room().rig, left, brighter(right, factor)).findings) {
      INFO(finding.warning.text);
      CHECK(finding.warning.kind == WarningKind::poor_images);
    }
  }
}

TEST_CASE("poor images: where corners leave their lines, the images are named before the calibration") {
  const auto said = [](const Image& left, const Image& right) {
    const RigReport report = examine(pitched(), left, right);
    REQUIRE(report.findings.size() == 1);
    CHECK(report.mismatch() == nullptr);
    return report.findings.front().warning;
  };
  const Image &left = bright_room().left[0], &right = bright_room().right[0];
  CHECK(said(left, right).kind == WarningKind::doubtful_calibration);
  const Warning uneven = said(brighter(left, 0.4), right);
  CHECK(uneven.kind == WarningKind::poor_images);
  CHECK_THAT(uneven.text, Contains("2.5 times as bright") && Contains("exposure and gain"));
}
