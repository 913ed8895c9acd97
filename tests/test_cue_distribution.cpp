#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "evaluation/cues.hpp"
#include "evaluation/matching_observer.hpp"
#include "evaluation/quad_pairs.hpp"
#include "paper_scene.hpp"
#include "pose/pose_constants.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/error.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace paper_scene;

namespace {

std::int64_t in_bin(const Histogram& histogram, double value) {
  return histogram.bins.at(static_cast<std::size_t>((value - histogram.low) / histogram.width()));
}

pose::OrientedPoint random_point(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {{uniform(random), uniform(random), 3 + uniform(random)},
          Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized()};
}

pose::StereoMeasurement measured_as(const pose::OrientedPoint& point) {
  pose::StereoMeasurement result;
  result.ray = point.point / point.point.z();
  result.inverse_depth = 1.0 / point.point.z();
  result.direction = point.tangent;
  return result;
}

}  // namespace

TEST_CASE("A histogram counts every value once, including those out of range", "[matching]") {
  Histogram histogram(0, 1, 4);
  for (const double value : {0.0, 0.1, 0.3, 0.99, 1.0, -0.5, 7.0, std::nan("")}) histogram.add(value);
  CHECK(histogram.bins == std::vector<std::int64_t>{2, 1, 0, 2});
  CHECK(histogram.below == 1);
  CHECK(histogram.above == 1);
  CHECK(histogram.total() == 7);
  Histogram same(0, 1, 4);
  same.add(0.6);
  histogram.add(same);
  CHECK(histogram.total() == 8);
  CHECK(histogram.bins[2] == 1);
  CHECK_THROWS_AS(histogram.add(Histogram(0, 2, 4)), UsageError);
}

TEST_CASE("Pooled cues add up and keep all thresholds", "[matching]") {
  Config narrow, wide;
  narrow.stereo.max_disparity = 20;
  wide.stereo.max_disparity = 60;
  auto sum = make_cues(small_rig(), narrow);
  const auto other = make_cues(small_rig(), wide);
  add(sum, other);
  CHECK(find_cue(sum, CueTable::stereo, 2)->thresholds == std::vector<double>{20, 60});
  CHECK(find_cue(sum, CueTable::stereo, 3)->thresholds.size() == 1);
  CHECK(find_cue(sum, CueTable::stereo, 8) == nullptr);
  std::vector<CueDistribution> none;
  add(none, other);
  CHECK(none.size() == other.size());
}

TEST_CASE("Cues of a hand-made scene are sorted by the ground truth", "[matching]") {
  EdgeSet left, right;
  add_edge(left, 30, 10);                          // true position (20, 10)
  add_edge(left, 70, 40);                          // unpaired: nothing near (60, 40)
  add_edge(right, 20.4F, 10.22F, kSteep + 0.05F);  // 0: veridical for 0
  add_edge(right, 15, 10, kSteep - 0.3F);          // 1: on its line, 5 px off
  add_edge(right, 50, 14);                         // 2: 4 px from its line
  Config config;
  config.stereo.max_disparity = 30;
  MatchingObserver observer(small_rig(), config, {}, true);
  observer.begin(0, plane_truth());
  observer.edges(left, right);
  CandidateLists lists;
  lists.first = {0, 2, 3};
  lists.target = {0, 1, 1};
  observer.stereo_filter(StereoFilter::epipolar_distance, lists);
  observer.stereo_filter(StereoFilter::disparity, lists);
  lists.cue = {100, 300, 150};
  observer.stereo_filter(StereoFilter::orientation, lists);
  lists.cue = {0.9F, 0.45F, 0.95F};
  observer.stereo_filter(StereoFilter::ncc, lists);
  FrameMatching measured = observer.end({});
  REQUIRE(measured.stereo[0].paired.pool == 1);

  const auto& line = *find_cue(measured.cues, CueTable::stereo, 1);
  CHECK(line.veridical.total() == 1);
  CHECK(in_bin(line.veridical, 0.22) == 1);
  // The pairs drawn for edge 0: right edge 1 lies on the line, right edge 2 four pixels off; the veridical edge is not
  // among them.
  CHECK(line.other.total() > kDrawnOthers / 3);
  CHECK(line.other.total() < kDrawnOthers);
  CHECK(in_bin(line.other, 0.01) + in_bin(line.other, 4.01) == line.other.total());
  CHECK(in_bin(line.other, 4.01) > 0);

  const auto& disparity = *find_cue(measured.cues, CueTable::stereo, 2);
  CHECK(in_bin(disparity.veridical, 9.6) == 1);
  CHECK(in_bin(disparity.other, 15.0) == 1);
  CHECK(disparity.other.total() == 1);
  const auto& direction = *find_cue(measured.cues, CueTable::stereo, 3);
  CHECK(in_bin(direction.veridical, 0.05 * 180 / kPi) == 1);
  CHECK(in_bin(direction.other, 0.3 * 180 / kPi) == 1);
  const auto& sift = *find_cue(measured.cues, CueTable::stereo, 4);
  CHECK(in_bin(sift.veridical, 100) == 1);
  CHECK(in_bin(sift.other, 300) == 1);
  CHECK(sift.other.total() == 1);
  const auto& nearly_best = *find_cue(measured.cues, CueTable::stereo, 6);
  CHECK(in_bin(nearly_best.veridical, 0.999) == 1);
  CHECK(in_bin(nearly_best.other, 0.5) == 1);
}

