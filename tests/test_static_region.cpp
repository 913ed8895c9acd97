#include "rig/rig_constants.hpp"
#include "rig/rig_finding.hpp"
#include "rig/static_region.hpp"
#include "testing.hpp"

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

/// How far the upper two thirds and the lower third of the image move per frame [px], and how near they are [1/m]. With
/// a board, the lower part is the middle of the image instead; with bars, three posts and a band. From frame
/// `lower_start` on, the lower part moves, and the upper one from frame `upper_start` on.
struct Scene {
  int upper_motion, lower_motion;
  double upper_inverse_depth, lower_inverse_depth;
  bool has_board = false;
  int lower_start = 1 << 20;
  bool has_bars = false;
  int upper_start = 0;

  bool is_lower(int x, int y) const {
    if (has_bars) return (x + 100) % 120 < 40 || (y >= 84 && y < 108);
    if (!has_board) return y >= kFirstStaticRow;
    return x >= 32 && x < kWidth - 32 && y >= 32 && y < kHeight - 32;
  }
  int moved(int frame, bool is_lower) const {
    return is_lower ? frame * lower_motion + 3 * std::max(0, frame - lower_start)
                    : std::max(0, frame - upper_start) * upper_motion;
  }
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
      for (int x = 0; x < kWidth; ++x) {
        const bool is_lower = scene.is_lower(x, y);
        const int level = texture(x, y, scene.moved(frame, is_lower));
        pixels[static_cast<std::size_t>(y * kWidth + x)] = static_cast<std::uint8_t>(level + noise(random));
        if (x % 32 != 16 || y % 32 != 16) continue;
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
  auto found = regions({3, 0, 0.1, 1}, 2 * kStaticWindow + 3);
  REQUIRE(found.size() == 4);
  for (const std::size_t certain : {0, 2}) {
    const PixelMask& mask = found[certain].mask;
    REQUIRE(mask.hidden.size() == static_cast<std::size_t>(kWidth * kHeight));
    for (int y = 0; y < kHeight; y += 5) {
      if (y < kFirstStaticRow && y >= kFirstStaticRow - kStaticStep) continue;
      for (int x = 0; x < kWidth; x += 5)
        CHECK(mask.hidden[static_cast<std::size_t>(y * kWidth + x)] == (y >= kFirstStaticRow));
    }
    CHECK_FALSE(found[certain].is_released);
  }
  CHECK(found[1].mask.empty());
  CHECK(found[3].mask.empty());
  for (const StaticRegion& region : found) {
    CHECK(region.ratio == Approx(1.0 / 3).margin(0.01));
    CHECK(region.bounds.min() == Eigen::Vector2d(0, kFirstStaticRow));
    CHECK(region.bounds.max() == Eigen::Vector2d(kWidth, kHeight));
  }
  StaticRegion region = found[0];
  region.mask = {};
  CHECK_THAT(region.text(), Contains("33 %") && Contains("rows 128 and 192") && Contains("Use a mask"));
  CHECK_THAT(found[0].text(), Contains("33 %") && Contains("is masked from here on"));
}

TEST_CASE("static region: a board that fills most of the image is certain, whatever its depth", "[rig]") {
  for (const double depth : {1.0, 0.1}) {
    const auto found = regions({5, 0, 0.2, depth, true}, kCertainAfter + 2);
    REQUIRE(found.size() == 1);
    CHECK(found[0].ratio == Approx(0.533).margin(0.05));
    CHECK_FALSE(found[0].mask.empty());
  }
  CHECK(regions({5, 0, 0.2, 0.05, true}, 2 * kStaticWindow).empty());  // distant scenery
  CHECK(regions({0, 5, 0.1, 0.2, true}, 2 * kStaticWindow).empty());   // what moves is in the middle only
}

TEST_CASE("static region: the mask of a cage is hardly larger than its bars, and rest before does not delay it",
          "[rig]") {
  Scene scene{5, 0, 0.1, 1};
  scene.has_bars = true;
  for (const int rest : {0, 10, 50}) {
    scene.upper_start = rest;
    const auto found = regions(scene, rest + kCertainAfter + 1);
    REQUIRE(found.size() == 1);
    REQUIRE(found[0].mask.hidden.size() == static_cast<std::size_t>(kWidth * kHeight));
    int bars = 0, masked = 0, missed = 0;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const bool is_hidden = found[0].mask.hidden[static_cast<std::size_t>(y * kWidth + x)] != 0;
        bars += scene.is_lower(x, y) ? 1 : 0;
        masked += is_hidden ? 1 : 0;
        missed += scene.is_lower(x, y) && !is_hidden ? 1 : 0;
      }
    CHECK(missed == 0);
    CHECK(masked <= 1.2 * bars);
  }
}

TEST_CASE("static region: a mask is released once what it covers moves", "[rig]") {
  const auto found = regions({5, 0, 0.2, 1, true, 21}, 2 * kStaticWindow);
  REQUIRE(found.size() >= 2);
  CHECK_FALSE(found.front().mask.empty());
  CHECK(found.back().is_released);
  CHECK(found.back().mask.empty());
}

TEST_CASE("static region: scenery, a camera at rest and moving images are none", "[rig]") {
  CHECK(regions({3, 0, 1, 0.1}, 2 * kStaticWindow).empty());  // the lower part is farther than what moves
  CHECK(regions({0, 0, 0.1, 1}, 2 * kStaticWindow).empty());
  CHECK(regions({3, 3, 0.1, 1}, 2 * kStaticWindow).empty());
}
