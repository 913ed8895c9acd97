#include "common/filter_limits.hpp"
#include "frontends.hpp"
#include "rig/rectification_follower.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Keeps the lists of the last frame per cascade, side and filter.
class Lists : public Tap {
 public:
  void edges(const EdgeSet&, const EdgeSet&) override { ++edge_calls; }
  void stereo_filter(StereoFilter filter, const CandidateLists& lists) override {
    stereo_lists[order_of(filter)] = lists;
  }
  void stereo(const StereoEdges& edges) override { stereo_edges = edges; }
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& lists) override {
    temporal_lists[index_of(side)][order_of(filter)] = lists;
  }
  void temporal_search(const ObservedSearch& observed) override { search = observed; }
  void quads(const TemporalMatches& matches) override { matched = matches; }

  ObservedSearch search;
  int edge_calls = 0;
  std::map<int, CandidateLists> stereo_lists, temporal_lists[2];
  StereoEdges stereo_edges;
  TemporalMatches matched;
};

/// Every candidate that fulfils `passes` is kept by the filter that judges its cue, and no other.
template <class Passes>
void check_cue(const CandidateLists& before, const CandidateLists& after, const Passes& passes) {
  REQUIRE(before.cue.size() == before.target.size());
  std::vector<std::int32_t> expected;
  for (std::size_t c = 0; c < before.target.size(); ++c)
    if (passes(before.cue[c])) expected.push_back(before.target[c]);
  CHECK(expected == after.target);
}

/// Checks that every row of `after` is a subset of the same row of `before`. \returns the number of rejected candidates
std::size_t check_subset(const CandidateLists& before, const CandidateLists& after) {
  REQUIRE(before.first.size() == after.first.size());
  std::size_t strangers = 0;
  for (std::size_t row = 0; row + 1 < after.first.size(); ++row) {
    const std::multiset<std::int32_t> known(before.target.begin() + before.first[row],
                                            before.target.begin() + before.first[row + 1]);
    for (auto c = after.first[row]; c < after.first[row + 1]; ++c)
      strangers += known.count(after.target[static_cast<std::size_t>(c)]) == 0 ? 1 : 0;
  }
  CHECK(strangers == 0);
  return before.target.size() - after.target.size();
}

}  // namespace

TEST_CASE("frontend: every device finds the reference's stereo edges and quads", "[device]") {
  for (const auto& scene : {RenderedScene("room", 320, 200, 2), RenderedScene("room", 161, 97, 2),
                            RenderedScene("cables", 200, 125, 2), RenderedScene("facade", 161, 97, 2)}) {
    const auto truth = run_frontend(scene, "reference");
    CHECK(truth.current.size() > 100);
    CHECK(truth.quads.size() > 50);
    for (const auto& device : all_devices()) {
      INFO("device " << device << ", width " << scene.rig.left.width);
      const auto found = run_frontend(scene, device);
      CHECK(agreement(found.previous, truth.previous) > 0.995);
      CHECK(agreement(found.current, truth.current) > 0.995);
      CHECK(agreement(found.quads, truth.quads) > 0.99);
    }
  }
}

