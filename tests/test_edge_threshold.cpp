#include "device/edge_detection.hpp"
#include "edge_images.hpp"
#include "reference/edge_detection.hpp"
#include "stage_rows.hpp"

using namespace quadedge;

namespace {

/// The image with its differences from `middle` scaled, at another bit depth.
Image flattened(const Image& image, double contrast, int max_value, double middle = 128) {
  return filled_image(image.width, image.height, max_value, [&](int x, int y) {
    const double grey = middle + contrast * (static_cast<double>(image.view().at(x, y)) - middle);
    return static_cast<int>(std::lround(grey * max_value / kMaxValue8));
  });
}

struct ThresholdAndNoise {
  float threshold = 0, noise = 0;
};

/// The thresholds of consecutive frames in one stage; a frame is one image or two.
std::vector<ThresholdAndNoise> measure(opencl::Context& context, const Variants& variants,
                                       const std::vector<std::vector<Image>>& frames, const EdgesConfig& config) {
  stages::EdgeThreshold stage(context, config, variants);
  std::vector<ThresholdAndNoise> found;
  for (const auto& images : frames) {
    std::vector<stages::PaddedPlane> planes;
    for (const Image& image : images) {
      planes.emplace_back(context, image.width, image.height, config.sigma, image.max_value);
      opencl::Buffer<cl_uchar> pixels;
      pixels.write(context, image.pixels);
      planes.back().prepare(pixels);
      context.finish();
    }
    stage.run(planes[0], planes.size() > 1 ? &planes[1] : nullptr);
    const auto values = stage.values().read(3);
    found.push_back({values[0], values[1]});
  }
  return found;
}

std::vector<ImageView> views(const std::vector<Image>& images) {
  std::vector<ImageView> result;
  for (const Image& image : images) result.push_back(image.view());
  return result;
}

/// Threshold and noise of a single frame by the reference.
ThresholdAndNoise reference_of(const std::vector<Image>& images, const EdgesConfig& config = {}) {
  reference::EdgeThreshold reference(config);
  const double threshold = reference.next(views(images));
  return {static_cast<float>(threshold), static_cast<float>(reference.noise())};
}

}  // namespace

TEST_CASE("edge threshold: noise is measured to 5 %, at any image size, bit depth and grey level") {
  for (const auto& [width, height] : {std::pair{127, 93}, {640, 481}}) {
    const double tolerance = width > 200 ? 0.05 : 0.12;
    for (const double sigma : {1.0, 1.5, 3.0, 8.0}) {
      INFO(width << " " << sigma);
      CHECK(static_cast<double>(reference_of({noisy_image(width, height, 128, sigma)}).noise) ==
            Approx(std::sqrt(sigma * sigma + 1.0 / 12.0)).epsilon(tolerance));
    }
    for (const double sigma : {0.05, 0.3, 2.0}) {
      INFO(width << " " << sigma);
      CHECK(static_cast<double>(reference_of({noisy_image(width, height, 60, sigma, 65535)}).noise) ==
            Approx(sigma).epsilon(tolerance));
      CHECK(static_cast<double>(reference_of({noisy_image(width, height, 200, sigma, 4095)}).noise) ==
            Approx(sigma).epsilon(tolerance + 0.01));
    }
  }
}

TEST_CASE("edge threshold: saturated pixels are left out of the noise estimate") {
  Image image = noisy_image(320, 241, 128, 2);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < 240; ++x) image.set(x, y, x < 120 ? 0 : 255);
  CHECK(static_cast<double>(reference_of({image}).noise) == Approx(2.02).epsilon(0.08));
}

TEST_CASE("edge threshold: every device and variant agrees with the reference", "[device][oclgrind]") {
  std::vector<std::vector<Image>> cases;
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 9}, {17, 31}, {75, 66}}) {
    const Image image = textured_image(width, height), other = textured_image(width + 5, height + 3, 2);
    cases.push_back({image});
    cases.push_back({image, other});
    cases.push_back({flattened(image, 0.1, 255), flattened(other, 0.1, 255)});
    cases.push_back({flattened(image, 0.01, 65535), flattened(other, 0.01, 65535)});
    cases.push_back({noisy_image(width, height, 3, 4), noisy_image(width, height, 128, 12)});
  }
  check_stage("edge_threshold", [&](opencl::Context& context, const Variants& variants) {
    StageArrays arrays;
    for (const double sigma : {2.0, 0.8, 3.1}) {
      EdgesConfig config;
      config.sigma = sigma;
      for (std::size_t i = 0; i < cases.size(); ++i) {
        const ThresholdAndNoise found = measure(context, variants, {cases[i]}, config).front();
        const ThresholdAndNoise expected = reference_of(cases[i], config);
        // A gradient on the border of two bins may fall on either side; the smallest sizes have few points.
        const auto threshold = static_cast<double>(expected.threshold), noise = static_cast<double>(expected.noise);
        const std::string name = "sigma " + std::to_string(sigma) + " case " + std::to_string(i);
        arrays.emplace_back(name + " threshold", std::vector{found.threshold}, std::vector{threshold},
                            Within{(cases[i][0].width < 70 ? 0.05 : 0.01) * threshold});
        arrays.emplace_back(name + " noise", std::vector{found.noise}, std::vector{noise}, Within{1e-4 * noise});
      }
    }
    return arrays;
  });
}

