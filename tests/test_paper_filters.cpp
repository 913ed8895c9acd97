/// \file test_paper_filters.cpp  Candidates of the paper's method and the filters on them on devices, against
/// host/workbench/paper/cascades.cpp.
#include "common/matching_constants.hpp"
#include "device/paper_matching.hpp"
#include "device/stereo_matching.hpp"
#include "device/temporal_matching.hpp"
#include "edge_images.hpp"
#include "matching.hpp"
#include "paper/cascades.hpp"
#include "paper/grid_edges.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr int kPaperWidth = 143, kPaperHeight = 97, kPaperShift = 6;
constexpr double kPaperOffset = 5;  // of patches, px

/// A texture, a part of it that is seen from 6 px further right, and its negative: directions that differ by half a
/// turn.
struct PaperViews {
  Image left = shifted(0), right = shifted(kPaperShift);
  paper::View in_left, in_right;

  PaperViews() : in_left(view_of(left)), in_right(view_of(right)) {}

  static Image shifted(int shift) {
    const Image wide = textured_image(kPaperWidth + kPaperShift, kPaperHeight);
    return filled_image(kPaperWidth, kPaperHeight, [&](int x, int y) {
      const int grey = static_cast<int>(wide.view().at(x + shift, y));
      return shift > 0 && y > kPaperHeight / 2 ? 255 - grey : grey;
    });
  }
  static paper::View view_of(const Image& image) {
    EdgesConfig config;
    paper::Picture picture(image.view());
    EdgeSet edges = reference::to_edge_set(paper::grid_edges(image.view(), config, 2));
    auto described = paper::describe(image.view(), picture, edges.positions(), kPaperOffset);
    return {std::move(picture), std::move(edges), std::move(described)};
  }
};

const PaperViews& paper_views() {
  static const PaperViews views;
  return views;
}

EpipolarGeometry paper_geometry() {
  StereoConfig config;
  config.max_disparity = 20;
  config.epipolar_distance = 0.5;
  config.orientation = 10;
  return make_epipolar_geometry(flat_rig(kPaperWidth, kPaperHeight, 120), config);
}

StereoConfig paper_stereo_config() {
  StereoConfig config;
  config.refine_steps = 1;
  config.ncc_min = 0.6;
  config.sift_max = 500;
  config.ncc_nearly_best = 0.9;
  return config;
}

/// In the layout of kPaperPatchFloats in kernels/layouts.cl.
std::vector<cl_float> patches_for_filters(const std::vector<paper::SidePatches>& patches) {
  std::vector<cl_float> packed;
  for (const auto& edge : patches) {
    for (std::size_t row = 0; row < kPaperPatchRows; ++row)
      for (const auto& side : edge.sides)
        packed.insert(packed.end(), side.begin() + static_cast<std::ptrdiff_t>(8 * row),
                      side.begin() + static_cast<std::ptrdiff_t>(8 * row + 8));
    packed.insert(packed.end(), edge.inverse_norm.begin(), edge.inverse_norm.end());
    packed.resize(packed.size() + 14, 0.0F);
  }
  return packed;
}

/// A set of described edges on a device.
struct DescriptionsForFilters {
  opencl::Buffer<cl_float> patches;
  opencl::Buffer<cl_int> itself;
  opencl::Buffer<cl_uchar> sift;

  DescriptionsForFilters(opencl::Context& context, const paper::Described& described) {
    patches.write(context, patches_for_filters(described.patches));
    std::vector<cl_int> numbers(described.patches.size());
    std::iota(numbers.begin(), numbers.end(), 0);
    itself.write(context, numbers);
    sift.write(context, described.sift);
  }
  stages::PaperDescribedEdges edges() const { return {patches, itself, sift}; }
};

/// NCC within 1e-5, SIFT distances within 1e-3, states but where a score is as close to its threshold.
void check_paper_filters(const reference::Candidates& lists, const paper::Described& a, const paper::Described& b,
                         const FilterLimits& limits, bool all_scores) {
  const auto truth = paper::judge(lists, a, b, limits, all_scores);
  check_stage("paper_filters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::PaperFilters stage(context, variants);
    const DescriptionsForFilters on_a(context, a), on_b(context, b);
    const std::size_t size = lists.target.size();
    auto device = upload(context, lists);
    stage.run(on_a.edges(), on_b.edges(), limits, 1, all_scores, device);
    const auto ncc = device.ncc.read(size), sift = device.sift.read(size);
    const auto state = device.state.read(size);
    const auto alive = device.alive.read(static_cast<std::size_t>(device.rows));
    auto decided_sift = sift;
    for (std::size_t c = 0; c < size; ++c)
      if (std::abs(truth.ncc[c] - limits.ncc_min) < 1e-5F) decided_sift[c] = truth.sift[c];
    const auto living = static_cast<std::size_t>(std::count(state.begin(), state.end(), kCandidateAlive));
    CHECK(living == static_cast<std::size_t>(std::accumulate(alive.begin(), alive.end(), 0)));
    CHECK(living > size / 50);
    CHECK(living < size);
    return {{"ncc", ncc, truth.ncc, {1e-5}},
            {"all distances", sift},
            {"distances", decided_sift, truth.sift, {1e-3}},
            {"state", state, truth.state, {0, 2}}};  // of thousands
  });
}

}  // namespace

