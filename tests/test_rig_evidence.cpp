#include <catch2/catch.hpp>

#include "frontends.hpp"
#include "odometry/rig_evidence.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using matching::RenderedScene;
using odometry::RigFindings;

namespace {

/// Two frames of the room, rendered once.
const RenderedScene& evidence_room() {
  static const RenderedScene scene("room", 320, 200, 2, 6);
  return scene;
}

RigFindings examine(const StereoRig& rig, const Image& left, const Image& right, RigEvidence& evidence) {
  return odometry::examine_frame(rig, {0, left.view(), right.view()}, evidence_room().config.stereo.max_disparity,
                                 evidence);
}

std::string mismatch(const StereoRig& rig, const Image& left, const Image& right) {
  RigEvidence evidence;
  return examine(rig, left, right, evidence).mismatch;
}

StereoRig turned_rig(double degrees, const Eigen::Vector3d& axis) {
  StereoRig rig = evidence_room().rig;
  rig.right_from_left.linear() = Eigen::AngleAxisd(degrees * kDegree, axis).toRotationMatrix();
  return rig;
}

/// Pixel (x, y) of the result is that of `image` at from(x, y).
template <class From>
Image rearranged(const Image& image, const From& from) {
  Image result(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto [u, v] = from(x, y);
      result.set(x, y, image.view().value(u, v));
    }
  }
  return result;
}

}  // namespace

TEST_CASE("rig evidence: nothing contradicts the right calibration", "[odometry][rig]") {
  for (const char* name : {"room", "cables", "facade"}) {
    const RenderedScene scene(name, 320, 200, 1);
    RigEvidence evidence;
    const RigFindings findings =
        odometry::examine_frame(scene.rig, scene.frame(0), scene.config.stereo.max_disparity, evidence);
    INFO(name << ", " << findings.mismatch);
    CHECK(findings.mismatch.empty());
    CHECK(findings.warnings.empty());
    CHECK(evidence.found_ratio > 0.5);
    if (name != std::string("cables")) {  // along a cable a match may lie anywhere
      CHECK(evidence.on_line_ratio > 0.9);
      CHECK(evidence.searched_residual < 0.1);
    }
    CHECK(evidence.negative_ratio < 0.1);
  }
}

TEST_CASE("rig evidence: a mismatch is reported with its likely cause", "[odometry][rig]") {
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0];
  CHECK_THAT(mismatch(evidence_room().rig, right, left), Contains("disparities are negative") && Contains("exchanged"));
  StereoRig rig = evidence_room().rig;
  rig.right_from_left.translation() *= -1;
  CHECK_THAT(mismatch(rig, left, right), Contains("sign of the baseline"));
  CHECK_THAT(mismatch(turned_rig(3, Eigen::Vector3d::UnitX()), left, right), Contains("pitched"));
  CHECK_THAT(mismatch(turned_rig(4, Eigen::Vector3d::UnitZ()), left, right), Contains("rolled"));
  rig = evidence_room().rig;
  rig.left.fx *= 1.2;
  rig.left.fy *= 1.2;
  CHECK_THAT(mismatch(rig, left, right), Contains("focal length in the calibration"));
  Image negative = right;
  for (auto& value : negative.pixels) value = static_cast<std::uint8_t>(255 - value);
  CHECK_THAT(mismatch(evidence_room().rig, left, negative), Contains("as their negative"));
  const int last_column = right.width - 1, last_row = right.height - 1;
  const Image mirrored = rearranged(right, [&](int x, int y) { return std::pair(last_column - x, y); });
  CHECK_THAT(mismatch(evidence_room().rig, left, mirrored), Contains("is the right image mirrored?"));
  const Image upside_down = rearranged(right, [&](int x, int y) { return std::pair(last_column - x, last_row - y); });
  CHECK_THAT(mismatch(evidence_room().rig, left, upside_down), Contains("is the right image rotated by 180 degrees?"));
}

