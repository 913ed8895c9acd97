#include <catch2/catch.hpp>
#include <cmath>

#include "evaluation/matching_observer.hpp"
#include "paper_scene.hpp"
#include "quadedge/error.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace paper_scene;

// LONG: one scene with all its checks.
TEST_CASE("A hand-made scene has the recall, precision and ambiguity calculated by hand", "[matching]") {
  EdgeSet left, right;
  add_edge(left, 30, 10);     // 0: counterpart 0 (and the near duplicate 1)
  add_edge(left, 40, 20);     // 1: counterpart 2
  add_edge(left, 50, 30);     // 2: no right edge near the true position (40, 30)
  add_edge(left, 90, 40);     // 3: unknown disparity
  add_edge(left, 60, 50, 0);  // 4: lies along its epipolar line
  add_edge(left, 5, 50);      // 5: its true position is outside the right image
  add_edge(left, 70,
           30);  // 6: its right edge is within a pixel of the true position, but too far from the epipolar line
  add_edge(right, 20.4F, 10);  // 0
  add_edge(right, 20.9F, 10);  // 1
  add_edge(right, 30, 20.3F);  // 2
  add_edge(right, 45, 30);     // 3: five pixels from the true position of edge 2
  add_edge(right, 60, 30.8F);  // 4
  Config config;
  MatchingObserver observer(small_rig(), config, {});
  observer.begin(0, plane_truth());
  observer.edges(left, right);
  // 0: two true candidates and a false one; 1: a true one; 2: a false one; 3, 4: candidates that must not count; 5: a
  // false one.
  CandidateLists lists;
  lists.first = {0, 3, 4, 5, 6, 7, 8, 8};
  lists.target = {0, 1, 3, 2, 3, 0, 0, 2};
  observer.stereo_filter(StereoFilter::epipolar_distance, lists);
  // Edge 0 keeps one true candidate, edge 1 loses its only one, edge 2 gets a true refined position, and edge 5 one
  // that would be true if it were visible.
  CandidateLists refined;
  refined.first = {0, 1, 1, 2, 2, 2, 3, 3};
  refined.target = {1, 3, 2};
  refined.x = {20.1F, 40.5F, -5};
  refined.y = {10, 30, 50};
  observer.stereo_filter(StereoFilter::disparity, refined);
  const FrameMatching measured = observer.end({});

  REQUIRE(measured.stereo.size() == 3);
  CHECK(measured.census.edges == 7);
  CHECK(measured.census.no_statement == 1);
  CHECK(measured.census.along_line == 1);
  CHECK(measured.census.occluded == 1);
  // Pools: paired = {0, 1}, all = {0, 1, 2, 5, 6}.
  const auto& baseline = measured.stereo[0];
  CHECK(baseline.paired.pool == 2);
  CHECK(baseline.paired.recall() == 1.0);
  CHECK(baseline.paired.precision() == Approx(3.0 / 10));
  CHECK(baseline.paired.ambiguity_mean() == 4.0);
  CHECK(baseline.all.pool == 5);
  CHECK(baseline.all.recall() == Approx(3.0 / 5));
  CHECK(baseline.all.precision() == Approx(4.0 / 25));
  const auto& first = measured.stereo[1];
  CHECK(first.paired.recall() == 1.0);
  CHECK(first.paired.precision() == Approx(3.0 / 4));
  CHECK(first.paired.ambiguity_mean() == Approx(1.0));
  CHECK(first.paired.ambiguity_max() == 2.0);
  CHECK(first.all.recall() == Approx(2.0 / 5));
  CHECK(first.all.precision() == Approx(3.0 / 6));
  CHECK(first.all.ambiguity_mean() == Approx(0.5));
  const auto& second = measured.stereo[2];
  CHECK(second.paired.recall() == 0.5);
  CHECK(second.paired.precision() == 1.0);
  CHECK(second.paired.ambiguity_mean() == 0.0);
  CHECK(second.all.recall() == Approx(2.0 / 5));
  CHECK(second.all.candidates == 3);
  CHECK(second.all.precision() == Approx(2.0 / 3));
}

TEST_CASE("The error of a final stereo edge is its disparity error and the component of it across the edge",
          "[matching]") {
  EdgeSet left, right;
  add_edge(left, 30, 10);
  add_edge(right, 20, 10);
  StereoEdges edges;
  edges.left_index = edges.right_index = {0};
  edges.left_x = {30};
  edges.left_y = {10};
  edges.left_direction = {kSteep};
  edges.right_x = {19.5F};
  edges.right_y = {10};
  edges.right_direction = {0.5F};
  edges.ncc = {1};
  MatchingObserver observer(small_rig(), {}, {});
  observer.begin(0, plane_truth());
  observer.edges(left, right);
  observer.stereo(edges);
  const FrameMatching measured = observer.end({});
  REQUIRE(measured.disparity_error.size() == 1);
  CHECK(measured.disparity_error[0] == Approx(0.5));  // disparity 10.5 instead of 10
  CHECK(measured.across_error[0] == Approx(0.5 * std::sin(0.5)));
}

TEST_CASE("Pooled tables add up counts, not percentages, and give the spread over the frames", "[matching]") {
  FilterCounts small, large;
  small.add_edge(1, 1);  // one edge, found
  for (int i = 0; i < 3; ++i) large.add_edge(2, i == 0 ? 1 : 0);
  MatchingResult result{"two frames", std::vector<FrameMatching>(2), {}, {}};
  result.frames[0].stereo = {{0, "baseline", small, small}};
  result.frames[1].stereo = {{0, "baseline", large, large}};
  result.frames[0].disparity_error = {-0.1F, 0.2F};
  result.frames[1].disparity_error = {0.4F};
  const auto summary = summarise({result});
  REQUIRE(summary.stereo.size() == 1);
  CHECK(summary.stereo[0].row.paired.recall() == Approx(2.0 / 4));
  CHECK(summary.stereo[0].row.paired.precision() == Approx(2.0 / 7));
  CHECK(summary.stereo[0].row.paired.ambiguity_max() == 1.0);
  CHECK(summary.stereo[0].paired_std.recall == Approx((1.0 - 1.0 / 3) / 2));
  CHECK(summary.disparity_median == Approx(0.2));
  CHECK(summary.disparity_bias == Approx(0.2));
  FilterTable one = {{0, "baseline", small, small}}, two = {{0, "baseline", small, small}, {1, "next", small, small}};
  CHECK_THROWS_AS(add(one, two), UsageError);
}
