#include "matching.hpp"
#include "reference/temporal_refinement.hpp"
#include "stages/temporal_refinement.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr double kOffset = 5, kDisparity = 6.3;

/// A texture that moves between two frames: what lies at p in the previous images lies at centre + Rot(angle) (p - centre) + move in
/// the current ones; both right images show it kDisparity px further left. One candidate per previous edge, up to 0.8 px wrong.
struct Scene {
  StereoRig rig = flat_rig(97, 81);
  Config config;
  stages::EpipolarGeometry geometry;
  double angle, move_x, move_y;
  Image previous_left, previous_right, current_left, current_right;
  StereoEdges previous, current;
  std::vector<Edge> truth;  ///< of each candidate in the current left image
  reference::Candidates lists;
  reference::CandidateScores left_scores, right_scores;

  Scene(int count, double turn, double dx, double dy, const std::function<double(double, double)>& grey = smooth_grey,
        double wrong_by = 0.8)
      : angle(turn), move_x(dx), move_y(dy) {
    config.stereo.max_disparity = 20;
    geometry = stages::make_epipolar_geometry(rig, config.stereo);
    const auto before = [=](double x, double y) {
      const double u = x - 48 - dx, v = y - 40 - dy;
      return grey(48 + std::cos(turn) * u + std::sin(turn) * v, 40 - std::sin(turn) * u + std::cos(turn) * v);
    };
    previous_left = image_of(97, 81, grey);
    current_left = image_of(97, 81, before);
    previous_right = image_of(97, 81, [=](double x, double y) { return grey(x + kDisparity, y); });
    current_right = image_of(97, 81, [=](double x, double y) { return before(x + kDisparity, y); });
    Random random(31);
    lists.first = {0};
    for (int i = 0; i < count; ++i) {
      const Edge edge{random(30, 70), random(22, 58), random(0.3, kPi - 0.3) * (i % 2 == 0 ? 1 : -1)};
      const double u = edge.x - 48, v = edge.y - 40;
      const Edge now{48 + std::cos(turn) * u - std::sin(turn) * v + dx, 40 + std::sin(turn) * u + std::cos(turn) * v + dy,
                     std::remainder(edge.direction + turn, 2 * kPi)};
      truth.push_back(now);
      add(previous, edge, 0);
      add(current, {now.x + random(-wrong_by, wrong_by), now.y + random(-wrong_by, wrong_by), now.direction}, random(-wrong_by, wrong_by));
      lists.target.push_back(i);
      lists.first.push_back(i + 1);
    }
    left_scores = right_scores = fresh_scores(static_cast<std::size_t>(count));
    for (std::size_t i = 0; i < left_scores.pairing.size(); ++i) {
      left_scores.pairing[i] = i % 2;
      right_scores.pairing[i] = i / 2 % 2;
    }
  }
  static void add(StereoEdges& edges, const Edge& left, double right_error) {
    edges.left_index.push_back(static_cast<std::int32_t>(edges.size()));
    edges.right_index.push_back(edges.left_index.back());
    edges.left_x.push_back(static_cast<float>(left.x));
    edges.left_y.push_back(static_cast<float>(left.y));
    edges.right_x.push_back(static_cast<float>(left.x - kDisparity + right_error));
    edges.right_y.push_back(static_cast<float>(left.y));
    edges.left_direction.push_back(static_cast<float>(left.direction));
    edges.right_direction.push_back(static_cast<float>(left.direction));
    edges.ncc.push_back(0.9f);
  }
  TemporalMatches match(reference::CandidateScores& scores, std::vector<reference::RefinedPlace>* refined = nullptr) const {
    const auto agreement = reference::temporal_agreement(lists, scores, lists, right_scores);
    const auto places = reference::temporal_refinement({previous_left.view(), previous_right.view()}, {current_left.view(), current_right.view()},
                                                       previous, current, geometry, lists, agreement, config.temporal, kOffset, scores);
    if (refined != nullptr) *refined = places;
    return reference::temporal_clusters(lists, scores, agreement, places, current, config.temporal);
  }
  static void fill(opencl::Context& context, const StereoEdges& edges, stages::DeviceStereoEdges& device) {
    device.count = device.stride = static_cast<int>(edges.size());
    std::vector<float> packed;
    for (const auto* block : {&edges.left_x, &edges.left_y, &edges.left_direction, &edges.right_x, &edges.right_y, &edges.right_direction}) {
      packed.insert(packed.end(), block->begin(), block->end());
    }
    device.packed.write(context, packed);
  }
  /// Every device and variant: the same quads but for `band` rows whose decisions lie within rounding of a limit; places to 1e-2 px.
  void compare_devices(std::size_t band = 0) const {
    auto scores = left_scores;
    const auto truth_matches = match(scores);
    for_each_variant("temporal_refinement", [&](opencl::Context& context, const Variants& variants, const std::string& name) {
      INFO(name);
      stages::DeviceRig before, now;
      before.left = upload(context, previous_left);
      before.right = upload(context, previous_right);
      now.left = upload(context, current_left);
      now.right = upload(context, current_right);
      fill(context, previous, before.edges);
      fill(context, current, now.edges);
      auto left = upload(context, lists), right = upload(context, lists);
      upload(context, left_scores, left);
      upload(context, right_scores, right);
      opencl::Buffer<cl_float> packed;
      packed.write(context, geometry.packed());
      stages::TemporalRefinement stage(context, config.temporal, kOffset, variants);
      stage.agree(left, right);
      stage.refine(before, now, 1, packed, left);
      const auto found = stage.collect(now, 1, left);
      std::size_t same = 0, j = 0;
      for (std::size_t i = 0; i < truth_matches.size(); ++i) {
        while (j < found.size() && found.previous[j] < truth_matches.previous[i]) ++j;
        if (j == found.size() || found.previous[j] != truth_matches.previous[i] || found.current[j] != truth_matches.current[i] ||
            found.rivals[j] != truth_matches.rivals[i]) {
          continue;
        }
        ++same;
        CHECK(found.left_x[j] == Approx(truth_matches.left_x[i]).margin(1e-2).epsilon(0));
        CHECK(found.left_y[j] == Approx(truth_matches.left_y[i]).margin(1e-2).epsilon(0));
        CHECK(found.right_x[j] == Approx(truth_matches.right_x[i]).margin(1e-2).epsilon(0));
        CHECK(found.right_y[j] == Approx(truth_matches.right_y[i]).margin(1e-2).epsilon(0));
        CHECK(found.ncc[j] == truth_matches.ncc[i]);
      }
      CHECK(same + band >= truth_matches.size());
      CHECK(same + band >= found.size());
    });
  }
};

}  // namespace

