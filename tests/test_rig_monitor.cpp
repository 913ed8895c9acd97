#include "edge_images.hpp"
#include "frontends.hpp"
#include "rig/rig_constants.hpp"
#include "rig/rig_monitor.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;
using matching::RenderedScene;
using rig::RigMonitor;
using rig::RigReport;

namespace {

/// Two frames of the room, rendered once.
const RenderedScene& evidence_room() {
  static const RenderedScene scene("room", 320, 200, 2, 6);
  return scene;
}

RigReport examine(const StereoRig& rig, const Image& left, const Image& right) {
  return RigMonitor::examine(rig, {0, left.view(), right.view()}, evidence_room().config.stereo.max_disparity);
}

/// The frame is refused, with this cause.
void check_mismatch(const StereoRig& rig, const Image& left, const Image& right, const std::string& cause) {
  const RigReport report = examine(rig, left, right);
  REQUIRE(report.findings.size() == 1);
  REQUIRE(report.mismatch() != nullptr);
  CHECK_THAT(report.mismatch()->warning.text, Contains(cause));
}

StereoRig turned_rig(double degrees, const Eigen::Vector3d& axis) {
  StereoRig rig = evidence_room().rig;
  rig.right_from_left.linear() = Eigen::AngleAxisd(degrees * kDegree, axis).toRotationMatrix();
  return rig;
}

/// Pixel (x, y) of the result is that of `image` at from(x, y).
template <class From>
Image rearranged(const Image& image, const From& from) {
  return filled_image(image.width, image.height, [&](int x, int y) {
    const auto [u, v] = from(x, y);
    return image.view().value(u, v);
  });
}

}  // namespace

TEST_CASE("rig monitor: nothing contradicts the right calibration", "[rig]") {
  for (const char* name : {"room", "cables", "facade"}) {
    const RenderedScene scene(name, 320, 200, 1);
    const RigReport report = RigMonitor::examine(scene.rig, scene.frame(0), scene.config.stereo.max_disparity);
    const auto& findings = report.findings;
    const RigEvidence& evidence = report.evidence;
    INFO(name << ", " << (findings.empty() ? "" : findings.front().warning.text));
    CHECK(findings.empty());
    CHECK(evidence.found_ratio > 0.5);
    if (name != std::string("cables")) {  // along a cable a match may lie anywhere
      CHECK(evidence.on_line_ratio > 0.9);
      CHECK(evidence.searched_residual < 0.1);
    }
    CHECK(evidence.negative_ratio < 0.1);
  }
}

TEST_CASE("rig monitor: a mismatch is reported with its likely cause", "[rig]") {
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0];
  check_mismatch(evidence_room().rig, right, left, "exchanged");
  StereoRig rig = evidence_room().rig;
  rig.right_from_left.translation() *= -1;
  check_mismatch(rig, left, right, "sign of the baseline");
  check_mismatch(turned_rig(3, Eigen::Vector3d::UnitX()), left, right, "pitched");
  check_mismatch(turned_rig(4, Eigen::Vector3d::UnitZ()), left, right, "rolled");
  rig = evidence_room().rig;
  rig.left.fx *= 1.2;
  rig.left.fy *= 1.2;
  check_mismatch(rig, left, right, "focal length in the calibration");
  rig = evidence_room().rig;
  Image negative = right;
  for (auto& value : negative.pixels) value = static_cast<std::uint8_t>(255 - value);
  check_mismatch(rig, left, negative, "as their negative");
  const int last_column = right.width - 1, last_row = right.height - 1;
  const Image mirrored = rearranged(right, [&](int x, int y) { return std::pair(last_column - x, y); });
  check_mismatch(rig, left, mirrored, "is one image mirrored or rotated?");
  const Image upside_down = rearranged(right, [&](int x, int y) { return std::pair(last_column - x, last_row - y); });
  check_mismatch(rig, left, upside_down, "is one image mirrored or rotated?");
}

TEST_CASE("rig monitor: small errors are warnings and stop nothing", "[rig]") {
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0];
  const RigReport pitched = examine(turned_rig(0.5, Eigen::Vector3d::UnitX()), left, right);
  CHECK(pitched.mismatch() == nullptr);
  REQUIRE(pitched.findings.size() == 1);
  const Warning warning = pitched.findings[0].warning;
  CHECK(warning.kind == WarningKind::doubtful_calibration);
  CHECK_THAT(warning.text, Contains("doubtful") && Contains("pitched"));
  CHECK(pitched.evidence.searched_residual == Approx(evidence_room().rig.left.fy * 0.5 * kDegree).epsilon(0.15));
  const RigReport narrow = RigMonitor::examine(evidence_room().rig, evidence_room().frame(0), 4);
  CHECK(narrow.mismatch() == nullptr);
  REQUIRE(narrow.findings.size() == 1);
  CHECK(narrow.findings[0].warning.kind == WarningKind::small_disparity_range);
  CHECK_THAT(narrow.findings[0].warning.text, Contains("stereo.max_disparity too small"));
}

TEST_CASE("rig monitor: a frozen camera is detected while the other one moves", "[rig]") {
  RigMonitor monitor(evidence_room().rig);
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0], &next = evidence_room().left[1];
  CHECK(monitor.judge({0, left.view(), right.view()}, {}, 0, 100).findings.empty());
  const RigReport same = monitor.judge({1, left.view(), right.view()}, {}, 0, 100);
  CHECK(same.mismatch() == nullptr);
  REQUIRE(same.findings.size() == 1);
  CHECK(same.findings[0].warning.kind == WarningKind::repeated_images);
  CHECK_THAT(same.findings[0].warning.text, Contains("both cameras frozen"));
  const RigReport frozen = monitor.judge({2, next.view(), right.view()}, {}, 0, 100);
  REQUIRE(frozen.mismatch() != nullptr);
  CHECK_THAT(frozen.mismatch()->warning.text, Contains("has the right camera frozen?"));
  CHECK(monitor.judge({3, left.view(), evidence_room().right[1].view()}, {}, 0, 100).findings.empty());
}

