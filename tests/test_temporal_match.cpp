#include <numeric>

#include "common/filter_limits.hpp"
#include "matching.hpp"
#include "reference/patches.hpp"
#include "reference/temporal_candidates.hpp"
#include "reference/temporal_quads.hpp"
#include "stages/temporal_match.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// What the matching in time left, with the rows that kept a candidate in each image before the agreement.
struct MatchedRows {
  TemporalMatches quads;
  int left_alive = 0, right_alive = 0;
};

constexpr int kWidth = 97, kHeight = 61;

/// A patch pair near one of a few prototypes, so that many edges look alike.
void add_patches(Random& random, std::vector<std::int8_t>& patches) {
  const int kind = static_cast<int>(random(0, 2.99));
  const std::size_t first = patches.size();
  patches.resize(first + kEdgePatchBytes, 0);
  for (const int side : {0, 1}) {
    reference::PatchValues values;
    for (int k = 0; k < kPatchSamples; ++k) {
      values[static_cast<std::size_t>(k)] = std::sin(0.3 * (kind + 1) * (k + 5 * side)) + random(-0.5, 0.5);
    }
    reference::store_side(values, side, patches.data() + first);
  }
}

/// A base rig and a current one whose edges lie about the predicted places; `shuffled` numbers of the left edges.
struct Scene {
  StereoEdges base, current;
  std::vector<std::int8_t> base_left, base_right, left,
      right;  ///< patches: left ones by left edge, right ones by stereo edge
  TemporalSearch search;
  TemporalConfig config;

  Scene(int base_edges, int current_edges, std::uint64_t seed, int step = 1) {
    Random random(seed);
    search.radius = 3;
    search.step = step;
    fill(random, base_edges, base, base_left, base_right);
    fill(random, current_edges, current, left, right);
    for (std::size_t i = 0; i < base.size(); ++i) {
      const bool known = random(0, 1) < 0.9;
      const float nan = std::nanf("");
      // Edges of the base are expected where they are, 6 px higher in x.
      search.left.x.push_back(known ? base.left_x[i] + 6 : nan);
      search.left.y.push_back(known ? base.left_y[i] : nan);
      search.left.direction.push_back(base.left_direction[i]);
      search.right.x.push_back(base.right_x[i] + 6);
      search.right.y.push_back(base.right_y[i]);
      search.right.direction.push_back(base.right_direction[i]);
    }
  }
  static void fill(Random& random, int count, StereoEdges& edges, std::vector<std::int8_t>& of_left,
                   std::vector<std::int8_t>& of_right) {
    for (int i = 0; i < count; ++i) {
      // 7 shares no factor with the numbers of edges used: every left edge once.
      edges.left_index.push_back(count == 0 ? 0 : 7 * i % count);
      edges.right_index.push_back(i);
      const float x = static_cast<float>(random(-4, kWidth + 3)), y = static_cast<float>(random(-4, kHeight + 3));
      edges.left_x.push_back(x);
      edges.left_y.push_back(y);
      edges.right_x.push_back(x - static_cast<float>(random(3, 5)));
      edges.right_y.push_back(y);
      edges.left_direction.push_back(static_cast<float>(random(-0.3, 0.3)));
      edges.right_direction.push_back(edges.left_direction.back());
      edges.ncc.push_back(0.9f);
      add_patches(random, of_left);
      add_patches(random, of_right);
    }
  }

