#include "device/candidates.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr int kNcc = 5, kSift = 4;  // orders as in the stereo cascade; the nearly-best filters follow at 6 and 7

/// Descriptions with known scores. Edges of the first set have the unit vector e0 as dark patch, a flat bright patch,
/// and SIFT all zero on both sides. An edge of the second set with NCC c and SIFT distance d has the patch
/// c e0 + sqrt((1 - c^2) / 3) (e1 + e2 + e3), which 8 bits hold to 0.004 (c = 0.5 exactly), and a single SIFT byte d.
struct Verdicts {
  reference::EdgeDescriptions a, b;
  explicit Verdicts(int first_edges) {
    for (int i = 0; i < first_edges; ++i) {
      a.patches.resize(a.patches.size() + kEdgePatchBytes, 0);
      reference::store_side({1}, 0, a.patches.data() + a.patches.size() - kEdgePatchBytes);
      a.sift.resize(a.sift.size() + 256, 0);
    }
  }
  /// `bright`: the second set's bright side is the similar one.
  int add(double ncc, int distance, bool bright = false) {
    const std::size_t sift = b.sift.size();
    b.patches.resize(b.patches.size() + kEdgePatchBytes, 0);
    const double other = std::sqrt((1 - ncc * ncc) / 3);
    reference::store_side({ncc, other, other, other}, bright ? 1 : 0,
                          b.patches.data() + b.patches.size() - kEdgePatchBytes);
    b.sift.resize(sift + 256, 0);
    b.sift[sift + 7] = static_cast<std::uint8_t>(distance);
    std::fill_n(b.sift.begin() + static_cast<std::ptrdiff_t>(sift) + 128, 128, static_cast<std::uint8_t>(255));
    return static_cast<int>(b.sift.size() / 256) - 1;
  }
};

FilterLimits limits_of(float ncc_min, float sift_max, float ncc_share, float sift_share, int ncc = kNcc,
                       int sift = kSift) {
  return {ncc_min, sift_max, ncc_share, sift_share, ncc, sift};
}

/// Runs every variant on every device.
void on_devices(const reference::Candidates& lists, const reference::EdgeDescriptions& a,
                const reference::EdgeDescriptions& b, const FilterLimits& limits, int row_step, bool all_scores,
                const std::function<void(const reference::CandidateScores&, const std::vector<cl_int>& alive)>& check) {
  check_stage("candidate_filters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    CAPTURE(all_scores);
    stages::CandidateFilters stage(context, variants);
    auto device = upload(context, lists);
    opencl::Buffer<cl_char> patches_a, patches_b;
    opencl::Buffer<cl_uchar> sift_a, sift_b;
    patches_a.write(context, a.patches);
    sift_a.write(context, a.sift);
    sift_b.write(context, b.sift);
    opencl::Buffer<cl_int> itself, turned;
    std::vector<cl_int> numbers(a.sift.size() / kEdgeSiftBytes);
    std::iota(numbers.begin(), numbers.end(), 0);
    itself.write(context, numbers);
    // The second set's patches are stored in reverse order.
    std::vector<std::int8_t> patches_turned;
    std::vector<cl_int> from_the_end;
    for (auto k = static_cast<cl_int>(b.sift.size() / kEdgeSiftBytes) - 1; k >= 0; --k) {
      from_the_end.push_back(k);
      patches_turned.insert(patches_turned.end(), b.patches.begin() + kEdgePatchBytes * k,
                            b.patches.begin() + kEdgePatchBytes * (k + 1));
    }
    turned.write(context, from_the_end);
    patches_b.write(context, patches_turned);
    stage.run({patches_a, itself, sift_a}, {patches_b, turned, sift_b}, limits, row_step, all_scores, device);
    const auto size = lists.target.size();
    const reference::CandidateScores scores{device.ncc.read(size), device.sift.read(size), device.state.read(size)};
    const auto alive = device.alive.read(static_cast<std::size_t>(device.rows));
    check(scores, alive);
    return {{"ncc", scores.ncc}, {"sift", scores.sift}, {"state", scores.state}, {"alive", alive}};
  });
}

/// Reference and devices must reject exactly as `expected` says.
void check_states(const reference::Candidates& lists, const Verdicts& edges, const FilterLimits& limits,
                  const std::vector<std::uint8_t>& expected, int row_step = 1) {
  CHECK(reference::candidate_filters(lists, edges.a, edges.b, limits, row_step).state == expected);
  if (limits.sift_max == 0)  // no descriptors are needed
    CHECK(reference::candidate_filters(lists, {edges.a.patches, {}}, {edges.b.patches, {}}, limits, row_step).state ==
          expected);
  std::vector<cl_int> living;
  for (std::size_t row = 0; row + 1 < lists.first.size(); ++row) {
    living.push_back(static_cast<cl_int>(
        std::count(expected.begin() + lists.first[row], expected.begin() + lists.first[row + 1], 0)));
  }
  on_devices(lists, edges.a, edges.b, limits, row_step, true, [&](const auto& scores, const auto& alive) {
    CHECK(scores.state == expected);
    CHECK(alive == living);
  });
  // Without all scores only the order of the first failed filter may differ, never the survivors.
  on_devices(lists, edges.a, edges.b, limits, row_step, false, [&](const auto& scores, const auto& alive) {
    for (std::size_t c = 0; c < expected.size(); ++c) CHECK((scores.state[c] == kCandidateAlive) == (expected[c] == 0));
    CHECK(alive == living);
  });
}

}  // namespace

