#include <map>

#include "evaluation/matching_observer.hpp"
#include "frontends.hpp"
#include "paper_scene.hpp"
#include "quadedge/odometry.hpp"

using namespace quadedge;
using namespace quadedge::evaluation;
using namespace paper_scene;

namespace {

/// A stereo edge with the given left and right points.
void add_stereo(StereoEdges& edges, float left_x, float y, float right_x) {
  edges.left_index.push_back(static_cast<std::int32_t>(edges.left_index.size()));
  edges.right_index.push_back(edges.left_index.back());
  edges.left_x.push_back(left_x);
  edges.right_x.push_back(right_x);
  for (auto* list : {&edges.left_y, &edges.right_y}) list->push_back(y);
  for (auto* list : {&edges.left_direction, &edges.right_direction}) list->push_back(kSteep);
  edges.ncc.push_back(1);
}

/// The edges that the stereo edges consist of.
std::pair<EdgeSet, EdgeSet> images_of(const StereoEdges& stereo) {
  std::pair<EdgeSet, EdgeSet> sets;
  for (std::size_t i = 0; i < stereo.size(); ++i) {
    add_edge(sets.first, stereo.left_x[i], stereo.left_y[i]);
    add_edge(sets.second, stereo.right_x[i], stereo.right_y[i]);
  }
  return sets;
}

/// The plane 1 m away, seen from `x` m farther right.
FrameTruth plane_from(double x) {
  FrameTruth truth = plane_truth();
  truth.depth_scale = 10;  // focal length 100 px, baseline 0.1 m
  truth.right_is_measured = true;
  truth.world_from_left = Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0));
  return truth;
}

/// One match per row: stereo edge `first + k` of the base with the k-th of `targets`.
CandidateLists rows_of(const std::vector<std::int32_t>& targets) {
  CandidateLists lists;
  lists.target = targets;
  for (std::size_t row = 0; row <= targets.size(); ++row) lists.first.push_back(static_cast<std::int32_t>(row));
  return lists;
}

TemporalMatches matches_of(const std::vector<std::int32_t>& targets, const StereoEdges& now) {
  TemporalMatches matches;
  for (std::size_t row = 0; row < targets.size(); ++row)
    matches.append(static_cast<std::int32_t>(row), targets[row], now, 1, 0);
  return matches;
}

/// Shows the observer a frame of the plane seen from `x` m, up to its stereo edges.
void show(MatchingObserver& observer, int frame, double x, const StereoEdges& edges) {
  observer.begin(frame, plane_from(x));
  const auto [left, right] = images_of(edges);
  observer.edges(left, right);
  observer.stereo(edges);
}

/// Shows a search that finds `targets`, one per stereo edge of the base.
void show_search(MatchingObserver& observer, int number, int base_frame, const StereoEdges& base,
                 const std::vector<std::int32_t>& targets, const StereoEdges& now, int step = 1) {
  const EdgePositions expected{base.left_x, base.left_y, base.left_direction};
  observer.temporal_search({number, base_frame, expected, expected, 30, step});
  for (const Side side : kSides) observer.temporal_filter(TemporalFilter::displacement, side, rows_of(targets));
  TemporalMatches matches = matches_of(targets, now);
  matches.search = number;
  observer.quads(matches);
}

FrameResult found(FrameStatus status, int search, int reference_frame, double x) {
  FrameResult result;
  result.status = status;
  result.diagnostics.search = search;
  result.reference_frame = reference_frame;
  result.world_from_left = Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0));
  return result;
}

}  // namespace

