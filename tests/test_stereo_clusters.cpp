#include "device/stereo_matching.hpp"
#include "matching.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Candidates of left edges on a rectified rig, each with position on the line [px], direction [degrees] and
/// similarity.
struct ClusterLists {
  reference::Candidates candidates;
  reference::CandidateScores scores;
  reference::RefinedCandidates refined;
  EdgeSet right;

  struct Member {
    double position, degrees, similarity;
  };
  explicit ClusterLists(const std::vector<std::vector<Member>>& rows) {
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
  reference::StereoClusters clusters() const { return reference::stereo_clusters(candidates, scores, refined, right); }

  /// Checks that every device and variant finds the same clusters. Single precision may change a decision within 1e-5
  /// of a limit or a tie, in at most `band` rows.
  void compare_devices(std::size_t band) const {
    const auto truth = clusters();
    const std::size_t rows = candidates.first.size() - 1;
    EdgeSet left;
    left.x = left.y = left.direction = std::vector<float>(rows, 1.0f);
    EdgeSet placed = right;
    placed.x = placed.y = placed.direction;
    check_stage("stereo_clusters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      stages::StereoClusters stage(context, variants);
      auto lists = upload(context, candidates);
      upload(context, scores, lists);
      stages::DeviceRefined device_refined;
      device_refined.position.write(context, {refined.position.begin(), refined.position.end()});
      device_refined.similarity.write(context, {refined.similarity.begin(), refined.similarity.end()});
      stages::DeviceClusters found;
      stage.run(upload(context, left), upload(context, placed), lists, device_refined, found);
      const auto count = found.count.read(rows);
      const auto stride = static_cast<std::size_t>(found.stride);
      const auto packed = found.packed.read(3 * stride);
      const auto anchor = found.anchor.read(stride);
      std::vector<float> written;  // of each row's clusters
      std::size_t different = 0;
      for (std::size_t i = 0; i < rows; ++i) {
        const auto expected = static_cast<std::size_t>(truth.first[i]),
                   at = static_cast<std::size_t>(candidates.first[i]);
        for (std::size_t k = at; k < at + static_cast<std::size_t>(count[i]); ++k)
          written.insert(written.end(),
                         {packed[k], packed[stride + k], packed[2 * stride + k], static_cast<float>(anchor[k])});
        bool same = count[i] == truth.first[i + 1] - truth.first[i];
        for (std::size_t k = 0; same && k < static_cast<std::size_t>(count[i]); ++k) {
          same = anchor[at + k] == truth.anchor[expected + k] &&
                 std::abs(static_cast<double>(packed[at + k]) - truth.position[expected + k]) < 1e-5 &&
                 std::abs(std::remainder(static_cast<double>(packed[stride + at + k]) - truth.direction[expected + k],
                                         2 * kPi)) < 1e-4 &&
                 std::abs(static_cast<double>(packed[2 * stride + at + k]) - truth.similarity[expected + k]) < 1e-5;
        }
        different += same ? 0 : 1;
      }
      CHECK(different <= band);
      return {{"count", count}, {"clusters", written}};
    });
  }
};

}  // namespace

