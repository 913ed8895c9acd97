#include "describing.hpp"
#include "matching.hpp"
#include "reference/patches.hpp"
#include "reference/stereo_clusters.hpp"
#include "stages/stereo_clusters.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Candidates of left edges on a rectified rig: position on the line [px], direction [degrees] and similarity of each.
struct Lists {
  reference::Candidates candidates;
  reference::CandidateScores scores;
  reference::RefinedCandidates refined;
  EdgeSet right;

  struct Member {
    double position, degrees, similarity;
  };
  explicit Lists(const std::vector<std::vector<Member>>& rows) {
    candidates.first = {0};
    for (const auto& row : rows) {
      for (const Member& member : row) {
        candidates.target.push_back(static_cast<std::int32_t>(right.direction.size()));
        refined.position.push_back(member.position);
        refined.similarity.push_back(member.similarity);
        right.direction.push_back(static_cast<float>(member.degrees * kDegree));
      }
      candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
    }
    scores = fresh_scores(refined.position.size());
  }
  reference::StereoClusters clusters(const StereoConfig& config = {}) const {
    return reference::stereo_clusters(candidates, scores, refined, right, config);
  }
};

/// Two images of the smooth texture 6.3 px apart, with left edges at chosen positions.
struct Scene {
  StereoRig rig = flat_rig(97, 71);
  StereoConfig config;
  Config all;
  EpipolarGeometry geometry;
  Image left_image = image_of(97, 71, smooth_grey);
  Image right_image = image_of(97, 71, [](double x, double y) { return smooth_grey(x + 6.3, y); });
  EdgeSet left, right;
  reference::Candidates candidates;
  reference::CandidateScores scores;
  reference::RefinedCandidates refined;

  Scene() {
    config.max_disparity = 20;
    geometry = make_epipolar_geometry(rig, config);
    candidates.first = {0};
  }
  struct Member {
    int target;
    double position, similarity;
  };
  /// Candidates of the next left edge: right edge, position on the line and similarity.
  void add(const std::vector<Member>& row) {
    for (const auto& [target, position, similarity] : row) {
      candidates.target.push_back(target);
      refined.position.push_back(position);
      refined.similarity.push_back(similarity);
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
    scores = fresh_scores(refined.position.size());
  }
  StereoEdges match() const {
    const auto clusters = reference::stereo_clusters(candidates, scores, refined, right, config);
    return reference::stereo_mutual(clusters, reference::stereo_best(clusters, config), left, geometry, config);
  }
  /// Every device and variant finds the same stereo edges. Single precision may turn a decision that lies within 1e-5
  /// of a limit or of a tie: `band` rows at most.
  void compare_devices(std::size_t band) const {
    const StereoEdges truth = match();
    for_each_variant(
        "stereo_clusters", [&](opencl::Context& context, const Variants& variants, const std::string& name) {
          INFO(name);
          stages::StereoClusters stage(context, config, variants);
          stages::Patches right_patches(context, 97, 71, all.patches, {});
          const auto image = upload(context, right_image);
          const auto device_left = upload(context, left), device_right = upload(context, right);
          right_patches.prepare(image.pixels);
          auto lists = upload(context, candidates);
          upload(context, scores, lists);
          stages::DeviceRefined device_refined;
          device_refined.position.write(context, {refined.position.begin(), refined.position.end()});
          device_refined.similarity.write(context, {refined.similarity.begin(), refined.similarity.end()});
          stages::DeviceClusters clusters;
          stages::DeviceStereoEdges result;
          stage.run(device_left, device_right, right_patches, geometry, lists, device_refined, clusters, result);
          StereoEdges found;
          result.read(found);
          std::size_t same = 0, j = 0;
          for (std::size_t i = 0; i < truth.size(); ++i) {
            while (j < found.size() && found.left_index[j] < truth.left_index[i]) ++j;
            if (j == found.size() || found.left_index[j] != truth.left_index[i] ||
                found.right_index[j] != truth.right_index[i])
              continue;
            ++same;
            CHECK(found.left_x[j] == truth.left_x[i]);
            CHECK(found.left_y[j] == truth.left_y[i]);
            CHECK(found.left_direction[j] == truth.left_direction[i]);
            CHECK(found.right_x[j] == Approx(truth.right_x[i]).margin(1e-3));
            CHECK(found.right_y[j] == Approx(truth.right_y[i]).margin(1e-3));
            CHECK(std::abs(std::remainder(
                      static_cast<double>(found.right_direction[j]) - static_cast<double>(truth.right_direction[i]),
                      2 * kPi)) < 1e-4);
            CHECK(found.ncc[j] == Approx(truth.ncc[i]).margin(1e-4));
          }
          CHECK(same + band >= truth.size());
          CHECK(same + band >= found.size());
          // The right patches are cut at the refined positions.
          const auto recut = reference::side_patches(right_image.view(), found.right_x, found.right_y,
                                                     found.right_direction, all.patches);
          const auto kept = result.right_patches.read(recut.size());
          const auto apart = rounded_apart(kept, recut);
          CHECK(apart.largest <= 1);
          CHECK(apart.differing <= apart.samples / 98);
        });
  }
};

/// Three left edges with candidates at the true position, beside it, and at a wrong one.
Scene small_scene() {
  Scene scene;
  scene.left = make_edges({{40, 30, 1.2}, {60, 30, -1.0}, {50, 40, 1.6}}, 71);
  scene.right = make_edges({{33.7, 30, 1.2}, {34.1, 30, 1.25}, {53.7, 30, -1.0}, {38, 40, 1.6}, {43.7, 40, 1.6}}, 71);
  scene.add({{0, 6.3, 0.97}, {1, 5.9, 0.95}});
  scene.add({{2, 6.3, 0.99}, {1, 14, 0.8}});
  scene.add({{3, 12.0, 0.9}, {4, 6.35, 0.96}});
  return scene;
}

}  // namespace

