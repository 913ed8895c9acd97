#include "common/matching_constants.hpp"
#include "device/stereo_matching.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

const PatchesConfig patches;
const double kOffset = patches.offset;

/// A right image that shows the left one's texture at a disparity of 6.3 px, with edges everywhere and one candidate
/// per left edge, up to 1.2 px from the true position along the line and up to 0.4 px across it.
struct RefinementScene {
  StereoRig rig = flat_rig(97, 71);
  StereoConfig config;
  Image left_image, right_image;
  EdgeSet left, right;
  reference::Candidates lists;
  reference::CandidateScores scores;
  EpipolarGeometry geometry;

  explicit RefinementScene(int count, std::uint64_t seed = 2) {
    config.max_disparity = 20;
    // The candidates lie farther off than real edges: only the images decide, with more steps until convergence.
    config.refine_prior_sigma = 100;
    config.refine_steps = 20;
    config.refine_tolerance = 1e-3;
    geometry = make_epipolar_geometry(rig, config);
    left_image = image_of(97, 71, smooth_grey);
    right_image = image_of(97, 71, [](double x, double y) { return smooth_grey(x + kDisparity, y); });
    Random random(seed);
    std::vector<Edge> edges;
    for (int i = 0; i < count; ++i)
      edges.push_back({random(26, 80), random(14, 56), random(0.3, kPi - 0.3) * (i % 2 == 0 ? 1 : -1)});
    left = make_edges(edges, 71);
    right = left;
    lists.first = {0};
    for (std::size_t i = 0; i < left.size(); ++i) {
      // Off the line by d: the edge's point moves along its tangent, and the epipolar shift moves it back.
      const double d = random(-0.4, 0.4), wrong = random(-1.2, 1.2);
      right.x[i] += static_cast<float>(-kDisparity + wrong + d / std::tan(static_cast<double>(left.direction[i])));
      right.y[i] += static_cast<float>(d);
      lists.target.push_back(static_cast<std::int32_t>(i));
      lists.first.push_back(static_cast<std::int32_t>(i) + 1);
    }
    scores = fresh_scores(left.size());
  }
  static constexpr double kDisparity = 6.3;

  /// Changes to rows of zero to six candidates: the edge's own one and copies along the line, some at the same
  /// position.
  void crowd() {
    const float offsets[] = {0.0f, 0.2f, 3.0f, 3.3f, -2.0f, 6.0f};
    const EdgeSet own = right;
    right.x.clear(), right.y.clear(), right.direction.clear();
    lists = {};
    lists.first = {0};
    for (std::size_t i = 0; i < own.size(); ++i) {
      for (std::size_t k = 0; k < i % 7; ++k) {
        lists.target.push_back(static_cast<std::int32_t>(right.x.size()));
        right.x.push_back(own.x[i] - offsets[k]), right.y.push_back(own.y[i]),
            right.direction.push_back(own.direction[i]);
      }
      lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
    }
    right.strength.assign(right.x.size(), 10.0f);
    scores = fresh_scores(right.x.size());
    for (std::size_t c = 0; c < scores.ncc.size(); ++c) scores.ncc[c] = 0.8f + 0.01f * static_cast<float>(c * 7 % 5);
  }

  std::vector<std::int8_t> left_patches() const {
    return reference::side_patches(left_image.view(), left.x, left.y, left.direction, patches);
  }
  reference::RefinedCandidates refine(reference::CandidateScores& result) const {
    return reference::stereo_refinement(left_image.view(), right_image.view(), left_patches(), left, right, geometry,
                                        lists, config, kOffset, result);
  }
  /// Checks every variant and device: surviving candidates within 1e-2 px and a similarity of 5e-3 of the reference.
  /// Decisions may differ only where a shift is within rounding of its limit: at most 1 % of them.
  void compare_devices() const {
    auto truth = scores;
    const auto [positions, similarity] = refine(truth);
    check_stage("stereo_refinement", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      stages::StereoRefinement stage(context, config, kOffset, variants);
      auto device = upload(context, lists);
      upload(context, scores, device);
      opencl::Buffer<cl_char> device_patches;
      stages::DeviceRefined found;
      device_patches.write(context, left_patches());
      stages::PixelCorners left_corners(context), right_corners(context);
      left_corners.prepare(upload(context, left_image).pixels, left_image.width, left_image.height);
      right_corners.prepare(upload(context, right_image).pixels, right_image.width, right_image.height);
      stage.run(left_corners, right_corners, upload(context, left), upload(context, right), device_patches, geometry,
                device, found);
      const auto states = device.state.read(positions.size());
      auto at = found.position.read(positions.size()), alike = found.similarity.read(positions.size());
      for (std::size_t c = 0; c < positions.size(); ++c) {
        if (states[c] == kCandidateAlive && truth.state[c] == kCandidateAlive) continue;
        at[c] = static_cast<float>(positions[c]), alike[c] = static_cast<float>(similarity[c]);
      }
      return {{"states", states, truth.state, {0, positions.size() / 100}},
              {"positions", at, positions, {1e-2}},
              {"similarities", alike, similarity, {5e-3}}};
    });
  }
};