TEST_CASE("stereo clusters: hand calculations") {
  std::vector<ClusterLists::Member> chain;
  for (int k = 0; k < 12; ++k) chain.push_back({0.5 * k, 20, 0.8 + 0.01 * k});
  struct Row {
    const char* what;
    std::vector<std::vector<ClusterLists::Member>> members;
    std::vector<std::size_t> dead;
    std::vector<std::int32_t> first, anchor;
  };
  for (const Row& row : {
           Row{"gaps of 0.9 and 0.6 make a chain, one of exactly 1 splits",
               {{{5.5, 10, 0.8}, {3, 10, 0.7}, {3.9, 12, 0.9}, {4.5, 8, 0.85}}, {}, {{7, 0, 0.9}, {8, 0, 0.95}}},
               {},
               {0, 2, 2, 4},
               {2, 0, 4, 5}},
           {"178 and -179 degrees differ by 3, 30 and 55 by more than 20, 10 and -170 are opposite",
            {{{1, 178, 0.9}, {1.5, -179, 0.9}}, {{1, 30, 0.9}, {1.5, 55, 0.9}}, {{1, 10, 0.9}, {1.5, -170, 0.9}}},
            {},
            {0, 1, 3, 5},
            {0, 2, 3, 4, 5}},
           {"among equally similar members the first by number",
            {{{1.5, 20, 0.9}, {1, 20, 0.9}},
             {{4.3, 20, 0.90003}, {4.1, 20, 0.90001}, {4, 20, 0.89}},
             {{3.4, 20, 0.9}, {3.1, 20, 0.9003}}},
            {},
            {0, 1, 2, 3},
            {0, 2, 6}},
           {"at most ten members", {chain}, {}, {0, 2}, {9, 11}},
           {"without rejected members, which leave a gap of 2 px", {chain}, {5, 6, 7}, {0, 2}, {4, 11}},
       }) {
    INFO(row.what);
    ClusterLists lists(row.members);
    for (const std::size_t member : row.dead) lists.scores.state[member] = 7;
    const auto clusters = lists.clusters();
    CHECK(clusters.first == row.first);
    REQUIRE(clusters.anchor == row.anchor);
    for (std::size_t k = 0; k < row.anchor.size(); ++k) {
      const auto of = static_cast<std::size_t>(row.anchor[k]);
      CHECK(clusters.position[k] == lists.refined.position[of]);
      CHECK(clusters.similarity[k] == lists.refined.similarity[of]);
    }
  }
  // Directions at distances d from the anchor have weights exp(-d^2 / 8): 10, 12, 8 degrees at 0.9, 0, 0.6 px, and,
  // around the full turn, 178 and 181 at 0 and 0.5 px.
  const auto direction = [](std::vector<ClusterLists::Member> members) {
    return ClusterLists({std::move(members)}).clusters().direction[0] / kDegree;
  };
  const double a = std::exp(-0.81 / 8), c = std::exp(-0.36 / 8), w = std::exp(-0.25 / 8);
  CHECK(direction({{3, 10, 0.7}, {3.9, 12, 0.9}, {4.5, 8, 0.85}}) ==
        Approx((10 * a + 12 + 8 * c) / (a + 1 + c)).margin(1e-3));
  CHECK(std::abs(std::remainder(direction({{1, 178, 0.9}, {1.5, -179, 0.9}}) - (178 + 181 * w) / (1 + w), 360)) < 6e-3);
}

TEST_CASE("stereo clusters: devices agree with the reference on random lists", "[device]") {
  Random random(19);
  std::vector<std::vector<ClusterLists::Member>> rows;
  for (int i = 0; i < 251; ++i) {
    rows.emplace_back();
    for (int k = 0; k < i % 14; ++k) rows.back().push_back({random(4, 9), random(-180, 180), random(0.5, 1)});
    for (int k = 0; k < i % 5; ++k) rows.back().push_back({random(12, 14), random(20, 40), random(0.5, 1)});
  }
  ClusterLists lists(rows);
  for (std::size_t c = 0; c < lists.refined.position.size(); c += 7) lists.scores.state[c] = 8;
  for (std::size_t c = 3; c < lists.refined.position.size(); c += 11) lists.scores.state[c] = kCandidateRepresented;
  CHECK(lists.clusters().position.size() > 500);
  lists.compare_devices(1);
}

TEST_CASE("stereo clusters: few edges, and none", "[device][oclgrind]") {
  ClusterLists({{{5.5, 10, 0.8}, {3, 10, 0.7}, {3.9, 12, 0.9}}, {}, {{7, 0, 0.9}}}).compare_devices(0);
  ClusterLists({}).compare_devices(0);
}
