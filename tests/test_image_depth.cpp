/// \file test_image_depth.cpp  Images of 12 and 16 bits, from single stages to the trajectory.
#include "edge_images.hpp"
#include "frontends.hpp"

using namespace quadedge;
using matching::FrontendOutput;
using matching::RenderedScene;
using matching::run_frontend;

namespace {

/// The same grey levels at 16 bits.
Image deepened(const Image& image) {
  return filled_image(image.width, image.height, 65535, [&](int x, int y) { return 257 * image.view().value(x, y); });
}

}  // namespace

TEST_CASE("image depth: pixels hold raw values, grey levels do not depend on the bit depth") {
  Image image(3, 2, 4095);
  image.set(2, 1, 4095);
  image.set(0, 1, 819);
  CHECK(image.view().value(2, 1) == 4095);
  CHECK(image.view().at(2, 1) == Approx(255));
  CHECK(image.view().at(0, 1) == Approx(51));
  CHECK(to_8_bits(image.view()).pixels == std::vector<std::uint8_t>{0, 0, 0, 51, 0, 255});
  const std::vector<std::uint16_t> words = {1, 2, 0, 3, 4, 0};
  const ImageView view = ImageView::of_words(words.data(), 2, 2, 3, 65535);
  CHECK(view.value(1, 1) == 4);
  CHECK(view.value(0, 1) == 3);
}

TEST_CASE("image depth: the same grey levels at 16 bits have the same edges", "[device]") {
  const Image image = textured_image(161, 123), deep = deepened(image);
  for (const auto& name : all_devices_and_reference()) {
    Device device(name, kept_programs());
    const EdgeSet expected = detect_edges(image.view(), device, {}), found = detect_edges(deep.view(), device, {});
    REQUIRE(expected.size() > 500);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      REQUIRE(found.x[i] == Approx(expected.x[i]).margin(1e-3));
      REQUIRE(found.y[i] == Approx(expected.y[i]).margin(1e-3));
      REQUIRE(found.strength[i] == Approx(expected.strength[i]).epsilon(1e-4));
    }
  }
}

TEST_CASE("image depth: devices find the reference's stereo edges at 12 and 16 bits, every variant the same bytes",
          "[device]") {
  const std::set<std::string> readers = {"edge_threshold", "edge_detection", "patches", "sift", "stereo_refinement"};
  for (const int bits : {12, 16}) {
    RenderedScene scene("cables", 161, 97, 2, 1, bits, bits == 16 ? 0.02 : 0.5);
    scene.config.stereo.sift_max = 500;
    const FrontendOutput truth = run_frontend(scene, "reference");
    REQUIRE(truth.current.size() > 100);
    for (const auto& device : all_devices()) {
      const FrontendOutput expected = run_frontend(scene, device);
      CHECK(matching::agreement(expected.previous, truth.previous) > 0.99);
      CHECK(matching::agreement(expected.current, truth.current) > 0.99);
      for (const auto& variant : opencl::all_variants()) {
        if (bits != 16 || readers.count(variant.stage) == 0) continue;
        INFO(bits << " " << variant.stage << " " << variant.name);
        CHECK(
            frontend::first_difference(run_frontend(scene, device, {{variant.stage, variant.name}}), expected).empty());
      }
    }
  }
}

TEST_CASE("image depth: a hundredth of the contrast at 16 bits is tracked like full contrast", "[device]") {
  const RenderedScene bright("room", 320, 200, 4, 1, 16), dim("room", 320, 200, 4, 1, 16, 0.01);
  for (const auto& name : all_devices()) {
    Device device(name, kept_programs());
    StereoOdometry first(bright.rig, device, bright.config), second(dim.rig, device, dim.config);
    for (std::size_t i = 0; i < 4; ++i) {
      const FrameResult expected = first.track(bright.frame(i)), found = second.track(dim.frame(i));
      CHECK(is_tracked(found.status));
      REQUIRE(found.world_from_left);
      CHECK((found.world_from_left->translation() - dim.world_from_left[i].translation()).norm() < 2e-3);
      CHECK(static_cast<double>(found.counts.edges_left) > 0.9 * expected.counts.edges_left);
      CHECK(static_cast<double>(found.counts.edges_left) < 2.0 * expected.counts.edges_left);
      CHECK(found.diagnostics.edge_threshold < 0.1);
    }
  }
}