// LONG: one pair of frames with all its checks.
TEST_CASE("Two hand-made frames have the temporal recall, precision and ambiguity calculated by hand", "[matching]") {
  // The rig moves by 0.05 m: everything shifts 5 px to the left in both images.
  StereoEdges before, now;
  add_stereo(before, 30, 10, 20);  // 0: goes to 0
  add_stereo(before, 40, 20, 30);  // 1: goes to 1
  add_stereo(before, 50, 30, 40);  // 2: nothing within a pixel of (45, 30)
  add_stereo(before, 60, 40, 55);  // 3: a wrong stereo edge; its left point's true position is still known
  add_stereo(now, 25, 10, 15);
  add_stereo(now, 35, 20, 25);
  add_stereo(now, 48, 30, 38);
  add_stereo(now, 55, 40, 45);
  Config config;
  config.stereo.max_disparity = 30;
  MatchingObserver observer(small_rig(), config, {});
  FrameResult result;
  observer.begin(0, plane_from(0));
  observer.edges(images_of(before).first, images_of(before).second);
  observer.stereo(before);
  const FrameMatching first = observer.end(result);
  CHECK_FALSE(first.temporal);
  CHECK(first.classes == MatchClassCounts{3, 1, 0, 0});

  observer.begin(1, plane_from(0.05));
  observer.edges(images_of(now).first, images_of(now).second);
  observer.stereo(now);
  const EdgePositions expected{{30, 40, 50, 60}, {10, 20, 30, 40}, {kSteep, kSteep, kSteep, kSteep}};
  observer.temporal_search({0, 0, expected, expected, 30, 1});
  CandidateLists lists;
  lists.first = {0, 2, 3, 4, 5};
  lists.target = {0, 2, 2, 2, 3};  // 0: the true one and a false one; 1 and 2: a false one; 3: the true one
  observer.temporal_filter(TemporalFilter::displacement, Side::left, lists);
  lists.first = {0, 1, 2, 3, 4};
  lists.target = {0, 1, 2, 3};
  observer.temporal_filter(TemporalFilter::displacement, Side::right, lists);
  TemporalMatches matches;
  matches.previous = {0, 1, 3};
  matches.current = {0, 2, 3};
  matches.left_x = {25.2F, 48, 55};
  matches.right_x = {15.1F, 38, 45};
  matches.left_y = matches.right_y = {10, 30, 40};
  matches.ncc = {1, 1, 1};
  matches.competing_clusters = {3, 1, 5};
  observer.quads(matches);
  result.status = FrameStatus::tracked;
  result.diagnostics.search = 0;
  result.world_from_left = Eigen::Isometry3d(Eigen::Translation3d(0.053, 0, 0));
  const FrameMatching second = observer.end(result);

  // Pools: paired = {0, 1}, all = {0, 1, 2, 3}.
  REQUIRE(second.temporal);
  REQUIRE(second.temporal->left.size() == 3);
  const auto& baseline = second.temporal->left[0];
  CHECK(baseline.paired.pool == 2);
  CHECK(baseline.paired.recall() == 1.0);
  CHECK(baseline.paired.precision() == Approx(2.0 / 8));
  CHECK(baseline.all.pool == 4);
  CHECK(baseline.all.recall() == Approx(3.0 / 4));
  const auto& left = second.temporal->left[1];
  CHECK(left.paired.recall() == 0.5);
  CHECK(left.paired.precision() == Approx(1.0 / 3));
  CHECK(left.paired.ambiguity_mean() == Approx(0.5));
  CHECK(left.all.recall() == Approx(2.0 / 4));
  CHECK(left.all.precision() == Approx(2.0 / 5));
  const auto& right = second.temporal->right[1];
  CHECK(right.paired.recall() == 1.0);
  CHECK(right.paired.precision() == 1.0);
  CHECK(right.all.precision() == Approx(3.0 / 4));
  CHECK(second.temporal->quads_paired.pool == 2);
  CHECK(second.temporal->quads_paired.recall() == 0.5);
  CHECK(second.temporal->quads_paired.precision() == 0.5);
  CHECK(second.temporal->quads_all.pool == 4);
  CHECK(second.temporal->quads_all.recall() == 0.5);
  CHECK(second.temporal->quads_all.precision() == Approx(2.0 / 3));
  MatchingResult sequence{"paper", {first, second}, {}, {}};
  CHECK(summarise({sequence}).quads_paired.ambiguity_mean == Approx((3 + 1) / 2.0));
  // Pairs are drawn from the quads 0, 1 and 3; one of three pairs consists of true quads.
  const auto& pairs = second.temporal->pairs.table[0];
  CHECK(static_cast<double>(pairs.veridical) / static_cast<double>(pairs.pairs) == Approx(1.0 / 3).margin(0.01));
  REQUIRE(second.motion);
  CHECK(second.motion->translation_m == Approx(0.003));
  CHECK(second.motion->rotation_deg == Approx(0).margin(1e-9));
}

