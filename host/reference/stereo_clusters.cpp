#include "reference/stereo_clusters.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "reference/photometric.hpp"

namespace quadedge::reference {
namespace {

constexpr double kPi = 3.14159265358979323846;
/// Members whose distances to the centroid differ by less are equally near: the first right edge in scan order counts [px]. Members
/// that the refinement led to the same place, and the two of a pair, always are; rounding must not choose between them.
constexpr double kAnchorTie = 1e-2;

/// Highest NCC of patches cut at a place with the stored patches (98 floats) of an edge; -1 where both are flat.
double representative_ncc(const float* stored, const ImageView& image, double x, double y, double direction, double offset) {
  double best = -1;
  for (const double side : {1.0, -1.0}) {
    const auto values = cut_patch(image, patch_frame(x, y, std::cos(direction), std::sin(direction), side, offset), 0, 0);
    double squares = 0, dark = 0, bright = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      squares += values[k] * values[k];
      dark += values[k] * static_cast<double>(stored[k]);
      bright += values[k] * static_cast<double>(stored[values.size() + k]);
    }
    if (squares >= 1e-10) best = std::max(best, std::max(dark, bright) / std::sqrt(squares));
  }
  return best;
}

}  // namespace

StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores, const std::vector<double>& places,
                               const EdgeSet& right, const StereoConfig& config) {
  StereoClusters clusters;
  clusters.first.assign(1, 0);
  for (std::size_t i = 0; i + 1 < candidates.first.size(); ++i) {
    std::vector<std::size_t> alive;
    for (auto c = static_cast<std::size_t>(candidates.first[i]); c < static_cast<std::size_t>(candidates.first[i + 1]); ++c) {
      if (scores.rejected_by[c] == 0) alive.push_back(c);
    }
    std::stable_sort(alive.begin(), alive.end(), [&](std::size_t a, std::size_t b) { return places[a] < places[b]; });
    const auto direction = [&](std::size_t c) { return right.direction[static_cast<std::size_t>(candidates.target[c])]; };
    for (std::size_t from = 0, to = 0; from < alive.size(); from = to) {
      to = from + 1;
      while (to < alive.size() && static_cast<int>(to - from) < config.cluster_size_max &&
             places[alive[to]] - places[alive[to - 1]] < config.cluster_gap &&
             line_angle_between(direction(alive[to]), direction(alive[to - 1])) <= config.cluster_orientation * kPi / 180) {
        ++to;
      }
      double centroid = 0;
      for (std::size_t k = from; k < to; ++k) centroid += places[alive[k]] / static_cast<double>(to - from);
      double cosine = 0, sine = 0, nearest = std::numeric_limits<double>::infinity();
      for (std::size_t k = from; k < to; ++k) {
        const double distance = std::abs(places[alive[k]] - centroid);
        const double weight = std::exp(-0.5 * std::pow(distance / config.cluster_sigma, 2));
        cosine += weight * std::cos(2.0 * direction(alive[k]));
        sine += weight * std::sin(2.0 * direction(alive[k]));
        nearest = std::min(nearest, distance);
      }
      std::int32_t anchor = std::numeric_limits<std::int32_t>::max();
      for (std::size_t k = from; k < to; ++k) {
        if (std::abs(places[alive[k]] - centroid) <= nearest + kAnchorTie) anchor = std::min(anchor, candidates.target[alive[k]]);
      }
      double mean = 0.5 * std::atan2(sine, cosine);
      if (angle_between(static_cast<float>(mean), right.direction[static_cast<std::size_t>(anchor)]) > 0.5 * kPi) mean += mean > 0 ? -kPi : kPi;
      clusters.place.push_back(centroid);
      clusters.direction.push_back(mean);
      clusters.anchor.push_back(anchor);
    }
    clusters.first.push_back(static_cast<std::int32_t>(clusters.place.size()));
  }
  return clusters;
}

std::vector<std::int32_t> stereo_best(StereoClusters& clusters, const EdgeSet& left, const std::vector<float>& left_patches,
                                      const ImageView& right_image, const stages::EpipolarGeometry& geometry,
                                      const StereoConfig& config, double patch_offset) {
  std::vector<std::int32_t> best(left.size(), -1);
  clusters.ncc.assign(clusters.place.size(), -1.0);
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    for (std::int32_t k = clusters.first[i]; k < clusters.first[i + 1]; ++k) {
      const auto c = static_cast<std::size_t>(k);
      clusters.ncc[c] = representative_ncc(left_patches.data() + 98 * i, right_image, line.x + clusters.place[c] * line.ex,
                                           line.y + clusters.place[c] * line.ey, clusters.direction[c], patch_offset);
      if (clusters.ncc[c] >= config.ncc_min && (best[i] < 0 || clusters.ncc[c] > clusters.ncc[static_cast<std::size_t>(best[i])])) {
        best[i] = k;
      }
    }
  }
  return best;
}

StereoEdges stereo_mutual(const StereoClusters& clusters, const std::vector<std::int32_t>& best, const EdgeSet& left,
                          const stages::EpipolarGeometry& geometry, const StereoConfig& config) {
  std::map<std::int32_t, std::size_t> owner;  // right edge -> its best left edge
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const auto [entry, is_new] = owner.emplace(clusters.anchor[c], i);
    if (!is_new && clusters.ncc[c] > clusters.ncc[static_cast<std::size_t>(best[entry->second])]) entry->second = i;
  }
  StereoEdges edges;
  for (std::size_t i = 0; i < best.size(); ++i) {
    if (best[i] < 0) continue;
    const auto c = static_cast<std::size_t>(best[i]);
    const std::size_t rival = owner.at(clusters.anchor[c]);
    if (std::hypot(left.x[rival] - left.x[i], left.y[rival] - left.y[i]) > config.mutual_radius) continue;
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    edges.left_index.push_back(static_cast<std::int32_t>(i));
    edges.right_index.push_back(clusters.anchor[c]);
    edges.left_x.push_back(left.x[i]);
    edges.left_y.push_back(left.y[i]);
    edges.left_direction.push_back(left.direction[i]);
    edges.right_x.push_back(static_cast<float>(line.x + clusters.place[c] * line.ex));
    edges.right_y.push_back(static_cast<float>(line.y + clusters.place[c] * line.ey));
    edges.right_direction.push_back(static_cast<float>(clusters.direction[c]));
    edges.ncc.push_back(static_cast<float>(clusters.ncc[c]));
  }
  return edges;
}

}  // namespace quadedge::reference
