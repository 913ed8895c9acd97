#include "device/stereo_matching.hpp"
#include "geometry/disparity_range.hpp"
#include "matching.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Left edges with made-up clusters.
struct RelaxationScene {
  StereoRig rig;
  StereoConfig config;
  EpipolarGeometry geometry;
  EdgeSet left;
  reference::StereoClusters clusters;
  std::pair<Image, Image> views;
  std::optional<reference::CoarseDisparity> coarse_disparity;

  explicit RelaxationScene(const StereoRig& of_rig) : rig(of_rig) {
    config.max_disparity = 60;
    geometry = make_epipolar_geometry(rig, config);
    clusters.first = {0};
  }
  struct Member {
    double position, direction, similarity;  // px, rad
  };
  /// Adds a left edge; its clusters are in the order of their positions.
  void add(const Edge& edge, std::vector<Member> members) {
    left.x.push_back(static_cast<float>(edge.x));
    left.y.push_back(static_cast<float>(edge.y));
    left.direction.push_back(static_cast<float>(edge.direction));
    for (const Member& member : members) {
      clusters.anchor.push_back(static_cast<std::int32_t>(clusters.anchor.size()));
      clusters.position.push_back(member.position);
      clusters.direction.push_back(member.direction);
      clusters.similarity.push_back(member.similarity);
    }
    clusters.first.push_back(static_cast<std::int32_t>(clusters.position.size()));
  }
  reference::StereoRelaxation relax() const {
    return reference::stereo_relaxation(clusters, left, geometry, rig.left.width, rig.left.height, config,
                                        coarse_disparity ? &*coarse_disparity : nullptr);
  }
  /// From now on a coarse disparity of these views is consulted.
  void consult(const Image& left_view, const Image& right_view) {
    views = {left_view, right_view};
    coarse_disparity =
        reference::coarse_disparity(left_view.view(), right_view.view(), coarse_search(rig, geometry).value());
  }
  /// Position of edge i's choice; NaN: none.
  double chosen(const reference::StereoRelaxation& relaxation, std::size_t i) const {
    const auto k = relaxation.chosen[i];
    return k < 0 ? std::nan("") : clusters.position[static_cast<std::size_t>(k)];
  }

  /// Checks that every device and variant gives the same beliefs, choices and scores within 1e-3. Single precision may
  /// change a choice between two equal beliefs, for at most `band` edges.
  void compare_devices(std::size_t band) const {
    const auto truth = relax();
    const std::size_t rows = left.size();
    reference::Candidates lists;
    lists.first = clusters.first;
    lists.target = clusters.anchor;
    std::vector<cl_int> counts;
    for (std::size_t i = 0; i < rows; ++i) counts.push_back(clusters.first[i + 1] - clusters.first[i]);
    check_stage("stereo_relaxation", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      stages::StereoRelaxation stage(context, rig.left.width, rig.left.height, config, variants);
      const auto candidates = upload(context, lists);
      stages::DeviceClusters device_clusters;
      device_clusters.stride = candidates.capacity;
      device_clusters.packed.write(context,
                                   packed<double>({&clusters.position, &clusters.direction, &clusters.similarity}));
      device_clusters.count.write(context, counts);
      stages::DeviceRelaxation found;
      stages::CoarseDisparity coarse(context, variants, kMaxValue8);
      if (coarse_disparity)
        coarse.run(upload(context, views.first), upload(context, views.second), coarse_disparity->search);
      const stages::CoarseDisparity* const asked = coarse_disparity ? &coarse : nullptr;
      stage.run(upload(context, left), geometry, candidates, device_clusters, found, asked);
      return {{"belief", found.belief.read(clusters.position.size()), truth.belief, {1e-3, band}},
              {"chosen", found.chosen.read(rows), truth.chosen, {0, band}},
              {"score", found.score.read(rows), truth.score, {1e-3, band}},
              {"edges", std::vector{found.host_tally.edges}, std::vector{truth.tally.edges}},
              {"undecided",
               std::vector{found.host_tally.undecided},
               std::vector{truth.tally.undecided},
               {static_cast<double>(band)}}};
    });
  }
};