TEST_CASE("After a loss the observer evaluates only the search against the frame that the pipeline relocalised against",
          "[matching]") {
  // Frame 0 has three stereo edges, frame 1 (lost) the same in another order and one more, frame 2 those of frame 1.
  // The rig moves by 0.05 m = 5 px per frame.
  StereoEdges zero, one, two;
  for (const float x : {30.0F, 40.0F, 50.0F}) add_stereo(zero, x, 10 + x / 5, x - 10);
  for (const float x : {50.0F, 30.0F, 60.0F, 40.0F}) add_stereo(one, x - 5, 10 + x / 5, x - 15);
  for (const float x : {50.0F, 30.0F, 60.0F, 40.0F}) add_stereo(two, x - 10, 10 + x / 5, x - 20);
  MatchingObserver observer(small_rig(), {}, {});
  show(observer, 0, 0, zero);
  observer.end(found(FrameStatus::first, -1, 0, 0));

  show(observer, 1, 0.05, one);
  show_search(observer, 0, 0, zero, {1, 3, 0}, one);  // true, but gave no motion
  const auto lost = observer.end(found(FrameStatus::lost_no_consensus, -1, 0, 0.3));
  CHECK_FALSE(lost.temporal);
  CHECK_FALSE(lost.motion);

  show(observer, 2, 0.1, two);
  show_search(observer, 0, 0, zero, {0, 0, 0}, two);    // all wrong, with another base
  show_search(observer, 1, 1, one, {0, 1, 2, 3}, two);  // all true: gives the motion
  show_search(observer, 2, 1, one, {3, 2, 1, 0}, two);  // tried afterwards
  show_search(observer, 3, 1, one, {0, 1}, two, 2);     // a subset of the edges
  const auto relocalised = observer.end(found(FrameStatus::tracked, 1, 1, 0.352));
  REQUIRE(relocalised.temporal);
  CHECK(relocalised.temporal->quads_paired.pool == 4);
  CHECK(relocalised.temporal->quads_paired.recall() == 1);
  CHECK(relocalised.temporal->quads_paired.precision() == 1);
  for (const auto* table : {&relocalised.temporal->left, &relocalised.temporal->right}) {
    REQUIRE(table->size() == 3);
    CHECK((*table)[1].paired.precision() == 1);
    CHECK((*table)[1].paired.recall() == 1);
  }
  REQUIRE(relocalised.motion);  // since frame 1, from the pipeline's poses of both
  CHECK(relocalised.motion->translation_m == Approx(0.002));

  // The pipeline may choose a search before the last one, even if the last one was against an older frame.
  show(observer, 3, 0.1, two);
  show_search(observer, 0, 2, two, {0, 1, 2, 3}, two);
  show_search(observer, 1, 1, one, {1, 0, 3, 2}, two);
  const auto older = observer.end(found(FrameStatus::tracked, 1, 1, 0.352));
  REQUIRE(older.temporal);
  CHECK(older.temporal->quads_all.pool == 4);
  CHECK(older.temporal->quads_all.precision() == 0);
}

