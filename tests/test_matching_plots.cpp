#include <catch2/catch.hpp>
#include <cmath>
#include <sstream>

#include "markup.hpp"
#include "paper_scene.hpp"
#include "report/matching_plots.hpp"
#include "report/statistics.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace quadedge::report;

namespace {

/// Positions of a path "M1 2L3 4" within its plot.
std::vector<std::pair<double, double>> points_of(std::string path) {
  for (char& c : path) {
    if (c == 'M' || c == 'L') c = ' ';
  }
  std::istringstream stream(path);
  std::vector<std::pair<double, double>> points;
  for (double x = 0, y = 0; stream >> x >> y;) points.emplace_back(x, y);
  return points;
}

std::vector<std::string> curves(const std::string& svg) {
  return all_matches(svg, "<path d=\"([^\"]+)\" fill=\"none\"");
}

MatchingResult sequence(int frames) {
  MatchingResult result;
  result.name = "sequence";
  result.frames.resize(static_cast<std::size_t>(frames));
  for (int f = 0; f < frames; ++f) {
    auto& frame = result.frames[static_cast<std::size_t>(f)];
    frame.counts.edges_left = 1000 + f;
    frame.counts.edges_right = 1100;
    frame.counts.stereo_edges = 500;
    if (f == 0) continue;
    frame.counts.temporal_left = 300;
    frame.counts.temporal_right = 290;
    frame.counts.quads = 200;
    TemporalMatching& temporal = frame.temporal.emplace();
    for (std::size_t order = 0; order < kConstraintNames.size(); ++order) {
      temporal.pairs.table[order] = {1000, 500 + 10 * f};
      temporal.pairs.accuracy[order] = {1.0 / f, 0.01 / f};
    }
    frame.motion = MotionError{0.1 / f, 0.001 / f};
  }
  return result;
}

}  // namespace

TEST_CASE("A cumulative curve climbs where the values are, and stays low where they lie beyond", "[report]") {
  Config config;
  config.stereo.max_disparity = 30;
  auto cues = make_cues(paper_scene::small_rig(), config);
  CueDistribution& cue = *find_cue(cues, CueTable::stereo, 3);  // directions: 10 deg
  for (int i = 0; i < 100; ++i) {
    cue.veridical.add(4.2);
    cue.other.add(i < 25 ? 12.0 : 89.0);
  }
  const auto svgs = cue_plots(cue);
  REQUIRE(svgs.size() == 2);
  for (const auto& svg : svgs) {
    CHECK(is_well_formed(svg));
    CHECK(svg.find("\u2264 10") != std::string::npos);
    CHECK(svg.find("difference of directions [deg]") != std::string::npos);
  }
  CHECK(svgs[0].find("density [1/deg]") != std::string::npos);
  const auto lines = curves(svgs[1]);
  REQUIRE(lines.size() == 2);
  const auto veridical = points_of(lines[0]), other = points_of(lines[1]);
  const double zero = veridical.front().second,
               full = veridical.back().second;  // of 0 and of 100 % on the way down the picture
  CHECK(zero > full);
  CHECK(other.front().second == Approx(zero));
  CHECK(other.back().second == Approx(zero + 0.25 * (full - zero)).margin(0.05));  // 89 deg is beyond what is shown
  for (std::size_t i = 1; i < other.size(); ++i) CHECK(other[i].second <= other[i - 1].second);
}

TEST_CASE("A density has the area one", "[report]") {
  Config config;
  config.stereo.sift_max = 500;
  auto cues = make_cues(paper_scene::small_rig(), config);
  CueDistribution& cue = *find_cue(cues, CueTable::stereo, 4);  // SIFT
  for (int i = 0; i < 1000; ++i) {
    cue.veridical.add(100 + 0.2 * i);
    cue.other.add(300 + 0.2 * i);
  }
  const auto lines = curves(cue_plots(cue)[0]);
  REQUIRE(lines.size() == 2);
  const auto area = [&](const std::string& line) {
    const auto points = points_of(line);
    const double floor = points.front().second;
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      sum += (points[i].first - points[i - 1].first) * (floor - 0.5 * (points[i].second + points[i - 1].second));
    }
    return sum;
  };
  CHECK(area(lines[0]) > 100);
  CHECK(area(lines[0]) == Approx(area(lines[1])).epsilon(0.01));
}

TEST_CASE("Counts have a bar per frame, or bins where there are many frames", "[report]") {
  const auto bars = [](const std::string& svg) {
    return all_matches(svg, "(<rect x=\"[^\"]+\" y=\"[^\"]+\" width=\"[^\"]+\" height=\"[^\"]+\" fill=\"#)").size();
  };
  const auto few = count_plots({sequence(5)});
  REQUIRE(few.size() == 4);
  for (const auto& svg : few) CHECK(is_well_formed(svg));
  CHECK(bars(few[0]) == 10);  // left and right
  CHECK(bars(few[1]) == 5);
  CHECK(bars(few[2]) == 8);  // the first frame has no matches in time
  CHECK(bars(few[3]) == 4);
  // 60 frames: 1000 to 1059 left edges in bins of 5 from 1000 on, always 1100 right ones.
  const auto many = count_plots({sequence(60)});
  CHECK(is_well_formed(many[0]));
  CHECK(many[0].find(">frames<") != std::string::npos);
  CHECK(bars(many[0]) == 2 * 21);
  const auto heights = all_matches(many[0], "height=\"([^\"]+)\" fill=\"#");
  const double of_five = std::stod(heights[0]);
  CHECK(of_five > 1);
  for (std::size_t bin = 0; bin < 21; ++bin) {
    CHECK(std::stod(heights[2 * bin]) == Approx(bin < 12 ? of_five : 0).margin(0.05));
    CHECK(std::stod(heights[2 * bin + 1]) == Approx(bin == 20 ? 12 * of_five : 0).margin(0.1));
  }
  MatchingResult pair = sequence(1);
  CHECK(count_plots({pair}).size() == 2);
}

TEST_CASE("Precision and accuracy that go together have a rank correlation of minus one", "[report]") {
  const auto plots = accuracy_plots({sequence(6)});
  CHECK(plots.points == 5 * 7);
  CHECK(plots.rotation_correlation == Approx(-1));
  CHECK(plots.translation_correlation == Approx(-1));
  CHECK(plots.svgs.size() == 4);
  for (const auto& svg : plots.svgs) CHECK(is_well_formed(svg));
  CHECK(all_matches(plots.svgs[0], "(<circle cx=\"[^\"]+\" cy=\"[^\"]+\" r=\"3\"/>)").size() == 35);
  CHECK(accuracy_plots({sequence(1)}).points == 0);
}

TEST_CASE("Rank correlation", "[report]") {
  CHECK(rank_correlation({1, 2, 3, 4}, {10, 20, 25, 1000}) == Approx(1));
  CHECK(rank_correlation({1, 2, 3, 4}, {9, 7, 5, -100}) == Approx(-1));
  // Ranks 1, 2.5, 2.5, 4, 5 and 3, 1.5, 4, 1.5, 5; minus the mean of 3: products 0 + 0.75 - 0.5 - 1.5 + 4, squares 9.5
  // and 9.5.
  CHECK(rank_correlation({1, 2, 2, 5, 7}, {3, 1, 4, 1, 5}) == Approx(2.75 / 9.5));
  CHECK(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3})));
  CHECK(std::isnan(rank_correlation({1, 2}, {1, 2})));
}