TEST_CASE("rig monitor: a pair that repeats is not used if it does not match the calibration", "[rig]") {
  RigMonitor monitor(evidence_room().rig);
  const StereoFrame exchanged{0, evidence_room().right[0].view(), evidence_room().left[0].view()};
  for (int times = 0; times < 2; ++times) {
    const RigReport report = monitor.judge(exchanged, {}, 100, 100);
    REQUIRE(report.mismatch() != nullptr);
    CHECK_THAT(report.mismatch()->warning.text, Contains("exchanged"));
  }
}

TEST_CASE("rig monitor: a part of the disparities that is negative stops nothing; none is, after the offset learned",
          "[rig]") {
  // The right principal point is off so far that a part of the disparities are negative.
  StereoRig off = evidence_room().rig;
  const auto negative = [&] {
    return examine(off, evidence_room().left[0], evidence_room().right[0]).evidence.negative_ratio;
  };
  int pixels = 0;
  for (; pixels < 40 && !(negative() > 0.2); ++pixels) off.right.cx -= 1;
  INFO("off by " << pixels << " px");
  REQUIRE((negative() > 0.2 && negative() < rig::kMajority));
  CHECK(examine(off, evidence_room().left[0], evidence_room().right[0]).mismatch() == nullptr);
  RigEstimate learned;
  learned.disparity_offset = pixels;
  const RigReport report = RigMonitor(off).judge(evidence_room().frame(0), {}, 100, 1000, learned);
  CHECK(report.mismatch() == nullptr);
  CHECK(report.evidence.negative_ratio < 0.1);
}

TEST_CASE("rig monitor: a disparity offset beyond that of a rectification is reported", "[rig]") {
  CHECK_FALSE(rig::judge_disparity_offset(1.1));
  for (const double offset : {1.6, -1.6}) {
    const auto large = rig::judge_disparity_offset(offset);
    REQUIRE(large);
    CHECK(large->warning.kind == WarningKind::large_disparity_offset);
    CHECK_THAT(large->warning.text, Contains(offset > 0 ? "by 1.6 px" : "by -1.6 px") && Contains("yaw"));
  }
}

TEST_CASE("rig monitor: implausible numbers are reported", "[rig]") {
  CHECK(rig::implausible_numbers(evidence_room().rig).empty());
  const auto first_of = [](const StereoRig& rig) {
    const auto found = rig::implausible_numbers(rig);
    return found.empty() ? std::string() : found.front().warning.text;
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

TEST_CASE("rig monitor: crossings of cables off their lines are no error of the rig, and a pitched camera is one",
          "[rig][device]") {
  for (const char* rig_name : {"rectified", "eth3d-slam"}) {
    SyntheticOptions options;
    options.scene = "cables";
    options.rig = rig_name;
    if (options.rig == "rectified") {
      options.width = 742;
      options.height = 464;
      options.focal = 726.044;
      options.baseline = 0.0898;
    }
    const SyntheticSequence cables(options);
    const StereoPair pair = cables.pair(50);
    Device device(all_devices().front(), kept_programs());
    for (const double rows : {0, -5}) {
      INFO(rig_name << " " << rows);
      StereoRig rig = cables.rig();
      rig.right.cy += rows;
      CHECK(StereoOdometry(rig, device).track(pair.view()).status ==
            (rows == 0 ? FrameStatus::first : FrameStatus::lost_rig_mismatch));
    }
  }
}

TEST_CASE("rig monitor: texture that repeats along the lines does not blame an exact rig", "[rig]") {
  // Rows of equal panels: of a corner, equals lie a period of 40 px to both sides; the disparity is 50 px.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 1.5);
  const auto panels = [&](int shift) {
    return filled_image(320, 200, [&](int x, int y) {
      const int u = (x + shift) % 40, v = y % 33;
      const int grey = u < 6 || v < 5 ? 60 : 150 + 3 * ((u * 7 + v * 5 + (y / 33) * 11) % 13);
      return grey + static_cast<int>(std::lround(noise(random)));
    });
  };
  StereoRig rig = evidence_room().rig;
  const RigReport report = examine(rig, panels(0), panels(50));
  for (const auto& finding : report.findings) {
    INFO(finding.warning.text);
    CHECK_THAT(finding.warning.text, !Contains("exchanged") && !Contains("negative"));
  }
}

TEST_CASE("rig monitor: masks that hide most of an image are named, not the calibration", "[rig]") {
  RigMonitor monitor(turned_rig(0.5, Eigen::Vector3d::UnitX()));
  const Image &left = evidence_room().left[0], &right = evidence_room().right[0];
  HiddenPixels hidden;
  hidden.left = {left.width, left.height, std::vector<std::uint8_t>(left.pixels.size(), 0)};
  std::fill(hidden.left.hidden.begin() + static_cast<std::ptrdiff_t>(left.pixels.size() / 5), hidden.left.hidden.end(),
            std::uint8_t{1});
  const RigReport report = monitor.judge({0, left.view(), right.view()}, {}, 100, 100, {}, hidden);
  REQUIRE(report.findings.size() == 1);
  CHECK(report.findings[0].warning.kind == WarningKind::poor_images);
  CHECK_THAT(report.findings[0].warning.text, Contains("80 % of the left image") && Contains("exchanged"));
}
