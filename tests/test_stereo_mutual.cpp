#include "describing.hpp"
#include "device/stereo_matching.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Two images of the smooth texture, shifted by 6.3 px, with left edges at given positions and the choice of each.
struct MutualScene {
  StereoRig rig = flat_rig(97, 71);
  StereoConfig config;
  Config all;
  EpipolarGeometry geometry;
  Image right_image = image_of(97, 71, [](double x, double y) { return smooth_grey(x + 6.3, y); });
  EdgeSet left, right;
  reference::StereoClusters clusters;
  reference::StereoRelaxation relaxation;

  MutualScene() {
    config.max_disparity = 20;
    geometry = make_epipolar_geometry(rig, config);
    clusters.first = {0};
  }
  /// The next left edge has chosen its only cluster, at a right edge and a position on the line.
  void add(int target, double position, double score, double similarity) {
    relaxation.chosen.push_back(static_cast<std::int32_t>(clusters.position.size()));
    relaxation.score.push_back(score);
    clusters.anchor.push_back(target);
    clusters.position.push_back(position);
    clusters.direction.push_back(right.direction[static_cast<std::size_t>(target)]);
    clusters.similarity.push_back(similarity);
    clusters.first.push_back(static_cast<std::int32_t>(clusters.position.size()));
  }
  /// The next left edge has no choice.
  void add_none() {
    relaxation.chosen.push_back(-1);
    relaxation.score.push_back(0);
    clusters.first.push_back(clusters.first.back());
  }
  StereoEdges match() const { return match(geometry); }
  StereoEdges match(const EpipolarGeometry& lines) const {
    return reference::stereo_mutual(clusters, relaxation, left, lines, config);
  }

  void compare_devices() const {
    const EpipolarGeometry searched = corrected(geometry, {0.9, 0.3, 0, 0, 2, 0}, rig);
    for (const EpipolarGeometry* lines : {static_cast<const EpipolarGeometry*>(nullptr), &searched})
      compare_devices(lines);
  }
  /// \param searched see StereoMutual::run()
  void compare_devices(const EpipolarGeometry* searched) const {
    const StereoEdges truth = match(), seen = match(searched != nullptr ? *searched : geometry);
    check_stage("stereo_mutual", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      stages::StereoMutual stage(context, config, variants);
      stages::Patches right_patches(context, 97, 71, all.patches, {});
      const auto image = upload(context, right_image);
      right_patches.prepare(image.pixels);
      stages::DeviceClusters device_clusters;
      device_clusters.stride = static_cast<int>(clusters.position.size());
      device_clusters.packed.write(context,
                                   packed<double>({&clusters.position, &clusters.direction, &clusters.similarity}));
      device_clusters.anchor.write(context, clusters.anchor);
      stages::DeviceRelaxation device_relaxation;
      device_relaxation.chosen.write(context, relaxation.chosen);
      device_relaxation.score.write(context, {relaxation.score.begin(), relaxation.score.end()});
      stages::DeviceStereoEdges result;
      StereoEdges found;
      stage.run(upload(context, left), upload(context, right), right_patches, geometry, searched, device_clusters,
                device_relaxation, result, found);
      // The right patches are sampled where the edges lie in the image.
      const auto recut =
          reference::side_patches(right_image.view(), seen.right_x, seen.right_y, seen.right_direction, all.patches);
      const auto apart = rounded_apart(result.right_patches.read(recut.size()), recut);
      CHECK(apart.largest <= 1);
      CHECK(apart.differing <= apart.samples / 98);
      return {{"left index", found.left_index, truth.left_index},
              {"right index", found.right_index, truth.right_index},
              {"left x", found.left_x, truth.left_x},
              {"left y", found.left_y, truth.left_y},
              {"left direction", found.left_direction, truth.left_direction},
              {"left scale shift", found.left_scale_shift, truth.left_scale_shift},
              {"right direction", found.right_direction, truth.right_direction},
              {"ncc", found.ncc, truth.ncc},
              {"right x", found.right_x, truth.right_x, {1e-3}},
              {"right y", found.right_y, truth.right_y, {1e-3}}};
    });
  }
};

}  // namespace

TEST_CASE("stereo mutual: one right edge serves only neighbours of its best left edge", "[device]") {
  MutualScene scene;
  scene.left = make_edges({{40, 30, 1.2}, {41, 30, 1.2}, {43, 30, 1.2}}, 71);
  scene.right = make_edges({{33.7, 30, 1.2}}, 71);
  scene.config.mutual_radius = 1.5;
  scene.add(0, 6.3, 1.1, 0.9);    // the best: its neighbours agree with it
  scene.add(0, 6.8, 0.9, 0.9);    // 1 px from the best one, within mutual_radius
  scene.add(0, 6.8, 1.05, 0.99);  // 3 px away: more similar, but with less support
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0, 1});
  scene.compare_devices();
  scene.config.mutual_radius = 0;  // strictly one-to-one
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0});
  scene.compare_devices();
  // A tie: the same left edge three times. The first owns the right edge; the others are at its position.
  scene.left.x = {40, 40, 40};
  scene.left.y = {30, 30, 30};
  scene.relaxation.score = {0.9, 0.9, 0.9};
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0, 1, 2});
  scene.compare_devices();
  scene.left.x = {44, 40, 40};  // now the others are too far from it
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0});
  scene.compare_devices();
}

TEST_CASE("stereo mutual: devices agree with the reference on random choices, on few and on none",
          "[device][oclgrind]") {
  Random random(29);
  for (const int count : {301, 1, 0}) {
    MutualScene scene;
    std::vector<Edge> left, right;
    for (int i = 0; i < count; ++i) left.push_back({random(30, 80), random(14, 56), random(-kPi, kPi)});
    for (int j = 0; j < count / 3 + 1; ++j) right.push_back({random(14, 80), random(14, 56), random(-kPi, kPi)});
    scene.left = make_edges(left, 71);
    scene.right = make_edges(right, 71);
    for (int i = 0; i < count; ++i) {
      if (i % 7 == 3) {
        scene.add_none();
      } else {  // rounded scores, so that several left edges tie for a right edge
        scene.add(static_cast<int>(random(0, count / 3 + 1)), random(4, 9), 0.05 * std::round(20 * random(0.8, 1.3)),
                  random(0.5, 1));
      }
    }
    if (count > 1) CHECK(scene.match().size() < static_cast<std::size_t>(count) * 2 / 3);
    scene.compare_devices();
  }
}
