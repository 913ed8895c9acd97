#include "device/temporal_matching.hpp"
#include "matching.hpp"
#include "reference/temporal_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

void add(StereoEdges& edges, double x, double y, double degrees) {
  edges.left_index.push_back(static_cast<std::int32_t>(edges.size()));
  edges.right_index.push_back(edges.left_index.back());
  edges.left_x.push_back(static_cast<float>(x));
  edges.left_y.push_back(static_cast<float>(y));
  edges.right_x.push_back(static_cast<float>(x - 4));
  edges.right_y.push_back(static_cast<float>(y));
  edges.left_direction.push_back(static_cast<float>(degrees * kDegree));
  edges.right_direction.push_back(edges.left_direction.back());
  edges.ncc.push_back(0.9f);
}

/// Rows of candidates in left and right lists, with the filters' decisions.
struct QuadScene {
  StereoEdges current;
  TemporalSearch search;
  reference::Candidates left{{0}, {}}, right{{0}, {}};
  reference::CandidateScores left_scores, right_scores;
  TemporalConfig config;

  QuadScene(int rows, int most, std::uint64_t seed, int step = 1) {
    search.radius = 3;
    search.step = step;
    Random random(seed);
    for (int j = 0; j < 60; ++j) add(current, random(20, 30), random(20, 30), random(-180, 180));
    for (int i = 0; i < rows * step; ++i) {
      search.left.x.push_back(static_cast<float>(random(20, 30)));
      search.left.y.push_back(static_cast<float>(random(20, 30)));
      search.left.direction.push_back(0);
    }
    for (int row = 0; row < rows; ++row) {
      const int base = static_cast<int>(random(0, 60 - 1.5 * most));
      for (auto* lists : {&left, &right}) {
        const int count = most == 0 ? 0 : static_cast<int>(random(0, most + 0.99));
        const int first = base + static_cast<int>(random(0, 0.5 * most));
        for (int c = 0; c < count; ++c) lists->target.push_back(first + c);
        lists->first.push_back(static_cast<std::int32_t>(lists->target.size()));
      }
    }
    left_scores = scores(left, random);
    right_scores = scores(right, random);
  }
  static reference::CandidateScores scores(const reference::Candidates& lists, Random& random) {
    auto result = fresh_scores(lists.target.size());
    for (std::size_t c = 0; c < lists.target.size(); ++c) {
      result.ncc[c] = static_cast<float>(random(0.6, 1));
      result.state[c] = random(0, 1) < 0.2 ? 3 : 0;
    }
    return result;
  }
  TemporalMatches match() const {
    auto scores = left_scores;
    const auto agreement = reference::temporal_agreement(left, scores, right, right_scores);
    return reference::temporal_best(left, scores, agreement, current, config, search);
  }
  /// Checks that every device and variant finds the same quads bit for bit.
  void compare_devices() const {
    const auto truth = match();
    check_stage("temporal_quads", [&](opencl::Context& context, const Variants& variants) {
      stages::DeviceStereoEdges device_edges;
      device_edges.count = device_edges.stride = static_cast<int>(current.size());
      device_edges.packed.write(context, packed<float>({&current.left_x, &current.left_y, &current.left_direction,
                                                        &current.right_x, &current.right_y, &current.right_direction}));
      stages::DevicePositions predicted;
      predicted.write(context, {search.left});
      auto device_left = upload(context, left), device_right = upload(context, right);
      upload(context, left_scores, device_left);
      upload(context, right_scores, device_right);
      stages::TemporalQuads stage(context, config, variants);
      stage.agree(device_left, device_right);
      return arrays_of(stage.collect(device_edges, current, search, predicted.list(), device_left), truth);
    });
  }
};

}  // namespace

TEST_CASE("temporal best: chained positions form one group, others compete, ties go to the first") {
  StereoEdges current;
  add(current, 5, 5, 10);
  add(current, 6.4, 5, 12);
  add(current, 5.7, 5.4, 15);
  add(current, 5.1, 5, 40);
  add(current, 9, 9, 10);
  const reference::Candidates lists{{0, 5, 5}, {0, 1, 2, 3, 4}};
  auto scores = fresh_scores(5);
  const std::vector<float> agreement = {0.9f, 0.8f, 0.85f, 0.9f, 0.7f};
  TemporalSearch search{{{5, 5}, {5, 5}, {0, 0}}, {}, 3, 1};
  TemporalConfig config;
  config.distance_weight = 0;
  auto matches = reference::temporal_best(lists, scores, agreement, current, config, search);
  // 0, 2, 1 form a chain; 3 is near them but rotated by at least 25 degrees; 4 is far away.
  REQUIRE(matches.size() == 1);
  CHECK(matches.previous[0] == 0);
  CHECK(matches.current[0] == 0);
  CHECK(matches.competing_clusters[0] == 2);
  CHECK(matches.left_x[0] == 5.0f);
  CHECK(matches.right_x[0] == 1.0f);
  CHECK(matches.ncc[0] == 0.9f);
  scores.state[2] = 7;  // without the link: four groups
  CHECK(reference::temporal_best(lists, scores, agreement, current, config, search).competing_clusters[0] == 3);
}

TEST_CASE("temporal best: the predicted position decides between similar candidates, up to its weight") {
  StereoEdges current;
  add(current, 20, 20, 0);
  add(current, 21.5, 20, 0);
  const reference::Candidates lists{{0, 2}, {0, 1}};
  const auto scores = fresh_scores(2);
  // The second is at the prediction, the first 1.5 px = half the radius away: the first must be better by 0.2 / 4.
  const TemporalSearch search{{{21.5f}, {20}, {0}}, {}, 3, 1};
  TemporalConfig config;
  config.distance_weight = 0.2;
  CHECK(reference::temporal_best(lists, scores, {0.94f, 0.9f}, current, config, search).current[0] == 1);
  CHECK(reference::temporal_best(lists, scores, {0.96f, 0.9f}, current, config, search).current[0] == 0);
  config.distance_weight = 0;
  CHECK(reference::temporal_best(lists, scores, {0.94f, 0.9f}, current, config, search).current[0] == 0);
}

TEST_CASE("temporal quads: devices agree with the reference", "[device]") {
  const QuadScene scene(300, 14, 5);
  CHECK(scene.match().size() > 100);
  scene.compare_devices();
  QuadScene(100, 9, 6, 7).compare_devices();
}

TEST_CASE("temporal quads: few candidates, and none", "[device][oclgrind]") {
  for (const auto& [rows, most] : {std::pair(3, 5), std::pair(2, 0), std::pair(0, 0)})
    QuadScene(rows, most, 7).compare_devices();
}