TEST_CASE("temporal agreement: a candidate needs its counterpart alive in the other list", "[temporal][matching]") {
  // Row 0: targets 4, 7, 9 left; 9, 4, 7 right, where 7 is dead. Row 1: target 4 left, which only row 0 has on the right.
  const reference::Candidates left{{0, 3, 4}, {4, 7, 9, 4}}, right{{0, 3, 4}, {9, 4, 7, 5}};
  auto scores = fresh_scores(4), other = fresh_scores(4);
  scores.rejected_by[2] = 5;
  other.rejected_by[2] = 3;
  other.ncc = {0.5f, 0.7f, 0.6f, 0.8f};
  other.pairing = {0, 1, 0, 0};
  const auto agreement = reference::temporal_agreement(left, scores, right, other);
  CHECK(scores.rejected_by == std::vector<std::uint8_t>{0, reference::kAgreementOrder, 5, reference::kAgreementOrder});
  CHECK(agreement.score[0] == Approx(0.8));
  CHECK(agreement.right_pairing[0] == 1);
}

TEST_CASE("temporal refinement: a known move is found in both images, also when the camera rolls", "[temporal][matching]") {
  for (const double turn : {0.0, 0.08}) {
    Scene scene(120, turn, 3.37, -1.71);
    scene.config.temporal.refine_prior = 100;  // what the texture alone says
    auto scores = scene.left_scores;
    std::vector<reference::RefinedPlace> places;
    scene.match(scores, &places);
    std::vector<double> left_x, left_y, right_x;
    for (std::size_t c = 0; c < places.size(); ++c) {
      if (scores.rejected_by[c] != 0) continue;
      left_x.push_back(places[c].left_x - scene.truth[c].x);
      left_y.push_back(places[c].left_y - scene.truth[c].y);
      right_x.push_back(places[c].left_x - places[c].right_x - kDisparity);
      CHECK(places[c].right_y == Approx(places[c].left_y).margin(1e-4));  // on its epipolar line
    }
    CHECK(left_x.size() >= 110);
    for (const auto& errors : {left_x, left_y, right_x}) {
      double squares = 0, sum = 0;
      for (const double error : errors) {
        squares += error * error;
        sum += error;
      }
      const auto count = static_cast<double>(errors.size());
      CHECK(std::sqrt(squares / count) < 0.04);  // two unknowns, slopes of one direction prevail: twice the error along a line, and more
      CHECK(std::abs(sum) / count < 0.01);
    }
  }
}

