/// \file test_paper_clusters.cpp  Clusters of the paper's method on every device, and whole cascades behind the
/// filters, against the plain form.
#include "common/matching_constants.hpp"
#include "geometry/disparity_range.hpp"
#include "paper_lists.hpp"

using namespace quadedge;
using namespace matching;

namespace {

using Rows = std::vector<std::vector<paper::Hypothesis>>;

/// Whether the members are the cluster's, the nearest first, to a step of the distance.
bool sorted_alike(const std::vector<paper::Hypothesis>& row, const paper::Cluster& cluster,
                  const std::vector<std::int32_t>& members) {
  if (!std::is_permutation(members.begin(), members.end(), cluster.members.begin(), cluster.members.end()))
    return false;
  const auto distance = [&](std::int32_t target) {
    const auto& at = row[static_cast<std::size_t>(target - row.front().target)].position;
    return (at - Eigen::Vector2d(cluster.centre.x, cluster.centre.y)).norm();
  };
  for (std::size_t k = 1; k < members.size(); ++k)
    if (distance(members[k - 1]) > distance(members[k]) + static_cast<double>(kClusterDistanceStep) + 5e-4)
      return false;
  return true;
}

/// Clusters the hypotheses, whose targets count from 0 to the last row's end, on every device.
void compare_clusters(const Rows& rows) {
  PaperLists lists;
  lists.candidates.first.push_back(0);
  std::vector<float> x, y;
  for (const auto& row : rows) {
    for (const paper::Hypothesis& hypothesis : row) {
      lists.candidates.target.push_back(hypothesis.target);
      lists.moving.direction.push_back(hypothesis.direction);
      x.push_back(static_cast<float>(hypothesis.position.x()));
      y.push_back(static_cast<float>(hypothesis.position.y()));
    }
    lists.candidates.first.push_back(static_cast<std::int32_t>(x.size()));
  }
  lists.moving.x = lists.moving.y = lists.moving.strength = lists.moving.scale_shift = lists.moving.direction;
  x.insert(x.end(), y.begin(), y.end());
  check_stage("paper_clusters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    auto candidates = upload(context, lists.candidates);
    const auto moving = upload(context, lists.moving);
    opencl::Buffer<cl_float> refined;
    refined.write(context, x);
    stages::PaperClusters stage(context, variants);
    stages::DevicePaperClusters clusters;
    stage.cluster(moving.positions(), candidates, refined, clusters);
    const auto found = clusters.read(false);
    std::size_t different = 0;
    constexpr float kRounded = 2e-4F;  // px, of coordinates up to 1,220
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto truth = paper::clusters_of(rows[i]);
      const auto from = static_cast<std::size_t>(found.first[i]);
      bool same = truth.size() == static_cast<std::size_t>(found.first[i + 1]) - from;
      for (std::size_t k = 0; same && k < truth.size(); ++k) {
        const std::vector<std::int32_t> members(found.members.begin() + found.member_first[from + k],
                                                found.members.begin() + found.member_first[from + k + 1]);
        same = sorted_alike(rows[i], truth[k], members) && std::abs(found.x[from + k] - truth[k].centre.x) < kRounded &&
               std::abs(found.y[from + k] - truth[k].centre.y) < kRounded &&
               std::abs(std::remainder(found.direction[from + k] - truth[k].centre.direction,
                                       static_cast<float>(2 * kPi))) < 1e-5F;
      }
      different += same ? 0 : 1;
    }
    CHECK(different == 0);
    return {{"first", found.first},
            {"members", found.members},
            {"x", found.x},
            {"y", found.y},
            {"direction", found.direction}};
  });
}

Rows random_rows(int count, int most, double extent, std::uint64_t seed) {
  Rows rows;
  Random random(seed);
  std::int32_t target = 0;
  for (int i = 0; i < count; ++i) {
    rows.emplace_back();
    const int size = static_cast<int>(random(0, most + 0.999));
    const double direction = random(-kPi, kPi), x = random(0, 1200), y = random(0, 400);
    for (int k = 0; k < size; ++k)
      rows.back().push_back({{static_cast<float>(x + random(0, extent)), static_cast<float>(y + random(0, extent))},
                             static_cast<float>(std::remainder(direction + random(-0.4, 0.4), 2 * kPi)),
                             target++});
  }
  return rows;
}

StereoConfig paper_config() {
  StereoConfig config;
  config.refine_steps = 20;
  config.refine_tolerance = 1e-3;
  config.ncc_min = 0.3;
  config.refined_ncc_min = 0.6;
  return config;
}

