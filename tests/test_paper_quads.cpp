/// \file test_paper_quads.cpp  Quads of the paper's method on every device, and its whole front end, against the plain
/// form.
#include "device/paper_matching.hpp"
#include "frontends.hpp"
#include "paper/cascades.hpp"
#include "paper_lists.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// Rows of clusters in an image whose members are some of `edges` current edges.
paper::SideMatching made_up_side(int rows, int edges, std::uint64_t seed) {
  paper::SideMatching side;
  Random random(seed);
  side.candidates.first.push_back(0);
  for (int i = 0; i < rows; ++i) {
    side.clusters.emplace_back();
    const int clusters = i % 7 == 0 ? 0 : static_cast<int>(random(0, 4.999));
    int edge = static_cast<int>(random(0, 3.999));
    for (int k = 0; k < clusters; ++k) {
      paper::Cluster cluster;
      cluster.centre = {static_cast<float>(random(0, 700)), static_cast<float>(random(0, 400)),
                        static_cast<float>(random(-kPi, kPi))};
      for (int m = static_cast<int>(random(1, 3.999)); m > 0 && edge < edges; --m, edge += 1 + (m % 2))
        cluster.members.push_back(edge);
      if (cluster.members.empty()) continue;
      std::swap(cluster.members.front(), cluster.members.back());
      for (const auto member : cluster.members) {
        side.candidates.target.push_back(member);
        side.scores.ncc.push_back(static_cast<float>(random(0.8, 1)));
      }
      side.clusters.back().push_back(cluster);
    }
    side.candidates.first.push_back(static_cast<std::int32_t>(side.candidates.target.size()));
  }
  return side;
}

struct SideOnDevice {
  stages::DeviceCandidates candidates;
  stages::DevicePaperClusters clusters;

  SideOnDevice(opencl::Context& context, const paper::SideMatching& side)
      : candidates(upload(context, side.candidates)) {
    const auto size = static_cast<std::size_t>(candidates.capacity), rows = side.clusters.size();
    clusters.stride = candidates.capacity;
    std::vector<cl_float> packed(4 * size), ncc(size);
    std::vector<cl_int> starts(2 * size), members(size), counts(rows);
    std::copy(side.scores.ncc.begin(), side.scores.ncc.end(), ncc.begin());
    for (std::size_t i = 0; i < rows; ++i) {
      auto at = static_cast<std::size_t>(side.candidates.first[i]), k = at;
      counts[i] = static_cast<cl_int>(side.clusters[i].size());
      for (const paper::Cluster& cluster : side.clusters[i]) {
        packed[k] = cluster.centre.x;
        packed[size + k] = cluster.centre.y;
        packed[2 * size + k] = cluster.centre.direction;
        starts[k] = static_cast<cl_int>(at);
        starts[size + k++] = static_cast<cl_int>(cluster.members.size());
        for (const auto member : cluster.members) members[at++] = member;
      }
    }
    candidates.ncc.write(context, ncc);
    clusters.packed.write(context, packed);
    clusters.count.write(context, counts);
    clusters.first.write(context, side.candidates.first);
    clusters.member_first.write(context, starts);
    clusters.members.write(context, members);
  }
};

RenderedScene paper_scene(const std::string& name) {
  RenderedScene scene(name, 163, 101, 2);
  scene.config = read_preset("paper");
  scene.config.stereo.max_disparity = scene.rig.max_disparity;
  return scene;
}

}  // namespace

TEST_CASE("paper quads: as the plain form, byte by byte", "[device][oclgrind]") {
  for (const int rows : {1, 3, 501}) {
    const auto left = made_up_side(rows, 20, 3), right = made_up_side(rows, 20, 4);
    const TemporalMatches truth = paper::quads_of(left, right);
    check_stage("paper_quads", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
      INFO(rows << " rows, " << truth.size() << " quads");
      const SideOnDevice in_left(context, left), in_right(context, right);
      stages::PaperQuads stage(context, variants);
      TemporalMatches found;
      stage.run({in_left.candidates, in_left.clusters}, {in_right.candidates, in_right.clusters}, found);
      CHECK((rows < 500 || truth.size() > 100));
      CHECK(found.alive_left == truth.alive_left);
      CHECK(found.alive_right == truth.alive_right);
      return arrays_of(found, truth);
    });
  }
}

TEST_CASE("paper quads: the front ends of the paper's method agree on rendered scenes", "[device]") {
  for (const char* name : {"room", "cables"}) {
    const RenderedScene scene = paper_scene(name);
    const auto plain = run_frontend(scene, "reference");
    CHECK(plain.current.size() > 1000);
    CHECK(plain.quads.size() > 500);
    for (const std::string& device : all_devices()) {
      INFO(name << " on " << device);
      const auto found = run_frontend(scene, device);
      CHECK(std::abs(static_cast<double>(found.left_edges.size()) - static_cast<double>(plain.left_edges.size())) <=
            2 + 0.001 * static_cast<double>(plain.left_edges.size()));
      CHECK(agreement(found.current, plain.current) > 0.99);
      CHECK(agreement(found.quads, plain.quads) > 0.98);
      CHECK(same_bytes(found, run_frontend(scene, device)));
    }
  }
}