TEST_CASE("rig evidence: small errors are warnings and stop nothing", "[odometry][rig]") {
  RigEvidence evidence;
  const RigFindings pitched =
      examine(turned_rig(0.5, Eigen::Vector3d::UnitX()), evidence_room().left[0], evidence_room().right[0], evidence);
  CHECK(pitched.mismatch.empty());
  REQUIRE(pitched.warnings.size() == 1);
  CHECK(pitched.warnings[0].kind == WarningKind::doubtful_calibration);
  CHECK_THAT(pitched.warnings[0].text, Contains("doubtful") && Contains("pitched"));
  CHECK(evidence.searched_residual == Approx(evidence_room().rig.left.fy * 0.5 * kDegree).epsilon(0.15));
  const RigFindings narrow = odometry::examine_frame(evidence_room().rig, evidence_room().frame(0), 4, evidence);
  CHECK(narrow.mismatch.empty());
  REQUIRE(narrow.warnings.size() == 1);
  CHECK(narrow.warnings[0].kind == WarningKind::small_disparity_range);
  CHECK_THAT(narrow.warnings[0].text, Contains("stereo.max_disparity too small"));
}

TEST_CASE("rig evidence: a frozen camera is detected while the other one moves", "[odometry][rig]") {
  odometry::RigWatch watch(evidence_room().rig, evidence_room().config);
  RigEvidence evidence;
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0], &next = evidence_room().left[1];
  CHECK(watch.judge({0, left.view(), right.view()}, {}, 0, evidence).mismatch.empty());
  CHECK(watch.judge({1, left.view(), right.view()}, {}, 0, evidence).mismatch.empty());  // the same pair again
  CHECK_THAT(watch.judge({2, next.view(), right.view()}, {}, 0, evidence).mismatch,
             Contains("has the right camera frozen?"));
  CHECK(watch.judge({3, left.view(), evidence_room().right[1].view()}, {}, 0, evidence).mismatch.empty());
}

TEST_CASE("rig evidence: implausible numbers are reported", "[odometry][rig]") {
  CHECK(odometry::implausible_numbers(evidence_room().rig).empty());
  const auto first_of = [](const StereoRig& rig) {
    const auto found = odometry::implausible_numbers(rig);
    return found.empty() ? std::string() : found.front().text;
  };
  StereoRig rig = evidence_room().rig;
  rig.right_from_left.translation() *= 1000;
  CHECK_THAT(first_of(rig), Contains("millimetres"));
  rig = evidence_room().rig;
  rig.left.fx = rig.left.fy = 0.004;
  CHECK_THAT(first_of(rig), Contains("is it given in pixels?"));
  rig = evidence_room().rig;
  rig.right.cx = -3;
  CHECK_THAT(first_of(rig), Contains("right camera's principal point") && Contains("outside"));
  rig = evidence_room().rig;
  rig.left.fy /= 2;
  CHECK_THAT(first_of(rig), Contains("not square"));
}

TEST_CASE("rig evidence: aligned patches measure a pitch error of 0.3 degrees", "[odometry][rig][device]") {
  const StereoRig rig = turned_rig(0.3, Eigen::Vector3d::UnitX());
  Device device(all_devices().front(), kept_programs());
  const auto frontend = frontend::make_frontend(rig, device, evidence_room().config);
  const auto seen = frontend->process(evidence_room().frame(0));
  std::vector<odometry::CornerMatch> matches;
  odometry::EpipolarProbe(rig, evidence_room().config.stereo.max_disparity)
      .align(evidence_room().frame(0), seen->edges, matches);
  const odometry::EpipolarFit fit = odometry::fit_across(matches, rig.left.width, rig.left.height);
  REQUIRE(fit.samples > 30);
  CHECK(fit.offset == Approx(rig.left.fy * 0.3 * kDegree).epsilon(0.2));
}