namespace {

/// The searches of the last frame and what each found.
class Searches : public Tap {
 public:
  void edges(const EdgeSet&, const EdgeSet&) override {
    observed.clear();
    found.clear();
    for (auto& rows : alive) rows.clear();
  }
  void temporal_search(const ObservedSearch& search) override { observed.push_back(search); }
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& lists) override {
    if (filter != TemporalFilter::nearly_best_sift) return;
    int rows = 0;
    for (std::size_t row = 0; row + 1 < lists.first.size(); ++row) rows += lists.first[row] < lists.first[row + 1];
    alive[index_of(side)].push_back(rows);
  }
  void quads(const TemporalMatches& matches) override { found.push_back(matches); }

  std::vector<ObservedSearch> observed;
  std::vector<TemporalMatches> found;  ///< one per search
  std::vector<int> alive[2];           ///< per side and search: edges with a candidate before the agreement
};

/// Two frames of the cables, then four of the room: tracking is lost in between and resumes from the lost frame.
std::vector<FrameResult> track_with_loss(const std::string& device_name, Tap* tap,
                                         const std::function<void(const FrameResult&, const FrameDetails&)>& visit) {
  static const matching::RenderedScene before("cables", 240, 150, 2), after("room", 240, 150, 4);
  Config config = after.config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, before.config.stereo.max_disparity);
  Device device(device_name, kept_programs());
  StereoOdometry odometry(after.rig, device, config);
  odometry.set_tap(tap);
  std::vector<FrameResult> results;
  for (const auto* scene : {&before, &after}) {
    for (std::size_t i = 0; i < scene->left.size(); ++i) {
      StereoFrame frame = scene->frame(i);
      frame.stamp_ns = static_cast<std::int64_t>(results.size());
      results.push_back(odometry.track(frame));
      visit(results.back(), odometry.details());
    }
  }
  return results;
}

}  // namespace

TEST_CASE("A tap receives the base frame of each search and the one that gave the motion, and the poses stay the same",
          "[matching][odometry][device]") {
  for (const auto& device : all_devices()) {
    Searches tap;
    int frame = 0, relocalisations = 0, oldest = 0;
    const auto seen = track_with_loss(device, &tap, [&](const FrameResult& result, const FrameDetails& details) {
      INFO("device " << device << ", frame " << frame);
      CHECK((result.status == FrameStatus::tracked) == (result.diagnostics.search >= 0));
      for (std::size_t s = 0; s < tap.observed.size(); ++s) {
        CHECK(tap.observed[s].number == static_cast<int>(s));
        CHECK(tap.observed[s].base_frame < frame);
        CHECK(tap.observed[s].base_frame >= oldest);  // the observer drops older frames
      }
      oldest = result.reference_frame;
      if (result.diagnostics.search >= 0) {
        const auto s = static_cast<std::size_t>(result.diagnostics.search);
        REQUIRE(s < tap.found.size());
        CHECK(tap.observed[s].step == 1);
        CHECK(tap.observed[s].base_frame == result.diagnostics.base_frame);
        CHECK(tap.observed[s].left.x.size() == details.previous_stereo.size());
        CHECK(matching::same_bytes(tap.found[s], details.quads));
        CHECK(details.quads.search == result.diagnostics.search);
        CHECK(result.counts.temporal_left == tap.alive[0][s]);
        CHECK(result.counts.temporal_right == tap.alive[1][s]);
        if (result.message.find("relocalised") != std::string::npos) {
          ++relocalisations;
          CHECK(tap.observed[s].base_frame == frame - 1);
        }
      }
      ++frame;
    });
    CHECK(relocalisations == 1);
    const auto unseen = track_with_loss(device, nullptr, [](const FrameResult&, const FrameDetails&) {});
    REQUIRE(seen.size() == unseen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      INFO("device " << device << ", frame " << i);
      CHECK(seen[i].status == unseen[i].status);
      CHECK(seen[i].diagnostics.search == unseen[i].diagnostics.search);
      CHECK(seen[i].pose_or_prediction().matrix() == unseen[i].pose_or_prediction().matrix());
      CHECK(seen[i].relative_covariance == unseen[i].relative_covariance);
    }
  }
}