TEST_CASE("stereo clusters: cut at gaps, represented by the most alike member", "[stereo][matching]") {
  const Lists lists({{{5.5, 10, 0.8}, {3, 10, 0.7}, {3.9, 12, 0.9}, {4.5, 8, 0.85}}, {}, {{7, 0, 0.9}, {8, 0, 0.95}}});
  const auto clusters = lists.clusters();
  // 3, 3.9, 4.5 chain up (gaps 0.9, 0.6), 5.5 is a gap of exactly 1 away; 7 and 8 as well.
  CHECK(clusters.first == std::vector<std::int32_t>{0, 2, 2, 4});
  CHECK(clusters.position == std::vector<double>{3.9, 5.5, 7, 8});
  CHECK(clusters.anchor == std::vector<std::int32_t>{2, 0, 4, 5});
  CHECK(clusters.similarity == std::vector<double>{0.9, 0.8, 0.9, 0.95});
  // Weights exp(-d^2 / 8) of 10, 12, 8 degrees at distances 0.9, 0, 0.6.
  const double a = std::exp(-0.81 / 8), c = std::exp(-0.36 / 8);
  CHECK(clusters.direction[0] / kDegree == Approx((10 * a + 12 + 8 * c) / (a + 1 + c)).margin(1e-3));
}

TEST_CASE("stereo clusters: directions are compared and averaged around the full turn", "[stereo][matching]") {
  // 178 and -179 degrees are 3 apart; 30 and 55 are 25 apart, over the limit of 20; 10 and -170 are opposite.
  const auto clusters =
      Lists({{{1, 178, 0.9}, {1.5, -179, 0.9}}, {{1, 30, 0.9}, {1.5, 55, 0.9}}, {{1, 10, 0.9}, {1.5, -170, 0.9}}})
          .clusters();
  CHECK(clusters.first == std::vector<std::int32_t>{0, 1, 3, 5});
  // 178 with weight 1, 181 with weight exp(-0.25 / 8).
  const double w = std::exp(-0.25 / 8);
  CHECK(std::abs(std::remainder(clusters.direction[0] - (178 + 181 * w) / (1 + w) * kDegree, 2 * kPi)) < 1e-4);
  CHECK(clusters.direction[2] == Approx(55 * kDegree));
}

TEST_CASE("stereo clusters: of equally alike members the first by number stands for the cluster",
          "[stereo][matching]") {
  const auto clusters = Lists({{{1.5, 20, 0.9}, {1, 20, 0.9}},
                               {{4.3, 20, 0.90003}, {4.1, 20, 0.90001}, {4, 20, 0.89}},
                               {{3.4, 20, 0.9}, {3.1, 20, 0.9003}}})
                            .clusters();
  CHECK(clusters.anchor == std::vector<std::int32_t>{0, 2, 6});
}