TEST_CASE("candidate filters: thresholds and nearly-best filters reject what a hand calculation rejects",
          "[device][oclgrind]") {
  Verdicts edges(1);
  reference::Candidates lists;
  lists.target = {edges.add(0.96875, 100), edges.add(0.90625, 60), edges.add(0.59375, 50), edges.add(0.75, 201),
                  edges.add(0.59375, 201), edges.add(0.84375, 20), edges.add(0.9375, 160)};
  lists.first = {0, 7};
  // NCC at least 0.6, SIFT at most 200. Nearly-best NCC is 0.9 x 0.96875 = 0.872, which rejects the candidate with SIFT
  // 20 before it can be the best; the best SIFT of the rest is 60, so distances over 60 / 0.5 = 120 are rejected.
  check_states(lists, edges, limits_of(0.6f, 200, 0.9f, 0.5f), {0, 0, kNcc, kSift, kSift, 6, 7});
  // The first two filters swapped: a candidate that fails both is assigned to the earlier one.
  check_states(lists, edges, limits_of(0.6f, 200, 0.9f, 0.5f, 3, 4), {0, 0, 3, 4, 3, 5, 6});
  // Without SIFT.
  check_states(lists, edges, limits_of(0.6f, 0, 0.9f, 0.5f), {0, 0, kNcc, 6, kNcc, 6, 0});
}

TEST_CASE("candidate filters: values on a threshold and ties pass", "[device][oclgrind]") {
  Verdicts edges(1);
  reference::Candidates lists;
  lists.target = {edges.add(0.5, 200), edges.add(0.5, 200), edges.add(1, 100), edges.add(1, 100, true)};
  lists.first = {0, 4};
  check_states(lists, edges, limits_of(0.5f, 200, 0.5f, 0.5f), {0, 0, 0, 0});
  const auto scores = reference::candidate_filters(lists, edges.a, edges.b, limits_of(0.5f, 200, 0.5f, 0.5f));
  CHECK(scores.ncc == std::vector<float>{0.5f, 0.5f, 1, 1});
  CHECK(scores.sift == std::vector<float>{200, 200, 100, 100});
}

TEST_CASE("candidate filters: rows are independent, including empty rows and every second edge", "[device][oclgrind]") {
  Verdicts edges(5);
  // Edge 2 has the negated patch of the others, so what resembles them does not resemble it. Rows 0, 1, 2 belong to
  // edges 0, 2, 4.
  reference::store_side({-1}, 0, edges.a.patches.data() + 2 * kEdgePatchBytes);
  const int good = edges.add(0.96875, 40), bad = edges.add(-0.9375, 40);
  reference::Candidates lists;
  lists.target = {good, bad, good, bad};
  lists.first = {0, 2, 4, 4};
  check_states(lists, edges, limits_of(0.6f, 200, 0.9f, 0.4f), {0, kNcc, kNcc, 0}, 2);
  lists.target.clear();
  lists.first = {0, 0, 0, 0};
  check_states(lists, edges, limits_of(0.6f, 200, 0.9f, 0.4f), {}, 2);
  lists.first = {0};
  check_states(lists, edges, limits_of(0.6f, 200, 0.9f, 0.4f), {});
}

TEST_CASE("candidate filters: devices agree with the reference on random descriptions", "[device]") {
  Random random(5);
  const auto describe = [&](int count) {
    reference::EdgeDescriptions set;
    for (int i = 0; i < count; ++i) {
      set.patches.resize(set.patches.size() + kEdgePatchBytes, 0);
      for (const int side : {0, 1}) {
        reference::PatchValues values;
        for (double& v : values) v = random(-0.5, 1);
        reference::store_side(values, side, set.patches.data() + set.patches.size() - kEdgePatchBytes);
      }
      for (int k = 0; k < 256; ++k) set.sift.push_back(static_cast<std::uint8_t>(random(0, 60)));
    }
    return set;
  };
  const auto a = describe(60), b = describe(80);
  reference::Candidates lists;
  lists.first = {0};
  for (int row = 0; row < 60; ++row) {
    for (int j = row % 7; j < 80; j += 1 + row % 5) lists.target.push_back(j);
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  const auto limits = limits_of(0.3f, 265, 0.85f, 0.97f);
  const auto truth = reference::candidate_filters(lists, a, b, limits);
  int seen[8] = {};
  for (const auto state : truth.state) ++seen[state];
  for (const int state : {0, kSift, kNcc, 6, 7}) {
    INFO(state);
    CHECK(seen[state] > 10);
  }
  // Exact integers, multiplied in the same order and precision, give the same bits; no tolerance is needed.
  on_devices(lists, a, b, limits, 1, true, [&](const auto& scores, const auto&) {
    CHECK(scores.ncc == truth.ncc);
    CHECK(scores.state == truth.state);
    float largest = 0;
    for (std::size_t c = 0; c < truth.sift.size(); ++c)
      largest = std::max(largest, std::abs(scores.sift[c] - truth.sift[c]));
    CHECK(largest < 1e-4f);
  });
}
