#include <catch2/catch.hpp>
#include <random>

#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"
#include "rig/rig_constants.hpp"
#include "rig/rig_finding.hpp"
#include "rig/static_region.hpp"

using namespace quadedge;
using namespace quadedge::rig;
using Catch::Matchers::Contains;

namespace {

constexpr int kWidth = 320, kHeight = 192, kFirstStaticRow = 128;

/// A texture of blocks of 8 px that has moved to the left.
std::uint8_t texture(int x, int y, int moved) {
  std::minstd_rand random(static_cast<unsigned>(1 + (x + moved) / 8 + 1000 * (y / 8)));
  random.discard(3);
  return static_cast<std::uint8_t>(40 + random() % 160);
}

/// How far the upper two thirds and the lower third of the image move per frame [px], and how near they are [1/m].
struct Scene {
  int upper_motion, lower_motion;
  double upper_inverse_depth, lower_inverse_depth;
};

/// The regions found in so many frames with camera noise.
std::vector<StaticRegion> regions(const Scene& scene, int frames) {
  PinholeCamera camera;
  camera.width = kWidth;
  camera.height = kHeight;
  const UndistortionTable pinhole;
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0, 2);
  StaticRegionDetector detector;
  std::vector<StaticRegion> found;
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(kWidth * kHeight));
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<CornerMatch> matches;
    for (int y = 0; y < kHeight; ++y) {
      const bool is_lower = y >= kFirstStaticRow;
      for (int x = 0; x < kWidth; ++x) {
        const int level = texture(x, y, frame * (is_lower ? scene.lower_motion : scene.upper_motion));
        pixels[static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(level + noise(random));
        if (x % 40 != 20 || y % 40 != 20) continue;
        CornerMatch match;
        match.left = {x, y};
        match.inverse_depth = is_lower ? scene.lower_inverse_depth : scene.upper_inverse_depth;
        matches.push_back(match);
      }
    }
    const ImageView image{pixels.data(), kWidth, kHeight, kWidth};
    if (const auto region = detector.observe({image, pinhole, camera}, matches)) found.push_back(*region);
  }
  return found;
}

}  // namespace

TEST_CASE("static region: a bonnet below a moving scene is found in every window of frames", "[rig]") {
  const auto found = regions({3, 0, 0.1, 1}, 2 * kStaticWindow + 3);
  REQUIRE(found.size() == 2);
  for (const StaticRegion& region : found) {
    CHECK(region.ratio == Approx(1.0 / 3).margin(0.01));
    CHECK(region.bounds.min() == Eigen::Vector2d(0, kFirstStaticRow));
    CHECK(region.bounds.max() == Eigen::Vector2d(kWidth, kHeight));
  }
  RigFinding finding{RigFindingKind::static_region};
  finding.region = found[0];
  const Warning told = warning(finding);
  CHECK(told.kind == WarningKind::static_region);
  CHECK_THAT(told.text, Contains("33 %") && Contains("rows 128 and 192") && Contains("mask"));
}

TEST_CASE("static region: scenery, a camera at rest and moving images are none", "[rig]") {
  CHECK(regions({3, 0, 1, 0.1}, 2 * kStaticWindow).empty());  // the lower part is farther than what moves
  CHECK(regions({0, 0, 0.1, 1}, 2 * kStaticWindow).empty());
  CHECK(regions({3, 3, 0.1, 1}, 2 * kStaticWindow).empty());
}