TEST_CASE("Ratios to the best SIFT distance are inverted: the best has 1", "[matching]") {
  CandidateLists lists;
  lists.first = {0, 2};
  lists.target = {0, 1};
  lists.cue = {50, 200};
  TruePositions truth;
  truth.push(5, 5, Visibility::visible, false);
  const Pools pools{{1}, {1}};
  const std::vector<float> x = {5, 9}, y = {5, 5};
  auto cues = make_cues(small_rig(), {});
  CueDistribution& cue = *find_cue(cues, CueTable::stereo, 7);
  collect_ratios(lists, {truth, pools, {}, x, y}, false, cue);
  CHECK(in_bin(cue.veridical, 0.999) == 1);
  CHECK(in_bin(cue.other, 0.25) == 1);
}

TEST_CASE("The measured values of the constraints lead to the constraints' decisions", "[matching]") {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.25);
  const pose::ConstraintLimits limits;
  const double thresholds[] = {limits.length, limits.angle, limits.angle, limits.tangent};
  const double min_angle = pose::kMinAngleDeg;
  std::array<int, 5> passed{};
  for (int n = 0; n < 2000; ++n) {
    pose::OrientedPair previous{random_point(random), random_point(random)};
    if (n % 2 == 0) {  // one nearly straight curve: the tangents are parallel to D
      previous.first.tangent = previous.second.tangent = (previous.second.point - previous.first.point).normalized();
    }
    pose::OrientedPair current = previous;
    for (auto* point : {&current.first, &current.second}) {
      point->point += Eigen::Vector3d(noise(random), noise(random), noise(random));
      point->tangent = (point->tangent + Eigen::Vector3d(noise(random), noise(random), noise(random))).normalized();
    }
    const auto check = pose::check_constraints(previous, current, limits);
    const auto values = constraint_values(previous, current);
    for (std::size_t k = 0; k < 4; ++k) CHECK(check.passed[k] == (values[k] < thresholds[k]));
    CHECK(check.passed[4] == (values[4] > min_angle));
    for (std::size_t k = 0; k < 5; ++k) passed[k] += check.passed[k] ? 1 : 0;
  }
  for (const int count : passed) {  // some pairs fulfil each, others do not
    CHECK(count > 20);
    CHECK(count < 1980);
  }
}

TEST_CASE("Pairs of true quads give the true motion, and wrong quads lower precision and accuracy", "[matching]") {
  std::mt19937 random(3);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(0.05, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.1, -0.02, 0.3);
  pose::QuadObservations quads;
  std::vector<std::size_t> usable;
  std::vector<std::uint8_t> veridical;
  for (std::size_t q = 0; q < 400; ++q) {
    const auto before = random_point(random);
    pose::OrientedPoint now{motion * before.point, motion.linear() * before.tangent};
    const bool wrong = q % 4 == 3;
    if (wrong) now = random_point(random);
    quads.previous.push_back(measured_as(before));
    quads.current.push_back(measured_as(now));
    usable.push_back(q);
    veridical.push_back(wrong ? 0 : 1);
  }
  Config config;
  config.stereo.max_disparity = 30;
  auto cues = make_cues(small_rig(), config);
  const auto measured = measure_pairs(quads, usable, veridical, 1, motion, cues);
  const auto precision = [&](std::size_t order) {
    return static_cast<double>(measured.table[order].veridical) / static_cast<double>(measured.table[order].pairs);
  };
  CHECK(precision(0) == Approx(0.75 * 0.75).margin(0.01));
  CHECK(precision(6) > 0.95);
  for (std::size_t order = 1; order < 5; ++order) {  // a true pair fulfils 1 to 4; 5 depends on its directions
    CHECK(measured.table[order].veridical == measured.table[0].veridical);
    CHECK(measured.table[order].pairs < measured.table[order - 1].pairs);
  }
  CHECK(measured.accuracy[6].rotation_deg < 1e-4);
  CHECK(measured.accuracy[6].translation_m < 1e-5);
  const auto& length = *find_cue(cues, CueTable::constraints, 1);
  CHECK(in_bin(length.veridical, 0.001) == measured.table[0].veridical);
  CHECK(length.other.total() == measured.table[0].pairs - measured.table[0].veridical);

  // If all were wrong, no motion would be near.
  for (auto& after : quads.current) after = measured_as(random_point(random));
  const auto wrong = measure_pairs(quads, usable, std::vector<std::uint8_t>(400, 0), 1, motion, cues);
  CHECK(wrong.table[6].veridical == 0);
  CHECK(wrong.accuracy[0].rotation_deg > 20);
}

TEST_CASE("The error of a motion consists of an angle and a length", "[matching]") {
  Eigen::Isometry3d truth = Eigen::Isometry3d::Identity(), estimate;
  truth.translation() = Eigen::Vector3d(1, 2, 3);
  estimate = truth * Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY());
  estimate.translation() += Eigen::Vector3d(0, 0.03, 0.04);
  const auto error = motion_error(estimate, truth);
  CHECK(error.rotation_deg == Approx(0.01 * 180 / kPi));
  CHECK(error.translation_m == Approx(0.05));
}