  struct Expected {
    TemporalMatches quads;
    int left_alive = 0, right_alive = 0;
  };
  static int living_rows(const reference::Candidates& lists, const reference::CandidateScores& scores) {
    int rows = 0;
    for (std::size_t row = 0; row + 1 < lists.first.size(); ++row) {
      bool alive = false;
      for (auto c = static_cast<std::size_t>(lists.first[row]); c < static_cast<std::size_t>(lists.first[row + 1]); ++c)
        alive |= scores.state[c] == kCandidateAlive;
      rows += alive ? 1 : 0;
    }
    return rows;
  }
  /// Patches by stereo edge, as the reference wants them; SIFT takes no part.
  static reference::EdgeDescriptions described(const std::vector<std::int8_t>& patches,
                                               const std::vector<std::int32_t>& numbers) {
    reference::EdgeDescriptions set;
    for (const auto number : numbers) {
      const auto begin = patches.begin() + static_cast<std::ptrdiff_t>(number) * kEdgePatchBytes;
      set.patches.insert(set.patches.end(), begin, begin + kEdgePatchBytes);
    }
    set.sift.assign(256 * numbers.size(), 0);
    return set;
  }
  Expected expected() const {
    const auto side = [&](const PlacedEdges& predicted, const PlacedEdges& places) {
      PointIndex index;
      make_point_index(places.x, places.y, kWidth, kHeight, index);
      return reference::temporal_candidates(predicted, places, index, search.radius,
                                            static_cast<float>(config.orientation * kDegree), search.step);
    };
    const auto lefts = side(search.left, {current.left_x, current.left_y, current.left_direction});
    const auto rights = side(search.right, {current.right_x, current.right_y, current.right_direction});
    const auto limits = temporal_limits(config, search);
    auto left_scores = reference::candidate_filters(lefts, described(base_left, base.left_index),
                                                    described(left, current.left_index), limits, search.step);
    const auto right_scores = reference::candidate_filters(rights, described(base_right, base.right_index),
                                                           described(right, current.right_index), limits, search.step);
    Expected result;
    result.left_alive = living_rows(lefts, left_scores);
    result.right_alive = living_rows(rights, right_scores);
    const auto agreement = reference::temporal_agreement(lefts, left_scores, rights, right_scores);
    result.quads = reference::temporal_best(lefts, left_scores, agreement, current, config, search);
    return result;
  }
  static void upload_rig(opencl::Context& context, const StereoEdges& edges, const std::vector<std::int8_t>& of_left,
                         const std::vector<std::int8_t>& of_right, stages::DeviceStereoEdges& rig) {
    rig.count = rig.stride = static_cast<int>(edges.size());
    std::vector<float> packed;
    for (const auto* block : {&edges.left_x, &edges.left_y, &edges.left_direction})
      packed.insert(packed.end(), block->begin(), block->end());
    rig.packed.write(context, packed);
    rig.left_index.write(context, edges.left_index);
    rig.left_patches.write(context, of_left);
    rig.right_patches.write(context, of_right);
  }
  /// What every variant but the lists finds on every device.
  void on_devices(const std::function<void(const std::optional<MatchedRows>&)>& check) const {
    for_each_variant(
        "temporal_match", [&](opencl::Context& context, const Variants& variants, const std::string& name) {
          stages::TemporalMatch stage(context, config, variants);
          if (!stage.serves(search)) return;
          INFO(name);
          stages::DeviceStereoEdges device_base, device_current;
          upload_rig(context, base, base_left, base_right, device_base);
          upload_rig(context, current, left, right, device_current);
          stages::DevicePointIndex left_index, right_index;
          left_index.build(context, current.left_x, current.left_y, current.left_direction, kWidth, kHeight);
          right_index.build(context, current.right_x, current.right_y, current.right_direction, kWidth, kHeight);
          stages::DevicePlaces left_places, right_places;
          left_places.write(context, search.left);
          right_places.write(context, search.right);
          std::vector<cl_int> numbers(current.size());
          std::iota(numbers.begin(), numbers.end(), 0);
          opencl::Buffer<cl_int> itself;
          itself.write(context, numbers);
          MatchedRows matched;
          const auto alive = stage.run(left_places, right_places, search, device_base, device_current, left_index,
                                       right_index, itself, current, matched.quads);
          if (alive) {
            matched.left_alive = alive->left;
            matched.right_alive = alive->right;
          }
          check(alive ? std::optional(matched) : std::nullopt);
        });
  }
  std::size_t compare_devices() const {
    const auto truth = expected();
    int variants = 0;
    on_devices([&](const auto& found) {
      ++variants;
      REQUIRE(found);
      CHECK(found->left_alive == truth.left_alive);
      CHECK(found->right_alive == truth.right_alive);
      CHECK(found->quads.previous == truth.quads.previous);
      CHECK(found->quads.current == truth.quads.current);
      CHECK(found->quads.rivals == truth.quads.rivals);
      CHECK(found->quads.ncc == truth.quads.ncc);
      CHECK(found->quads.right_x == truth.quads.right_x);
    });
    CHECK(variants >= 2);
    return truth.quads.size();
  }
};

}  // namespace

TEST_CASE("temporal match: one kernel finds what the reference's cascade finds, to the last bit",
          "[temporal][matching][device]") {
  CHECK(Scene(400, 2000, 3).compare_devices() > 100);
  CHECK(Scene(401, 1999, 4, 3).compare_devices() > 30);
}

TEST_CASE("temporal match: few edges, and none", "[temporal][matching][device][oclgrind]") {
  Scene(5, 60, 5).compare_devices();
  Scene(3, 0, 6).compare_devices();
  Scene(0, 4, 7).compare_devices();
}

TEST_CASE("temporal match: a row with more candidates than there is room for says so",
          "[temporal][matching][device][oclgrind]") {
  Scene scene(3, 170, 8);
  for (std::size_t j = 0; j < 170; ++j) {
    scene.current.left_x[j] = scene.base.left_x[2] + 6;
    scene.current.left_y[j] = scene.base.left_y[2];
    scene.current.left_direction[j] = scene.base.left_direction[2];
  }
  scene.search.left.x[2] = scene.base.left_x[2] + 6;
  scene.search.left.y[2] = scene.base.left_y[2];
  scene.on_devices([](const auto& found) { CHECK_FALSE(found); });
}