TEST_CASE("frontend: every device finds the reference's global matches, at the positions that the motion predicts",
          "[device]") {
  const RenderedScene scene("room", 240, 150, 2, 8);
  const auto find = [&](const std::string& device_name) {
    Device device(device_name, kept_programs());
    const auto frontend = frontend::make_frontend(scene.rig, device, scene.config);
    const auto first = frontend->process(scene.frame(0)), second = frontend->process(scene.frame(1));
    const auto matches = frontend::as_global(*frontend).match_globally(*first, scene.config.temporal.global_edges);
    CHECK(
        same_bytes(matches, frontend::as_global(*frontend).match_globally(*first, scene.config.temporal.global_edges)));
    CHECK(frontend::as_global(*frontend).match_globally(*first, 0).size() == 0);
    const StereoEdges& before = first->edges;
    std::size_t right = 0;
    for (std::size_t m = 0; m < matches.size(); ++m) {
      const auto i = static_cast<std::size_t>(matches.previous[m]);
      const Eigen::Vector3d ray = scene.rig.left.ray({before.left_x[i], before.left_y[i]});
      const double depth =
          scene.rig.left.fx * scene.rig.baseline() / static_cast<double>(before.left_x[i] - before.right_x[i]);
      const Eigen::Vector2d position = scene.rig.left.project(scene.world_from_left[1].inverse() *
                                                              scene.world_from_left[0] * Eigen::Vector3d(depth * ray));
      right += std::hypot(position.x() - static_cast<double>(matches.left_x[m]),
                          position.y() - static_cast<double>(matches.left_y[m])) < 4
                   ? 1
                   : 0;
    }
    CHECK(matches.size() > 200);
    CHECK(right > matches.size() * 7 / 10);
    // Among certain edges only: all of them, every third, none.
    const auto among = [&](std::size_t step) {
      GlobalSearch some;
      for (std::size_t i = 0; i < before.size(); i += step) some.of_base.push_back(static_cast<std::int32_t>(i));
      for (std::size_t i = 0; i < second->edges.size(); i += step)
        some.of_current.push_back(static_cast<std::int32_t>(i));
      return some;
    };
    TemporalMatches of_some;
    frontend::as_global(*frontend).match_globally(*first, *frontend->latest(), among(1), of_some);
    CHECK(same_bytes(of_some, frontend::as_global(*frontend).match_globally(*first, 1000000)));
    frontend::as_global(*frontend).match_globally(*first, *frontend->latest(), among(3), of_some);
    CHECK(of_some.size() > 30);
    for (std::size_t m = 0; m < of_some.size(); ++m) {
      CHECK(of_some.previous[m] % 3 == 0);
      CHECK(of_some.current[m] % 3 == 0);
      CHECK(of_some.left_x[m] == second->edges.left_x[static_cast<std::size_t>(of_some.current[m])]);
    }
    frontend::as_global(*frontend).match_globally(*first, *frontend->latest(), {among(1).of_base, {}}, of_some);
    CHECK(of_some.size() == 0);
    frontend::as_global(*frontend).match_globally(*first, *frontend->latest(), {{}, among(1).of_current}, of_some);
    CHECK(of_some.size() == 0);
    return matches;
  };
  const auto expected = find("reference");
  for (const auto& name : all_devices()) {
    // Some bytes of a descriptor differ by one, and an additional edge changes the selection of edges.
    CHECK(agreement(find(name), expected) > 0.8);
  }
}

TEST_CASE("frontend: every variant of every stage gives the default's bytes, and a second run gives them again",
          "[device]") {
  const RenderedScene scene("room", 161, 97, 2);
  for (const auto& device : all_devices()) {
    const auto expected = run_frontend(scene, device);
    REQUIRE(expected.quads.size() > 50);
    CHECK(same_bytes(run_frontend(scene, device), expected));
    const Device same(device);
    for (const auto& variant : opencl::all_variants()) {
      if (opencl::choose_variant(variant.stage, *same.context(), {}).name == variant.name) continue;
      INFO("device " << device << ", " << variant.stage << " " << variant.name);
      CHECK(same_bytes(run_frontend(scene, device, {{variant.stage, variant.name}}), expected));
    }
  }
}