constexpr double kUpright = -0.5 * kPi;  // vertical, bright on the right

/// A wall of upright edges every 4 px at `position`. With `wrong` > 0 each edge also has a wrong cluster, at that
/// distance from the right position and more similar by `lead`.
RelaxationScene wall(double position, double wrong, double lead) {
  RelaxationScene scene(flat_rig(97, 71));
  for (int y = 12; y < 60; y += 4) {
    for (int x = 14; x < 84; x += 4) {
      if (wrong > 0) {
        scene.add({1.0 * x, 1.0 * y, kUpright}, {{position, kUpright, 0.9}, {position + wrong, kUpright, 0.9 + lead}});
      } else {
        scene.add({1.0 * x, 1.0 * y, kUpright}, {{position, kUpright, 0.9}});
      }
    }
  }
  return scene;
}

/// Edges of a slanted plane, each with its true candidate and a wrong one at a smaller position, which is slightly more
/// similar for every other edge. \returns the true positions; NaN for edges without candidates.
std::vector<double> see_plane(RelaxationScene& scene) {
  Random random(5);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.5, -0.3, -1).normalized(), point(0, 0, 2.2);
  const auto seen = [&](double x, double y) -> Eigen::Vector2d {
    const Eigen::Vector3d ray = scene.rig.left.ray({x, y});
    return scene.rig.right.project(scene.rig.right_from_left *
                                   Eigen::Vector3d(point.dot(normal) / ray.dot(normal) * ray));
  };
  std::vector<double> truth;
  for (int i = 0; i < 900; ++i) {
    const Edge edge = {random(11, scene.rig.left.width - 11), random(11, scene.rig.left.height - 11),
                       random(-kPi, kPi)};
    const auto line = epipolar_line(scene.geometry, static_cast<float>(edge.x), static_cast<float>(edge.y));
    const Eigen::Vector2d at = seen(edge.x, edge.y);
    const Eigen::Vector2d step =
        seen(edge.x + 0.01 * std::cos(edge.direction), edge.y + 0.01 * std::sin(edge.direction)) - at;
    const double direction = std::atan2(step.y(), step.x());
    const double position = (at - Eigen::Vector2d(line.x, line.y)).dot(Eigen::Vector2d(line.ex, line.ey));
    if (i % 10 == 9) {
      scene.add(edge, {});
      truth.push_back(std::nan(""));
      continue;
    }
    truth.push_back(position);
    const double lead = i % 2 == 0 ? 0.02 : -0.02;
    scene.add(edge, {{position - random(4, 9), direction + 0.1, 0.9 + lead}, {position, direction, 0.9}});
  }
  return truth;
}

std::size_t right_choices(const RelaxationScene& scene, const std::vector<double>& truth) {
  const auto relaxation = scene.relax();
  std::size_t right = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) right += scene.chosen(relaxation, i) == truth[i] ? 1 : 0;
  return right;
}

}  // namespace

TEST_CASE("stereo relaxation: neighbours do not overrule a clear lead") {
  // Full support is worth ((1 + floor) / floor)^2 = 441 = exp(0.244 / scale).
  for (const auto& [lead, position] : {std::pair(0.2, 10.0), std::pair(0.3, 18.0)}) {
    RelaxationScene scene = wall(10, 0, 0);
    scene.add({46.5, 35.5, kUpright}, {{10, kUpright, 0.6}, {18, kUpright, 0.6 + lead}});
    CHECK(scene.chosen(scene.relax(), scene.left.size() - 1) == position);
  }
}

TEST_CASE("stereo relaxation: a few unambiguous edges resolve a repeated texture") {
  RelaxationScene scene = wall(10, 8, 0.003);  // a period of 8 px: the wrong cluster is more similar everywhere
  CHECK(scene.chosen(scene.relax(), 100) == 18);
  // One edge in seven is not repeated.
  for (std::size_t i = 0; i < scene.left.size(); i += 7) scene.clusters.similarity[2 * i + 1] = 0.1;
  CHECK(right_choices(scene, std::vector<double>(scene.left.size(), 10)) == scene.left.size());
}