TEST_CASE("edge threshold: normal contrast gives the largest, a flat image the lowest, a saturated image the largest") {
  const EdgesConfig config;
  const double one_step = 1.0 / (std::sqrt(2.0 * 3.14159265358979323846) * config.sigma);
  CHECK(reference_of({textured_image(320, 240)}).threshold == 2.0F);
  CHECK(reference_of({noisy_image(320, 240, 100, 0)}).threshold == Approx(2 * one_step));
  CHECK(reference_of({noisy_image(320, 240, 100, 0, 65535)}).threshold == Approx(2 * one_step / 257));
  CHECK(reference_of({noisy_image(320, 240, 0, 0)}).threshold == 2.0F);
  CHECK(reference_of({noisy_image(320, 240, 255, 0)}).threshold == 2.0F);
  // Noise alone: five standard deviations of its gradient, never above the largest threshold.
  const double per_noise = 5.0 / (std::sqrt(8.0 * 3.14159265358979323846) * 4.0);
  CHECK(static_cast<double>(reference_of({noisy_image(640, 480, 128, 3)}).threshold) ==
        Approx(3 * per_noise).epsilon(0.05));
  CHECK(reference_of({noisy_image(640, 480, 128, 30)}).threshold == 2.0F);
}

TEST_CASE("edge threshold: follows the contrast, and the number of edges stays similar", "[device]") {
  const Image bright = textured_image(320, 243);
  for (const auto& index : all_devices()) {
    Device device(index, kept_programs());
    const std::size_t edges = detect_edges(bright.view(), device, {}).size();
    for (const auto& [contrast, max_value] : {std::pair{0.2, 255}, {0.1, 4095}, {0.05, 65535}, {0.004, 65535}}) {
      INFO(device.info().name << " " << contrast << " " << max_value);
      const Image dim = flattened(bright, contrast, max_value);
      const EdgeSet found = detect_edges(dim.view(), device, {});
      CHECK(static_cast<double>(found.size()) > 0.75 * static_cast<double>(edges));
      CHECK(static_cast<double>(found.size()) < 1.5 * static_cast<double>(edges));
      Config fixed;
      fixed.edges.threshold = 2;
      CHECK(static_cast<double>(detect_edges(dim.view(), device, fixed).size()) < 0.75 * static_cast<double>(edges));
    }
  }
}

TEST_CASE("edge threshold: stays constant under small changes of contrast and follows large ones at once", "[device]") {
  const Image bright = textured_image(320, 243);
  std::vector<std::vector<Image>> frames;
  for (const double contrast : {0.10, 0.105, 0.095, 0.11, 0.3, 0.1})
    frames.push_back({flattened(bright, contrast, 65535)});
  reference::EdgeThreshold reference{EdgesConfig{}};
  std::vector<double> expected;
  for (const auto& images : frames) expected.push_back(reference.next(views(images)));
  CHECK(expected[1] == expected[0]);
  CHECK(expected[2] == expected[0]);
  CHECK(expected[3] == expected[0]);
  CHECK(expected[4] > 2.5 * expected[0]);
  CHECK(expected[5] < 0.5 * expected[4]);
  for_each_variant("edge_threshold", [&](opencl::Context& context, const Variants& variants) {
    const auto found = measure(context, variants, frames, {});
    for (std::size_t i = 0; i < frames.size(); ++i) CHECK(found[i].threshold == Approx(expected[i]).epsilon(0.01));
  });
}

TEST_CASE("edge threshold: a fixed one is used unchanged", "[device]") {
  EdgesConfig config;
  config.threshold = 0.75;
  const Image flat = noisy_image(64, 48, 100, 0);
  CHECK(reference_of({flat}, config).threshold == 0.75F);
  for_each_variant("edge_threshold", [&](opencl::Context& context, const Variants& variants) {
    CHECK(measure(context, variants, {{flat}}, config)[0].threshold == 0.75F);
  });
}