// LONG: the test's tap counts every list.
TEST_CASE("frontend: a tap changes nothing and receives lists that only shrink", "[device]") {
  RenderedScene scene("room", 161, 97, 2);
  scene.config.temporal.sift_max = 300;
  scene.config.stereo.sift_max = 400;
  for (const auto& device : all_devices()) {
    for (const int step : {1, 8}) {
      Lists tap;
      const auto seen = run_frontend(scene, device, {}, &tap, 16, step);
      CHECK(same_bytes(seen, run_frontend(scene, device, {}, nullptr, 16, step)));
      CHECK(tap.edge_calls == 2);
      CHECK(same_bytes(tap.stereo_edges, seen.current));
      CHECK(same_bytes(tap.matched, seen.quads));
      REQUIRE(tap.stereo_lists.size() == 11);  // filters 1 to 11; 12 is the stereo edges
      CHECK(tap.stereo_lists[1].first.size() == seen.left_edges.size() + 1);
      std::size_t gone = 0;
      for (int order = 2; order <= 7; ++order)
        gone += check_subset(tap.stereo_lists[order - 1], tap.stereo_lists[order]);
      CHECK(gone > 1000);
      check_subset(tap.stereo_lists[7], tap.stereo_lists[8]);  // anchors of clusters are candidates
      for (const int order : {9, 10, 11}) check_subset(tap.stereo_lists[order - 1], tap.stereo_lists[order]);
      const auto& chosen = tap.stereo_lists[10];
      for (std::size_t i = 0; i + 1 < chosen.first.size(); ++i) CHECK(chosen.first[i + 1] - chosen.first[i] <= 1);
      const auto& owned = tap.stereo_lists[11].target;
      CHECK(std::set<std::int32_t>(owned.begin(), owned.end()).size() == owned.size());
      CHECK(owned.size() < seen.current.size());
      // A list's cue is the input of the next filter.
      const Config& config = scene.config;
      check_cue(tap.stereo_lists[3], tap.stereo_lists[4],
                [&](float sift) { return sift <= static_cast<float>(config.stereo.sift_max); });
      check_cue(tap.stereo_lists[4], tap.stereo_lists[5],
                [&](float ncc) { return ncc >= static_cast<float>(config.stereo.ncc_min); });
      check_cue(tap.stereo_lists[8], tap.stereo_lists[9],
                [&](float similarity) { return similarity >= lowest_similarity(config.stereo); });
      CHECK(tap.stereo_lists[5].cue.size() == tap.stereo_lists[5].target.size());
      CHECK(tap.stereo_lists[6].cue.size() == tap.stereo_lists[6].target.size());
      CHECK(tap.stereo_lists[7].cue.empty());
      for (const int side : {0, 1}) {
        auto& lists = tap.temporal_lists[side];
        check_cue(lists[2], lists[3], [&](float ncc) { return ncc >= static_cast<float>(config.temporal.ncc_min); });
        check_cue(lists[3], lists[4], [&](float sift) { return sift <= static_cast<float>(config.temporal.sift_max); });
      }
      CHECK(tap.search.number == 0);
      CHECK(tap.search.base_frame == 0);
      CHECK(tap.search.radius == 16);
      CHECK(tap.search.step == step);
      CHECK(tap.search.left.x == seen.previous.left_x);
      CHECK(tap.search.right.direction == seen.previous.right_direction);
      CHECK(seen.quads.search == 0);
      for (std::size_t i = 0; i < seen.current.size(); ++i) {  // the final edge is the chosen cluster
        const auto row = static_cast<std::size_t>(seen.current.left_index[i]);
        const auto& lists = chosen;
        bool found = false;
        for (auto c = static_cast<std::size_t>(lists.first[row]); c < static_cast<std::size_t>(lists.first[row + 1]);
             ++c) {
          found = found || (lists.target[c] == seen.current.right_index[i] &&
                            std::abs(lists.x[c] - seen.current.right_x[i]) < 1e-3f);
        }
        if (!found) FAIL_CHECK("stereo edge " << i << " was not chosen");
      }
      const auto rows = (seen.previous.size() + static_cast<std::size_t>(step) - 1) / static_cast<std::size_t>(step);
      for (const int side : {0, 1}) {
        REQUIRE(tap.temporal_lists[side].size() == 7);  // filters 1 to 6 and 8; 9 is the quads
        CHECK(tap.temporal_lists[side][1].first.size() == rows + 1);
        for (int order = 2; order <= 6; ++order)
          check_subset(tap.temporal_lists[side][order - 1], tap.temporal_lists[side][order]);
        check_subset(tap.temporal_lists[side].at(6), tap.temporal_lists[side].at(order_of(TemporalFilter::agreement)));
      }
      for (std::size_t q = 0; q < seen.quads.size(); ++q) {  // a quad has survived in both lists
        CHECK(seen.quads.previous[q] % step == 0);
        const auto row = static_cast<std::size_t>(seen.quads.previous[q] / step);
        for (const int side : {0, 1}) {
          const auto& lists = tap.temporal_lists[side][6];
          const auto begin = lists.target.begin() + lists.first[row], end = lists.target.begin() + lists.first[row + 1];
          if (std::find(begin, end, seen.quads.current[q]) == end)
            FAIL_CHECK("quad " << q << " is not in the lists of side " << side);
        }
      }
    }
  }
}

TEST_CASE("frontend: without SIFT a tap changes nothing, whichever kernel matches without it", "[device]") {
  const RenderedScene scene("room", 161, 97, 2);
  for (const auto& device : all_devices()) {
    for (const int step : {1, 8}) {
      Lists tap;
      const auto expected = run_frontend(scene, device, {}, &tap, 16, step);
      REQUIRE(expected.quads.size() > 10);
      for (const int side : {0, 1}) {
        auto& lists = tap.temporal_lists[side];
        REQUIRE(lists.size() == 7);
        CHECK(check_subset(lists[1], lists[2]) > 0);
        check_cue(lists[2], lists[3],
                  [&](float ncc) { return ncc >= static_cast<float>(scene.config.temporal.ncc_min); });
      }
      for (const auto& variant : opencl::all_variants()) {
        if (variant.stage != "temporal_match") continue;
        INFO("device " << device << ", " << variant.name << ", step " << step);
        CHECK(same_bytes(run_frontend(scene, device, {{variant.stage, variant.name}}, nullptr, 16, step), expected));
      }
    }
  }
}

TEST_CASE("frontend: unknown variants are refused", "[device]") {
  RenderedScene scene("cables", 64, 48, 1);
  for (const auto& name : {std::string("reference"), all_devices().front()}) {
    Device device(name, kept_programs());
    Config config = scene.config;
    config.variants["stereo_clusters"] = "no such variant";
    CHECK_THROWS_AS(frontend::make_frontend(scene.rig, device, config), UsageError);
  }
}