TEST_CASE("stereo relaxation: a coarse disparity decides where all neighbours agree on the wrong candidates",
          "[device][oclgrind]") {
  RelaxationScene scene = wall(10, 8, 0.003);
  const Image left = image_of(97, 71, [](double x, double y) { return smooth_grey(3 * x, y); }),
              right = image_of(97, 71, [](double x, double y) { return smooth_grey(3 * (x + 10), y); });
  const std::vector<double> truth(scene.left.size(), 10);
  CHECK(right_choices(scene, truth) == 0);
  scene.compare_devices(0);
  scene.consult(left, right);
  CHECK(right_choices(scene, truth) > scene.left.size() * 9 / 10);
  scene.compare_devices(0);
}

TEST_CASE("stereo relaxation: candidates that neighbours support need less similarity") {
  RelaxationScene scene = wall(10, 0, 0);
  const auto wall_size = scene.left.size();
  scene.add({46.5, 35.5, kUpright}, {{10, kUpright, 0.6}});    // supported
  scene.add({50.5, 35.5, kUpright}, {{17, kUpright, 0.84}});   // not supported
  scene.add({54.5, 35.5, kUpright}, {{17, kUpright, 0.86}});   // not supported, but similar enough
  scene.add({58.5, 35.5, kUpright}, {{10, kUpright, 0.449}});  // filter 9
  const auto relaxation = scene.relax();
  CHECK(scene.chosen(relaxation, wall_size) == 10);
  CHECK(std::isnan(scene.chosen(relaxation, wall_size + 1)));
  CHECK(scene.chosen(relaxation, wall_size + 2) == 17);
  CHECK(std::isnan(scene.chosen(relaxation, wall_size + 3)));
  CHECK(relaxation.score[wall_size] == Approx(0.6 + 0.4));
  CHECK(relaxation.score[wall_size + 2] == Approx(0.86 + 0.4 * 0.7));  // needs no support
  RelaxationScene alone(flat_rig(97, 71));
  alone.add({46.5, 35.5, kUpright}, {{10, kUpright, 0.84}, {14, kUpright, 0.5}});
  alone.add({90.5, 64.5, kUpright}, {{10, kUpright, 0.86}, {14, kUpright, 0.5}});
  CHECK(alone.relax().chosen == std::vector<std::int32_t>{-1, 2});
}

TEST_CASE("stereo relaxation: among equal beliefs the first candidate is chosen", "[device]") {
  RelaxationScene scene(flat_rig(97, 71));
  scene.add({46.5, 35.5, kUpright}, {{8, kUpright, 0.9}, {12, kUpright, 0.9}});
  scene.add({52.5, 35.5, kUpright}, {{10, kUpright, 0.9}});
  const auto relaxation = scene.relax();
  CHECK(relaxation.belief[0] == Approx(0.5));
  CHECK(relaxation.chosen == std::vector<std::int32_t>{0, 2});
  scene.compare_devices(0);
}

TEST_CASE("stereo relaxation: a slanted plane, on a rectified rig and on one with two different cameras", "[device]") {
  StereoRig flat = flat_rig(143, 97, 120, 0.25);
  for (const StereoRig& rig : {flat, crooked_rig()}) {
    RelaxationScene scene(rig);
    const auto truth = see_plane(scene);
    CHECK(right_choices(scene, truth) > 810 * 97 / 100);
    scene.compare_devices(4);
    RelaxationScene alone = scene;
    alone.config.relaxation_rounds = 0;
    CHECK(right_choices(alone, truth) == 360);  // the odd ones that have candidates
    alone.compare_devices(0);
  }
}

TEST_CASE("stereo relaxation: devices agree with the reference on random clusters, on few edges and on none",
          "[device][oclgrind]") {
  Random random(31);
  for (const int count : {401, 1, 0}) {
    RelaxationScene scene(flat_rig(97, 71));
    for (int i = 0; i < count; ++i) {
      std::vector<RelaxationScene::Member> members;
      for (int k = 0; k < i % 6; ++k) members.push_back({3.0 * k + random(0, 2), random(-kPi, kPi), random(0.3, 1)});
      scene.add({random(10, 86), random(10, 60), random(-kPi, kPi)}, members);
    }
    scene.compare_devices(4);
  }
}