TEST_CASE("paper candidates: in stereo, devices list what the plain form lists", "[device]") {
  const PaperViews& views = paper_views();
  const EpipolarGeometry geometry = paper_geometry();
  const auto truth =
      paper::match_stereo(views.in_left, views.in_right, geometry, paper_stereo_config(), kPaperOffset, false)
          .candidates;
  REQUIRE(truth.target.size() > 2 * views.in_left.edges.size());
  check_stage("stereo_candidates", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::StereoCandidates stage(context, variants, stages::Turns::half);
    const auto left = upload(context, views.in_left.edges), right = upload(context, views.in_right.edges);
    stages::DeviceCandidates found;
    stage.run(left, right, kPaperHeight, geometry, {0, 0}, found);
    const auto lists = found.read();
    return {{"first", lists.first, truth.first}, {"target", lists.target, truth.target}};
  });
}

TEST_CASE("paper candidates: in time, devices list what the plain form lists", "[device]") {
  const PaperViews& views = paper_views();
  const auto &before = views.in_left, &now = views.in_right;
  for (const double orientation : {10 * kDegree, 2 * kPi}) {
    const auto truth = paper::near_previous(before.edges.positions(), now.edges.positions(), kPaperWidth, kPaperHeight,
                                            9.5, orientation);
    check_stage("temporal_candidates", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      INFO(orientation);
      stages::TemporalCandidates stage(context, variants, stages::Turns::half);
      stages::PointIndex indexing(context, {});
      const auto from = upload(context, before.edges), to = upload(context, now.edges);
      stages::DevicePointIndex index(kPaperWidth, kPaperHeight), unused(kPaperWidth, kPaperHeight);
      indexing.run(to.positions(), to.positions(), index, unused);
      stages::DeviceCandidates found;
      stage.run(from.positions(), 1, index, 9.5F, static_cast<float>(orientation), found);
      const auto lists = found.read();
      return {{"first", lists.first, truth.first}, {"target", lists.target, truth.target}};
    });
  }
}

TEST_CASE("paper filters: devices agree with the plain form on candidates in stereo and in time", "[device]") {
  const PaperViews& views = paper_views();
  const auto stereo =
      paper::match_stereo(views.in_left, views.in_right, paper_geometry(), paper_stereo_config(), kPaperOffset, false)
          .candidates;
  check_paper_filters(stereo, views.in_left.described, views.in_right.described, {0.6F, 500, 0.9F, 0.4F, 5, 4}, true);
  check_paper_filters(stereo, views.in_left.described, views.in_right.described, {0.6F, 500, 0.9F, 0.4F, 5, 4}, false);
  check_paper_filters(stereo, views.in_left.described, views.in_right.described, {0.8F, 200, 0.8F, 0.8F, 3, 4}, false);
}

TEST_CASE("paper filters: flat patches are similar to none", "[device][oclgrind]") {
  paper::Described flat, other;
  flat.patches.resize(2);
  other.patches.resize(1);
  flat.patches[1].sides[1][3] = -2;
  flat.patches[1].inverse_norm[1] = 0.5F;
  other.patches[0].sides[0][3] = 4;
  other.patches[0].inverse_norm[0] = 0.25F;
  flat.sift.resize(2 * kEdgeSiftBytes);
  other.sift.resize(kEdgeSiftBytes);
  const reference::Candidates lists{{0, 1, 2}, {0, 0}};
  check_stage("paper_filters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::PaperFilters stage(context, variants);
    const DescriptionsForFilters on_a(context, flat), on_b(context, other);
    auto device = upload(context, lists);
    stage.run(on_a.edges(), on_b.edges(), {0.6F, 500, 0.9F, 0.4F, 5, 4}, 1, true, device);
    return {{"ncc", device.ncc.read(2), std::vector{-1, -1}}, {"state", device.state.read(2), std::vector{5, 5}}};
  });
  CHECK(paper::best_pairing(flat.patches[0], other.patches[0]).ncc == -1);
  CHECK(paper::best_pairing(flat.patches[1], other.patches[0]).ncc == -1);
}