/// Checks that candidates end at the true disparity, as accurately as 8 bits allow. Flat spots, where rounding has more
/// effect, are left out: less than 4 grey levels per px along the line.
void check_disparity(const RefinementScene& scene) {
  auto result = scene.scores;
  const auto [positions, similarity] = scene.refine(result);
  std::vector<double> errors;
  for (std::size_t c = 0; c < positions.size(); ++c) {
    const double direction = scene.left.direction[c];
    const auto frame =
        reference::patch_frame(scene.left.x[c], scene.left.y[c], std::cos(direction), std::sin(direction), 0, 0);
    const auto slopes = reference::patch_derivative(scene.left_image.view(), frame, 1, 0);
    if (std::sqrt(std::inner_product(slopes.begin(), slopes.end(), slopes.begin(), 0.0) / kPatchSamples) < 4) continue;
    CHECK(result.state[c] == kCandidateAlive);
    CHECK(similarity[c] > 0.99);
    errors.push_back(positions[c] - RefinementScene::kDisparity);
  }
  CHECK(errors.size() > 90);
  check_subpixel(errors);
}

}  // namespace

TEST_CASE("epipolar shift: along the tangent if it crosses the line, else perpendicular") {
  // The line through (50, 20) towards -x.
  const EpipolarLine line{50, 20, -1, 0, 30, true};
  const auto shift = [&](double x, double y, double degrees) {
    return reference::epipolar_shift(line, x, y, degrees * kDegree, 12 * kDegree, 3);
  };
  CHECK(shift(40, 20, 70) == Approx(10));
  CHECK(shift(40, 20.5, 90) == Approx(10));
  // Tangent at 45 degrees through (40, 20.5): meets y = 20 at x = 39.5, s = 10.5.
  CHECK(shift(40, 20.5, 45) == Approx(10.5));
  CHECK(shift(40, 20.5, -135) == Approx(10.5));
  CHECK(shift(40, 20.5, -45) == Approx(9.5));
  // 10 degrees are less than 12: projected perpendicularly. 13 degrees and 0.8 px: a shift of 0.8 / sin 13 = 3.56 px is
  // too long.
  CHECK(shift(40, 20.5, 10) == Approx(10));
  CHECK(shift(40, 20.8, 13) == Approx(10));
  CHECK(shift(40, 20.5, 13) == Approx(10 + 0.5 / std::tan(13 * kDegree)));
}

TEST_CASE("stereo refinement: finds a disparity of 6.3 px to 0.02 px") { check_disparity(RefinementScene(150)); }

TEST_CASE("stereo refinement: a different exposure of the right camera does no harm", "[device]") {
  RefinementScene scene(150);
  scene.right_image =
      image_of(97, 71, [](double x, double y) { return 20 + 0.9 * smooth_grey(x + RefinementScene::kDisparity, y); });
  check_disparity(scene);
  scene.compare_devices();
}

TEST_CASE("stereo refinement: a strong prior keeps the shifted position, the default one weighs it against the images",
          "[device]") {
  RefinementScene scene(60);
  auto result = scene.scores;
  const auto free = scene.refine(result).position;
  scene.config.refine_prior_sigma = 0.002;
  result = scene.scores;
  const auto held = scene.refine(result).position;
  scene.config.refine_prior_sigma = StereoConfig{}.refine_prior_sigma;
  result = scene.scores;
  const auto weighed = scene.refine(result).position;
  int moved = 0;
  for (std::size_t c = 0; c < free.size(); ++c) {
    const double y = scene.right.y[c];
    const auto line = epipolar_line(scene.geometry, scene.left.x[c], scene.left.y[c]);
    const double start =
        reference::epipolar_shift(line, scene.right.x[c], y, scene.right.direction[c], kShiftMinAngle, kShiftMax);
    CHECK(std::abs(held[c] - start) < 0.1);
    if (std::abs(free[c] - start) > 0.5 && std::abs(free[c] - RefinementScene::kDisparity) < 0.05) {
      ++moved;
      CHECK(std::abs(weighed[c] - RefinementScene::kDisparity) < std::abs(start - RefinementScene::kDisparity));
    }
  }
  CHECK(moved > 10);
  scene.compare_devices();
}

TEST_CASE("stereo refinement: rejects shifts beyond the limit and dissimilar candidates, ignores rejected ones") {
  RefinementScene scene(60);
  for (std::size_t i = 0; i < scene.right.size(); ++i) scene.right.x[i] -= i % 3 == 0 ? 4.5f : 0.0f;
  scene.scores.state[1] = 5;
  auto result = scene.scores;
  scene.refine(result);
  CHECK(result.state[1] == 5);
  for (std::size_t i = 0; i < scene.right.size(); i += 3) CHECK(result.state[i] == order_of(StereoFilter::refinement));
  scene.right_image =
      image_of(97, 71, [](double x, double y) { return 128 + 70 * std::sin(1.3 * x) * std::cos(1.1 * y); });
  result = scene.scores;
  const auto similarity = scene.refine(result).similarity;
  int alike = 0;
  for (std::size_t c = 0; c < similarity.size(); ++c)
    alike += result.state[c] == kCandidateAlive && similarity[c] >= StereoConfig{}.refined_ncc_min ? 1 : 0;
  CHECK(alike <= 5);
}

TEST_CASE("stereo refinement: devices agree with the reference, on rows of several candidates, too", "[device]") {
  RefinementScene scene(400, 8), rows(300, 5);
  scene.compare_devices();
  for (std::size_t i = 0; i < scene.right.size(); ++i) scene.right.x[i] += static_cast<float>(i % 5) - 2.0f;
  scene.scores.state[3] = 4;
  scene.compare_devices();
  rows.crowd();
  auto result = rows.scores;
  rows.refine(result);
  CHECK(std::count(result.state.begin(), result.state.end(), kCandidateRepresented) > 100);
  rows.compare_devices();
}

TEST_CASE("stereo refinement: few candidates, several in a row, and none", "[device][oclgrind]") {
  for (const int count : {3, 0}) RefinementScene(count).compare_devices();
  RefinementScene several(11);
  several.crowd();
  several.compare_devices();
}