TEST_CASE("stereo best: only clusters that are alike enough", "[stereo][matching]") {
  const Lists lists({{{1, 20, 0.76}, {5, 20, 0.9}}, {{1, 20, 0.74}}, {{1, 20, 0.74}, {5, 20, 0.75}}, {}});
  StereoConfig config;
  config.refined_ncc_min = 0.75;
  CHECK(reference::stereo_best(lists.clusters(), config) == std::vector<std::int32_t>{1, -1, 4, -1});
}

TEST_CASE("stereo clusters: no more members than allowed, and none that a filter rejected", "[stereo][matching]") {
  std::vector<Lists::Member> row;
  for (int k = 0; k < 12; ++k) row.push_back({0.5 * k, 20, 0.8 + 0.01 * k});
  Lists lists({row});
  CHECK(lists.clusters().first == std::vector<std::int32_t>{0, 2});  // 10 and 2
  CHECK(lists.clusters().position == std::vector<double>{4.5, 5.5});
  for (const std::size_t dead : {5, 6, 7}) lists.scores.state[dead] = 7;  // a gap of 2 px in the middle
  const auto clusters = lists.clusters();
  CHECK(clusters.first == std::vector<std::int32_t>{0, 2});
  CHECK(clusters.position == std::vector<double>{2, 5.5});
}

TEST_CASE("stereo best: the cluster that looks alike wins and is placed on the line", "[stereo][matching]") {
  const auto edges = small_scene().match();
  CHECK(edges.left_index == std::vector<std::int32_t>{0, 1, 2});
  CHECK(edges.right_index == std::vector<std::int32_t>{0, 2, 4});
  CHECK(edges.right_x[0] == Approx(40 - 6.3));
  CHECK(edges.right_x[1] == Approx(60 - 6.3));
  CHECK(edges.right_x[2] == Approx(50 - 6.35));
  CHECK(edges.ncc == std::vector<float>{0.97f, 0.99f, 0.96f});
}

TEST_CASE("stereo best: one right edge serves only neighbours of its best left edge", "[stereo][matching][device]") {
  Scene scene;
  scene.left = make_edges({{40, 30, 1.2}, {41, 30, 1.2}, {43, 30, 1.2}}, 71);
  scene.right = make_edges({{33.7, 30, 1.2}}, 71);
  scene.config.mutual_radius = 1.5;
  scene.add({{0, 6.3, 0.99}});  // the best
  scene.add({{0, 6.8, 0.9}});   // 1 px beside the best one, within mutual_radius
  scene.add({{0, 6.8, 0.9}});   // 3 px beside
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0, 1});
  scene.compare_devices(0);
  scene.config.mutual_radius = 0.5;
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0});
  scene.compare_devices(0);
  // A tie: the same left edge twice. The first one owns the right edge; both are at its position.
  scene.config.mutual_radius = 0;
  scene.left.x = {40, 40, 40};
  scene.refined.position = {6.3, 6.3, 6.3};
  scene.refined.similarity = {0.9, 0.9, 0.9};
  scene.left.y = {30, 30, 30};
  CHECK(scene.match().left_index == std::vector<std::int32_t>{0, 1, 2});
  scene.compare_devices(0);
}

TEST_CASE("stereo clusters: devices agree with the reference on random lists", "[stereo][matching][device]") {
  Scene scene;
  Random random(19);
  std::vector<Edge> left, right;
  for (int i = 0; i < 250; ++i) left.push_back({random(30, 80), random(14, 56), random(-kPi, kPi)});
  for (int j = 0; j < 300; ++j) right.push_back({random(14, 80), random(14, 56), random(-kPi, kPi)});
  scene.left = make_edges(left, 71);
  scene.right = make_edges(right, 71);
  for (int i = 0; i < 250; ++i) {
    std::vector<Scene::Member> row;
    for (int k = 0; k < i % 14; ++k) row.push_back({static_cast<int>(random(0, 300)), random(4, 9), random(0.5, 1)});
    scene.add(row);
  }
  for (std::size_t c = 0; c < scene.refined.position.size(); c += 7) scene.scores.state[c] = 8;
  CHECK(scene.match().size() > 30);
  scene.compare_devices(3);
}

TEST_CASE("stereo clusters: few edges, and none", "[stereo][matching][device][oclgrind]") {
  small_scene().compare_devices(0);
  Scene none;
  none.left = none.right = make_edges({}, 71);
  none.compare_devices(0);
}
