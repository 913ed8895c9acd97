#include "common/filter_limits.hpp"
#include "device/temporal_matching.hpp"
#include "matching.hpp"
#include "reference/edge_descriptions.hpp"
#include "reference/temporal_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr int kImageWidth = 97, kImageHeight = 61;

/// A pair of patches close to one of a few prototypes, so that many edges look similar.
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

/// A base rig and a current one whose edges lie near the predicted positions; left edges are in shuffled order.
struct TemporalScene {
  StereoEdges base, current;
  std::vector<std::int8_t> base_left, base_right, left,
      right;  ///< patches: left ones by left edge, right ones by stereo edge
  TemporalSearch search;
  TemporalConfig config;

  TemporalScene(int base_edges, int current_edges, std::uint64_t seed, int step = 1) {
    Random random(seed);
    search.radius = 3;
    config.ncc_nearly_best = 0.97;  // so high that this filter rejects some too
    search.step = step;
    fill(random, base_edges, base, base_left, base_right);
    fill(random, current_edges, current, left, right);
    for (std::size_t i = 0; i < base.size(); ++i) {
      const bool known = random(0, 1) < 0.9;
      const float nan = std::nanf("");
      // Edges of the base are predicted 6 px farther in x.
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
      // 7 is coprime to the numbers of edges used: every left edge once.
      edges.left_index.push_back(count == 0 ? 0 : 7 * i % count);
      edges.right_index.push_back(i);
      const float x = static_cast<float>(random(-4, kImageWidth + 3)),
                  y = static_cast<float>(random(-4, kImageHeight + 3));
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

  /// Descriptions by stereo edge, as the reference expects them.
  static reference::EdgeDescriptions described(const std::vector<std::int8_t>& patches,
                                               const std::vector<std::int32_t>& numbers) {
    reference::EdgeDescriptions set;
    for (const auto number : numbers) {
      const auto begin = patches.begin() + static_cast<std::ptrdiff_t>(number) * kEdgePatchBytes;
      set.patches.insert(set.patches.end(), begin, begin + kEdgePatchBytes);
    }
    set.sift.resize(numbers.size() * kEdgeSiftBytes);  // no filter asks
    return set;
  }
  reference::TemporalMatchResult expected() const {
    const auto of_base_left = described(base_left, base.left_index), of_left = described(left, current.left_index),
               of_base_right = described(base_right, base.right_index),
               of_right = described(right, current.right_index);
    return reference::temporal_match(search, current, {of_base_left, of_left, kImageWidth, kImageHeight},
                                     {of_base_right, of_right, kImageWidth, kImageHeight}, config);
  }
  static void upload_rig(opencl::Context& context, const StereoEdges& edges, const std::vector<std::int8_t>& of_left,
                         const std::vector<std::int8_t>& of_right, stages::DeviceStereoEdges& stereo_edges) {
    stereo_edges.count = stereo_edges.stride = static_cast<int>(edges.size());
    stereo_edges.packed.write(context, packed<float>({&edges.left_x, &edges.left_y, &edges.left_direction}));
    stereo_edges.left_index.write(context, edges.left_index);
    stereo_edges.left_patches.write(context, of_left);
    stereo_edges.right_patches.write(context, of_right);
  }
  /// The quads of every variant except the lists on every device, beside the reference's; `fits`: whether the rows fit.
  std::size_t compare_devices(bool fits = true) const {
    const auto truth = expected();
    check_stage("temporal_match", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      stages::TemporalMatch stage(context, config, variants);
      if (!stage.serves(search)) return {};
      stages::DeviceStereoEdges device_base, device_current;
      upload_rig(context, base, base_left, base_right, device_base);
      upload_rig(context, current, left, right, device_current);
      stages::DevicePositions edges, predicted;
      edges.write(context, {current.positions(Side::left), current.positions(Side::right)});
      stages::DevicePointIndex left_index(kImageWidth, kImageHeight), right_index(kImageWidth, kImageHeight);
      stages::PointIndex(context, variants).run(edges.list(0), edges.list(1), left_index, right_index);
      predicted.write(context, {search.left, search.right});
      TemporalMatches found;
      const bool fitted =
          stage.run(predicted, search, device_base, device_current, left_index, right_index, current, found);
      StageArrays arrays{{"fits", std::vector{fitted ? 1 : 0}, std::vector{fits ? 1 : 0}}};
      if (!fits) return arrays;
      for (auto& array : arrays_of(found, truth.matches)) arrays.push_back(std::move(array));
      arrays.emplace_back("alive", std::vector{found.alive_left, found.alive_right},
                          std::vector{truth.matches.alive_left, truth.matches.alive_right});
      return arrays;
    });
    return truth.matches.size();
  }
};

}  // namespace

TEST_CASE("temporal match: the single kernel equals the reference's cascade bit for bit", "[device]") {
  for (const std::uint64_t seed : {3, 13, 23}) {
    const TemporalScene scene(600, 2400, seed);
    const auto& state = scene.expected().left.scores.state;
    for (const auto filter : {TemporalFilter::ncc, TemporalFilter::nearly_best_ncc, TemporalFilter::agreement})
      CHECK(std::count(state.begin(), state.end(), order_of(filter)) > 20);  // all of them are compared
    CHECK(scene.compare_devices() > 100);
  }
  CHECK(TemporalScene(601, 2399, 4, 3).compare_devices() > 30);
}

TEST_CASE("temporal match: few edges, and none", "[device][oclgrind]") {
  TemporalScene(5, 60, 5).compare_devices();
  TemporalScene(3, 0, 6).compare_devices();
  TemporalScene(0, 4, 7).compare_devices();
}

TEST_CASE("temporal match: a row with too many candidates is reported", "[device][oclgrind]") {
  TemporalScene scene(3, 170, 8);
  for (std::size_t j = 0; j < 170; ++j) {
    scene.current.left_x[j] = scene.base.left_x[2] + 6;
    scene.current.left_y[j] = scene.base.left_y[2];
    scene.current.left_direction[j] = scene.base.left_direction[2];
  }
  scene.search.left.x[2] = scene.base.left_x[2] + 6;
  scene.search.left.y[2] = scene.base.left_y[2];
  scene.compare_devices(false);
}