/// Edges of all directions on a grid, at odd places.
EdgeSet grid_of_edges(int width, int height, int step, double dx, double dy, std::uint64_t seed) {
  std::vector<Edge> edges;
  Random random(seed);
  Random directions(11);
  for (int y = 3; y < height - 3; y += step + 1)
    for (int x = 3; x < width - 3; x += step)
      edges.push_back({x + dx + random(-0.4, 0.4), y + dy + random(-0.4, 0.4), directions(-kPi, kPi)});
  return make_edges(edges, height);
}

/// The stereo cascade behind the filters, with an edge every `step` px.
void compare_cascade(const StereoRig& rig, int step, std::size_t expected) {
  const StereoConfig config = paper_config();
  const double offset = 5;
  const EpipolarGeometry geometry = make_epipolar_geometry(rig, with_disparity_range({}, rig).stereo);
  const Image left = paper_image(rig.left.width, rig.left.height, 0, 0),
              right = paper_image(rig.right.width, rig.right.height, -2.3, 0);
  const auto view_of = [&](const Image& image, const EdgeSet& edges) {
    paper::Picture picture(image.view());
    auto described = paper::describe(image.view(), picture, edges.positions(), offset);
    return paper::View{std::move(picture), edges, std::move(described)};
  };
  const auto in_left = view_of(left, grid_of_edges(rig.left.width, rig.left.height, step, 0, 0, 1)),
             in_right = view_of(right, grid_of_edges(rig.right.width, rig.right.height, step, -2.3, 0, 2));
  const auto truth = paper::match_stereo(in_left, in_right, geometry, config, offset, false);
  check_stage("paper_clusters", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    const PaperOnDevice a(context, left, in_left.edges, offset), b(context, right, in_right.edges, offset);
    auto candidates = upload(context, truth.candidates);
    upload(context, truth.scores, candidates);
    stages::PaperRefinement refinement(context, config, variants);
    stages::PaperClusters clustering(context, variants);
    stages::DevicePaperClusters clusters;
    opencl::Buffer<cl_float> refined;
    refinement.in_stereo(a.view(), b.view(), geometry, candidates, refined);
    clustering.cluster(b.edges.positions(), candidates, refined, clusters);
    clustering.compare(b.stage.picture(), a.patches, offset, config.refined_ncc_min, clusters);
    const auto found = clusters.read(true);
    std::size_t different = 0, chosen = 0;
    for (std::size_t i = 0; i < in_left.edges.size(); ++i) {
      const std::int32_t p = truth.chosen[i], q = found.chosen[i];
      bool same = (p < 0) == (q < 0);
      if (same && p >= 0) {
        ++chosen;
        const auto k = static_cast<std::size_t>(p), l = static_cast<std::size_t>(q);
        const EpipolarLine line = epipolar_line(geometry, in_left.edges.x[i], in_left.edges.y[i]);
        const double x = line.x + truth.clusters.position[k] * line.ex;
        same = std::abs(x - static_cast<double>(found.x[l])) < 3e-3 &&
               std::abs(truth.clusters.similarity[k] - static_cast<double>(found.similarity[l])) < 1e-3 &&
               truth.clusters.anchor[k] == found.members[static_cast<std::size_t>(found.member_first[l])];
      }
      different += same ? 0 : 1;
    }
    CHECK(chosen > expected);
    CHECK(different <= 1 + in_left.edges.size() / 100);
    return {{"chosen", found.chosen}, {"x", found.x}, {"similarity", found.similarity}};
  });
}

}  // namespace

TEST_CASE("paper clusters: as the plain form, at any number of candidates", "[device]") {
  compare_clusters({});
  compare_clusters({{}, {{{10, 5}, 0.5F, 0}}, {}});
  compare_clusters(random_rows(301, 9, 4, 1));
  compare_clusters(random_rows(97, 40, 6, 2));
  compare_clusters(random_rows(5, 400, 20, 3));
}

TEST_CASE("paper clusters: members at one place, and chains without gaps", "[device]") {
  Rows rows(2);
  for (int k = 0; k < 13; ++k) rows[0].push_back({{50, 20}, 3.1F, k});
  for (int k = 0; k < 23; ++k) rows[1].push_back({{0.25 * k, 0.125 * k}, k % 2 == 0 ? 3.1F : -3.1F, 13 + k});
  compare_clusters(rows);
}

TEST_CASE("paper clusters: the stereo cascade behind the filters as the plain form", "[device]") {
  compare_cascade(flat_rig(131, 97), 4, 50);
  compare_cascade(crooked_rig(), 4, 50);
}

TEST_CASE("paper clusters: the stereo cascade of a few edges", "[device][oclgrind]") {
  compare_cascade(flat_rig(39, 31), 7, 1);
}
