#include "common/images.hpp"
#include "device/edge_detection.hpp"
#include "edge_images.hpp"
#include "edges/common_view.hpp"
#include "frontends.hpp"
#include "reference/edge_detection.hpp"

using namespace quadedge;
using frontend::within_common_view;

namespace {

/// A disc, a corner and a single pixel.
PixelMask odd_mask(int width, int height) {
  PixelMask mask{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      mask.hidden.push_back(
          std::hypot(x - 20, y - 15) < 6 || (x > width - 4 && y > height - 7) || (x == 43 && y == 30) ? 1 : 0);
  return mask;
}

}  // namespace

TEST_CASE("edge mask: the border has the requested width along rows, columns and diagonals") {
  const PixelMask mask = odd_mask(61, 47);
  for (const int margin : {0, 1, 4, 70}) {
    const PixelMask wide = with_border(mask, margin);
    for (int y = 0; y < 47; ++y) {
      for (int x = 0; x < 61; ++x) {
        bool near = false;
        for (int row = std::max(y - margin, 0); row <= std::min(y + margin, 46); ++row)
          for (int column = std::max(x - margin, 0); column <= std::min(x + margin, 60); ++column)
            near = near || mask.hidden[static_cast<std::size_t>(row * 61 + column)] != 0;
        REQUIRE(wide.hidden[static_cast<std::size_t>(y * 61 + x)] == (near ? 1 : 0));
      }
    }
  }
}

TEST_CASE("edge mask: every device and variant keeps the same edges as the reference", "[device][oclgrind]") {
  const int width = 61, height = 47;
  Config config;
  config.edges.margin = 3;
  config.edges.threshold = 2;
  const Image image = textured_image(width, height, 5);
  const PixelMask mask = odd_mask(width, height), wide = with_border(mask, 3);
  Device reference("reference");
  const EdgeSet all = detect_edges(image.view(), reference, config);
  const EdgeSet expected = detect_edges(image.view(), reference, config, mask);
  REQUIRE(expected.size() > all.size() / 2);
  REQUIRE(expected.size() + 10 < all.size());
  // Edges lie within half a pixel of their pixel along both axes, and the Newton step moves them by less than another
  // half.
  for (std::size_t i = 0; i < expected.size(); ++i) {
    bool clear = false;
    for (int y = static_cast<int>(expected.y[i]) - 1; y <= static_cast<int>(expected.y[i]) + 2; ++y)
      for (int x = static_cast<int>(expected.x[i]) - 1; x <= static_cast<int>(expected.x[i]) + 2; ++x)
        clear = clear || wide.hidden[static_cast<std::size_t>(y * width + x)] == 0;
    CHECK(clear);
  }
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    for (const auto& variant : opencl::all_variants()) {
      if (variant.stage != "edge_detection") continue;
      INFO(device.info().name << ", " << variant.name);
      config.variants = {{"edge_detection", variant.name}};
      const EdgeSet edges = detect_edges(image.view(), device, config, mask);
      REQUIRE(edges.size() == expected.size());
      for (std::size_t i = 0; i < edges.size(); ++i) {
        CHECK(edges.x[i] == Approx(expected.x[i]).margin(1e-3));
        CHECK(edges.y[i] == Approx(expected.y[i]).margin(1e-3));
      }
      CHECK(detect_edges(image.view(), device, config).size() == all.size());
    }
  }
}

namespace {

/// A rectified rig of 100 x 60 px.
StereoRig hundred_pixel_rig() {
  StereoRig rig;
  rig.left = rig.right = {100, 100, 49.5, 29.5, 100, 60};
  rig.right_from_left.translation().x() = -0.1;
  return rig;
}

/// Whether exactly the pixels with wanted(x, y) are hidden.
template <class Wanted>
bool hides(const PixelMask& mask, const Wanted& wanted) {
  REQUIRE(mask.hidden.size() == static_cast<std::size_t>(mask.width * mask.height));
  for (int y = 0; y < mask.height; ++y)
    for (int x = 0; x < mask.width; ++x)
      if ((mask.hidden[static_cast<std::size_t>(y * mask.width + x)] != 0) != wanted(x, y)) return false;
  return true;
}

}  // namespace

TEST_CASE("common view: equal rectified cameras hide nothing, and keep their masks") {
  StereoRig rig = hundred_pixel_rig();
  CHECK(within_common_view(rig).left_mask.empty());
  CHECK(within_common_view(rig).right_mask.empty());
  rig.left_mask = {100, 60, std::vector<std::uint8_t>(6000)};
  rig.left_mask.hidden[1234] = 1;
  CHECK(within_common_view(rig).left_mask.hidden == rig.left_mask.hidden);
}

TEST_CASE("common view: rows and columns beyond the other image are hidden in both") {
  StereoRig rig = hundred_pixel_rig();
  rig.right.cy -= 20;  // left row y is right row y - 20
  rig.left_mask = {100, 60, std::vector<std::uint8_t>(6000)};
  rig.left_mask.hidden[5999] = 1;
  StereoRig seen = within_common_view(rig);
  CHECK(hides(seen.left_mask, [](int x, int y) { return y < 20 || (x == 99 && y == 59); }));
  CHECK(hides(seen.right_mask, [](int, int y) { return y >= 40; }));
  // At infinity, left column x is right column x - 10; nearer points lie farther left in the right image.
  rig = hundred_pixel_rig();
  rig.right.cx -= 10;
  seen = within_common_view(rig);
  CHECK(hides(seen.left_mask, [](int x, int) { return x < 10; }));
  CHECK(hides(seen.right_mask, [](int x, int) { return x >= 90; }));
  // The other way round, nearer points of all columns lie in the other image.
  rig.right.cx += 20;
  CHECK(within_common_view(rig).left_mask.empty());
  CHECK(within_common_view(rig).right_mask.empty());
}

TEST_CASE("common view: a camera that looks back sees nothing of the other's") {
  StereoRig rig = hundred_pixel_rig();
  rig.right_from_left.linear() = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitY()).toRotationMatrix();
  CHECK(hides(within_common_view(rig).left_mask, [](int, int) { return true; }));
}

TEST_CASE("common view: the front ends detect no edge outside it", "[device]") {
  const matching::RenderedScene room("room", 320, 200, 1);
  StereoRig rig = room.rig;
  rig.right.cy -= 50;
  for (const std::string& name : all_devices()) {
    Device device(name, kept_programs());
    const auto frontend = frontend::make_frontend(rig, device, room.config);
    frontend->process(room.frame(0));
    const EdgeSet left = frontend->edges(Side::left), right = frontend->edges(Side::right);
    REQUIRE(left.size() > 100);
    CHECK(*std::min_element(left.y.begin(), left.y.end()) > 59);
    CHECK(*std::max_element(right.y.begin(), right.y.end()) < 140);
  }
}
