#include "common/filter_limits.hpp"
#include "device/images.hpp"
#include "edge_images.hpp"
#include "edges/noise_gate.hpp"
#include "frontends.hpp"
#include "geometry/undistortion.hpp"
#include "reference/edge_detection.hpp"
#include "reference/images.hpp"
#include "stage_rows.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

constexpr double kGrey = 255.0 / 65535;  ///< of a step of 16 bits

/// The image as a camera sees it in a fraction of the light, with its noise.
Image in_the_dark(const Image& image, double light, double noise, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal(0, noise);
  return filled_image(image.width, image.height, [&](int x, int y) {
    return static_cast<int>(std::clamp(std::round(light * image.view().at(x, y) + normal(generator)), 0.0, 255.0));
  });
}

}  // namespace

TEST_CASE("smoothing: a single bright pixel becomes the binomial kernel, and its sum is kept") {
  Image image(33, 29, 65535);
  image.set(16, 14, 65535);
  const Image smoothed = reference::smoothed(image.view());
  constexpr double kMiddle = 12870.0 / 65536, kBeside = 11440.0 / 65536, kFar = 1.0 / 65536;  // C(16, 8), C(16, 7), 1
  CHECK(smoothed.view().value(16, 14) == std::lround(65535 * kMiddle * kMiddle));
  CHECK(smoothed.view().value(17, 14) == std::lround(65535 * kMiddle * kBeside));
  CHECK(smoothed.view().value(16, 13) == std::lround(65535 * kMiddle * kBeside));
  CHECK(smoothed.view().value(24, 14) == std::lround(65535 * kMiddle * kFar));
  CHECK(smoothed.view().value(25, 14) == 0);
  for (const int grey : {0, 77, 255}) {  // flat images and their borders stay
    const Image flat = noisy_image(19, 12, grey, 0);
    CHECK(reference::smoothed(flat.view()).pixels == flat.pixels);
  }
}

TEST_CASE("smoothing: the noise of smoothed images is predicted from that of the recorded ones") {
  const EdgesConfig config;
  const Image image = noisy_image(640, 480, 30000 * kGrey, 2000 * kGrey, 65535),
              smoothed = reference::smoothed(image.view());
  reference::EdgeThreshold before(config), after(config);
  before.next({image.view()});
  after.next({smoothed.view()});
  frontend::NoiseGate gate({}, config);
  CHECK(gate.judge(before.noise(), before.gradient()));  // nothing but noise
  CHECK(after.gradient() == Approx(gate.smoothed_noise() / before.noise() * before.gradient()).epsilon(0.03));
}

TEST_CASE("smoothing: the noise of recorded images is known from that of undistorted ones") {
  const Image recorded = noisy_image(640, 480, 30000 * kGrey, 2000 * kGrey, 65535);
  UndistortionTable table{600, 440, {}, {}};
  for (int y = 0; y < table.height; ++y) {
    for (int x = 0; x < table.width; ++x) {  // all fractions of a pixel occur
      table.source_x.change().push_back(static_cast<float>(x) * 1.02F + 0.3F);
      table.source_y.change().push_back(static_cast<float>(y) * 1.013F + 0.2F);
    }
  }
  reference::EdgeThreshold before{EdgesConfig{}}, after{EdgesConfig{}};
  before.next({recorded.view()});
  after.next({undistort(recorded.view(), table).view()});
  CHECK(after.noise() < 0.6 * before.noise());
  CHECK(after.noise() / before.noise() == Approx(frontend::measured_noise_ratio(table)).epsilon(0.05));
  CHECK(frontend::measured_noise_ratio({}) == 1);
}