TEST_CASE("temporal refinement: the prior holds a point on a straight edge", "[temporal][matching]") {
  // Grey levels change along x only: nothing says where along y the point lies.
  const auto stripes = [](double x, double) { return 128 + 70 * std::sin(0.45 * x); };
  for (const double noise : {2.0, 8.0}) {
    Scene scene(60, 0, 1.3, 0, stripes, 0.5);
    scene.config.temporal.refine_noise = noise;
    auto scores = scene.left_scores;
    std::vector<reference::RefinedPlace> places;
    scene.match(scores, &places);
    int alive = 0;
    for (std::size_t c = 0; c < places.size(); ++c) {
      if (scores.rejected_by[c] != 0) continue;
      ++alive;
      CHECK(std::abs(places[c].left_x - scene.truth[c].x) < 0.25);                                  // refined
      CHECK(std::abs(places[c].left_y - static_cast<double>(scene.current.left_y[c])) < 0.02);      // held
    }
    CHECK(alive > 50);
  }
}

TEST_CASE("temporal refinement: what is too far or unlike is rejected", "[temporal][matching]") {
  Scene scene(40, 0, 2, 1);
  for (std::size_t i = 0; i < 40; i += 2) scene.current.left_x[i] += 4;
  auto scores = scene.left_scores;
  const auto matches = scene.match(scores);
  CHECK(matches.size() >= 15);
  for (const auto row : matches.previous) CHECK(row % 2 == 1);
}

TEST_CASE("temporal clusters: chained places are one, others are rivals, ties go to the first", "[temporal][matching]") {
  StereoEdges current;
  for (const double degrees : {10, 12, 15, 40, 10, 179}) Scene::add(current, {0, 0, degrees * kDegree}, 0);
  const std::vector<reference::RefinedPlace> places = {{5, 5, 1, 5}, {6.4, 5, 2.4, 5}, {5.7, 5.4, 1.7, 5.4}, {5.1, 5, 1, 5}, {9, 9, 5, 9}};
  const reference::Candidates lists{{0, 5, 5}, {0, 1, 2, 3, 4}};
  auto scores = fresh_scores(5);
  reference::Agreement agreement{{0.9f, 0.8f, 0.85f, 0.9f, 0.7f}, std::vector<std::uint8_t>(5, 0)};
  TemporalConfig config;
  auto matches = reference::temporal_clusters(lists, scores, agreement, places, current, config);
  // 0, 2, 1 chain up; 3 is near them but turned by 25 degrees or more; 4 is far.
  REQUIRE(matches.size() == 1);
  CHECK(matches.previous[0] == 0);
  CHECK(matches.current[0] == 0);
  CHECK(matches.rivals[0] == 2);
  CHECK(matches.left_x[0] == Approx((5 + 6.4 + 5.7) / 3));
  CHECK(matches.right_y[0] == Approx((5 + 5 + 5.4) / 3));
  CHECK(matches.ncc[0] == 0.9f);
  scores.rejected_by[2] = 8;  // the link is gone: four clusters
  matches = reference::temporal_clusters(lists, scores, agreement, places, current, config);
  CHECK(matches.rivals[0] == 3);
  CHECK(matches.left_x[0] == 5.0f);
  matches = reference::temporal_clusters(lists, scores, agreement, places, current, config, 8);
  CHECK(matches.previous[0] == 0);
}

TEST_CASE("temporal refinement: devices agree with the reference", "[temporal][matching][device]") {
  Scene scene(150, 0.05, 2.2, -1.1);
  scene.left_scores.rejected_by[2] = 4;
  scene.right_scores.rejected_by[5] = 3;
  scene.compare_devices(1);
  // Rows with several candidates: clusters and rivals.
  Scene crowd(150, 0, 1.5, 0.5);
  crowd.lists = {{0}, {}};
  for (int row = 0; row < 150; ++row) {
    for (const int neighbour : {0, 1, 2}) {
      const auto from = static_cast<std::size_t>(row), to = static_cast<std::size_t>((row + neighbour) % 150);
      if (neighbour > 0) {  // a copy of the true candidate nearby, or 1.5 px away
        crowd.current.left_x[to] = crowd.current.left_x[from] + (neighbour == 1 ? 0.4f : 1.5f);
        crowd.current.left_y[to] = crowd.current.left_y[from];
      }
      crowd.lists.target.push_back(static_cast<std::int32_t>(to));
    }
    crowd.lists.first.push_back(static_cast<std::int32_t>(crowd.lists.target.size()));
  }
  crowd.left_scores = crowd.right_scores = fresh_scores(crowd.lists.target.size());
  for (std::size_t c = 0; c < crowd.left_scores.ncc.size(); ++c) crowd.left_scores.ncc[c] = 0.8f + 0.001f * static_cast<float>(c * 37 % 100);
  crowd.compare_devices(3);
}

TEST_CASE("temporal refinement: few candidates, and none", "[temporal][matching][device][oclgrind]") {
  Scene(2, 0.05, 2.2, -1.1).compare_devices();
  Scene(0, 0, 0, 0).compare_devices();
}
