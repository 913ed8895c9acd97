#include "reference/stereo_mutual.hpp"

#include <cmath>
#include <map>

namespace quadedge::reference {

StereoEdges stereo_mutual(const StereoClusters& clusters, const StereoRelaxation& relaxation, const EdgeSet& left,
                          const EpipolarGeometry& geometry, const StereoConfig& config) {
  const auto& best = relaxation.chosen;
  std::map<std::int32_t, std::size_t> owner;  // right edge -> its best left edge
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const auto [entry, is_new] = owner.emplace(clusters.anchor[c], i);
    if (!is_new && relaxation.score[i] > relaxation.score[entry->second]) entry->second = i;
  }
  StereoEdges edges;
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const std::size_t best_left = owner.at(clusters.anchor[c]);
    if (std::hypot(left.x[best_left] - left.x[i], left.y[best_left] - left.y[i]) > config.mutual_radius) continue;
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    edges.left_index.push_back(static_cast<std::int32_t>(i));
    edges.right_index.push_back(clusters.anchor[c]);
    edges.left_x.push_back(left.x[i]);
    edges.left_y.push_back(left.y[i]);
    edges.left_direction.push_back(left.direction[i]);
    edges.left_scale_drift.push_back(left.scale_drift[i]);
    edges.right_x.push_back(static_cast<float>(line.x + clusters.position[c] * line.ex));
    edges.right_y.push_back(static_cast<float>(line.y + clusters.position[c] * line.ey));
    edges.right_direction.push_back(static_cast<float>(clusters.direction[c]));
    edges.ncc.push_back(static_cast<float>(clusters.similarity[c]));
  }
  return edges;
}

}  // namespace quadedge::reference