TEST_CASE("smoothing: begins where the limit of noise exceeds the contrast, and ends at a fifth less") {
  frontend::NoiseGate gate({}, EdgesConfig{});
  const double limit = std::sqrt(8 * 3.14159265358979) * 4 / 5;  // noise whose limit is a gradient of 1
  CHECK_FALSE(gate.judge(0, 0));
  CHECK_FALSE(gate.judge(0.99 * limit, 1));
  CHECK(gate.judge(1.01 * limit, 1));
  CHECK(gate.judge(0.81 * limit, 1));
  CHECK_FALSE(gate.judge(0.79 * limit, 1));
  CHECK_FALSE(gate.judge(0.99 * limit, 1));
}

TEST_CASE("smoothing: every device and variant equals the reference exactly", "[device][oclgrind]") {
  check_stage("smoothing", [](opencl::Context& context, const Variants& variants) {
    StageArrays arrays;
    for (const int max_value : {255, 4095, 65535}) {
      stages::Smoothing stage(context, variants, max_value);
      for (const auto& [width, height] : {std::pair{1, 1}, {3, 5}, {17, 31}, {129, 66}}) {
        const Image image = noisy_image(width, height, 128, 102, max_value);
        opencl::Buffer<cl_uchar> pixels;
        pixels.write(context, image.pixels);
        stage.run(width, height, pixels);
        arrays.emplace_back(std::to_string(width) + " columns, values to " + std::to_string(max_value),
                            pixels.read(image.pixels.size()), reference::smoothed(image.view()).pixels);
      }
    }
    return arrays;
  });
}

TEST_CASE(
    "smoothing: dark frames, and only these, have the reference's stereo edges on every device, twice as many as "
    "without",
    "[device]") {
  const matching::RenderedScene bright("room", 321, 201, 2);
  matching::RenderedScene dark = bright;
  for (const std::size_t i : {0, 1}) {
    const auto seed = static_cast<unsigned>(i);
    dark.left[i] = in_the_dark(bright.left[i], 0.15, 8, 1 + seed);
    dark.right[i] = in_the_dark(bright.right[i], 0.15, 8, 3 + seed);
  }
  struct Found {
    double edges, threshold;
    bool is_smoothed;
  };
  const auto find = [&](const std::string& name, const Config& config,
                        const std::vector<const matching::RenderedScene*>& scenes) {
    Device device(name, kept_programs());
    const auto frontend = frontend::make_frontend(bright.rig, device, config);
    std::size_t edges = 0;
    for (std::size_t i = 0; i < scenes.size(); ++i) edges = frontend->process(scenes[i]->frame(i % 2))->edges.size();
    const auto searched = frontend->searched(scenes.back()->frame(0));
    CHECK((searched.left.pixels != scenes.back()->left[0].pixels.data()) == frontend->is_smoothed());
    return Found{static_cast<double>(edges), frontend->counts().edge_threshold, frontend->is_smoothed()};
  };
  Config unsmoothed = bright.config;
  unsmoothed.edges.threshold = kThresholdMax;  // a fixed threshold measures no noise
  const Found expected = find("reference", bright.config, {&dark, &dark}),
              without = find("reference", unsmoothed, {&dark, &dark});
  CHECK(expected.is_smoothed);
  CHECK_FALSE(without.is_smoothed);
  CHECK(expected.edges > 2 * without.edges);
  for (const auto& device : all_devices()) {
    INFO(device);
    const Found found = find(device, bright.config, {&dark, &dark});
    CHECK(found.is_smoothed);
    CHECK(found.edges == Approx(expected.edges).epsilon(0.02));
    CHECK(found.threshold == Approx(expected.threshold).epsilon(0.01));
    CHECK(find(device, bright.config, {&bright, &dark}).is_smoothed);
    CHECK_FALSE(find(device, bright.config, {&dark, &bright}).is_smoothed);
  }
  Device device("reference");
  StereoOdometry odometry(bright.rig, device, bright.config);
  CHECK_THAT(odometry.track(bright.frame(0)).message, !Contains("smoothed"));
  CHECK_THAT(odometry.track(dark.frame(1)).message, Contains("smoothed"));
}
