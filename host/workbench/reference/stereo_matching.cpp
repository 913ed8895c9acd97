/// \file stereo_matching.cpp  Candidates, alignment along the lines, clusters, relaxation, mutual choice.
#include "reference/stereo_matching.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "common/filter_limits.hpp"
#include "common/matching_constants.hpp"
#include "common/numeric.hpp"
#include "reference/edge_descriptions.hpp"

namespace quadedge::reference {
namespace {

double distance_from(const EpipolarLine& line, double x, double y) {
  return -(x - line.x) * line.ey + (y - line.y) * line.ex;
}

/// The clusters of all edges as their neighbours see them.
class Neighbourhood {
 public:
  Neighbourhood(const StereoClusters& clusters, const EdgeSet& left, const EpipolarGeometry& geometry, int width,
                int height)
      : clusters_(clusters), left_(left), columns_(relaxation_cells(width)), rows_(relaxation_cells(height)) {
    cells_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < left.size(); ++i) {
      const double cosine = std::cos(static_cast<double>(left.direction[i]));
      const double sine = std::sin(static_cast<double>(left.direction[i]));
      const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
      const EpipolarLine ahead =
          epipolar_line(geometry, left.x[i] + static_cast<float>(cosine), left.y[i] + static_cast<float>(sine));
      for (auto k = begin(i); k < end(i); ++k) {
        const double slope = position_slope(line, ahead, clusters.position[k], clusters.direction[k]);
        slope_x_.push_back(slope * cosine);
        slope_y_.push_back(slope * sine);
      }
    }
  }

  std::size_t begin(std::size_t i) const { return static_cast<std::size_t>(clusters_.first[i]); }
  std::size_t end(std::size_t i) const { return static_cast<std::size_t>(clusters_.first[i + 1]); }

  /// Edge i represents its cell, unless the cell has a representative.
  void enter(std::size_t i) {
    auto& cell = cells_[cell_of(left_.x[i], left_.y[i]).value()];
    if (!cell) cell = i;
  }

  /// Whether the coarse disparity knows a position near that of a cluster, at edge i or beside it.
  bool is_seconded(std::size_t i, std::size_t candidate, const CoarseDisparity& coarse_disparity) const {
    const int column = static_cast<int>(0.5F * left_.x[i]), row = static_cast<int>(0.5F * left_.y[i]);
    if (row >= coarse_disparity.search.height) return false;
    for (int x = std::max(column - kBeside, 0); x <= std::min(column + kBeside, coarse_disparity.search.width - 1);
         ++x) {
      const float coarse =
          coarse_disparity.positions[static_cast<std::size_t>(row * coarse_disparity.search.width + x)];
      if (std::abs(static_cast<float>(clusters_.position[candidate]) - coarse) < kCoarseReach) return true;
    }
    return false;
  }

  /// Mean vote of the neighbours of edge i for one of its clusters; 0 without neighbours.
  double support(std::size_t i, std::size_t candidate, const std::vector<double>& belief) const {
    double sum = 0;
    int voters = 0;
    for (std::size_t n = 0; n < kRelaxationNeighbours; ++n) {
      const float radius = kRelaxationRing[n / 8];
      const auto cell =
          cell_of(left_.x[i] + radius * kEighthCosine[n % 8], left_.y[i] + radius * kEighthCosine[(n + 6) % 8]);
      if (!cell || !cells_[*cell]) continue;
      sum += vote(i, candidate, *cells_[*cell], belief, static_cast<double>(kSupportReach[n / 8]));
      ++voters;
    }
    return voters > 0 ? sum / voters : 0;
  }

 private:
  /// Change of a position on the epipolar line per px along the left edge; `ahead`: the line of the point 1 px ahead.
  static double position_slope(const EpipolarLine& line, const EpipolarLine& ahead, double position, double direction) {
    const auto cross = [](double ax, double ay, double bx, double by) { return ax * by - ay * bx; };
    const double cosine = std::cos(direction), sine = std::sin(direction);
    const double across = cross(ahead.ex, ahead.ey, cosine, sine);
    if (!ahead.valid || std::abs(across) < static_cast<double>(kSlopeMinSine)) return 0;
    const double dx = line.x + position * line.ex - ahead.x, dy = line.y + position * line.ey - ahead.y;
    const auto limit = static_cast<double>(kSlopeMax);
    return std::clamp(cross(dx, dy, cosine, sine) / across - position, -limit, limit);
  }

  static constexpr int kBeside = 1;  // coarse pixels to either side of an edge that are asked, too

  /// In single precision, as on the device: an edge must not change its cell by rounding.
  std::optional<std::size_t> cell_of(float x, float y) const {
    const int column = static_cast<int>(x / kRelaxationCell), row = static_cast<int>(y / kRelaxationCell);
    if (x < 0 || y < 0 || column >= columns_ || row >= rows_) return std::nullopt;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(column);
  }

  /// The largest belief in a cluster of edge j, each weighted by its fit to a cluster of edge i.
  double vote(std::size_t i, std::size_t candidate, std::size_t j, const std::vector<double>& belief,
              double reach) const {
    const double dx = static_cast<double>(left_.x[j] - left_.x[i]), dy = static_cast<double>(left_.y[j] - left_.y[i]);
    double most = 0;
    for (auto c = begin(j); c < end(j); ++c) {
      const double expected =
          0.5 * ((slope_x_[candidate] + slope_x_[c]) * dx + (slope_y_[candidate] + slope_y_[c]) * dy);
      const double apart = (clusters_.position[c] - clusters_.position[candidate] - expected) / reach;
      most = std::max(most, belief[c] * (1 - apart * apart));
    }
    return most;
  }

  const StereoClusters& clusters_;
  const EdgeSet& left_;
  int columns_, rows_;
  std::vector<double> slope_x_, slope_y_;  ///< per cluster: change of its position per px along x, along y
  std::vector<std::optional<std::size_t>> cells_;
};

/// Divides by the sum unless it is 0.
void normalise(std::vector<double>& values, std::size_t begin, std::size_t end) {
  double total = 0;
  for (auto k = begin; k < end; ++k) total += values[k];
  for (auto k = begin; k < end && total > 0; ++k) values[k] /= total;
}

/// One more round of votes for the edges with more than one candidate, `choosers`.
void vote(const Neighbourhood& neighbourhood, const std::vector<std::size_t>& choosers,
          const std::vector<double>& prior, std::vector<double>& belief) {
  std::vector<double> next = belief;
  for (const auto i : choosers) {
    for (auto k = neighbourhood.begin(i); k < neighbourhood.end(i); ++k) {
      if (prior[k] > 0)
        next[k] = prior[k] * std::pow(static_cast<double>(kSupportFloor) + neighbourhood.support(i, k, belief), 2);
    }
    normalise(next, neighbourhood.begin(i), neighbourhood.end(i));
  }
  belief = std::move(next);
}

RelaxationTally tally_of(const Neighbourhood& neighbourhood, std::size_t edges, const std::vector<double>& belief) {
  RelaxationTally tally;
  for (std::size_t i = 0; i < edges; ++i) {
    double highest = 0;
    for (auto k = neighbourhood.begin(i); k < neighbourhood.end(i); ++k) highest = std::max(highest, belief[k]);
    tally.edges += highest > 0 ? 1 : 0;
    tally.undecided += highest > 0 && highest < static_cast<double>(kUndecided) ? 1 : 0;
  }
  return tally;
}

/// Makes the candidates of an edge less likely that the coarse disparity does not second, if it seconds another one.
void consult(const Neighbourhood& neighbourhood, std::size_t edges, const CoarseDisparity& coarse_disparity,
             std::vector<double>& prior, std::vector<double>& belief) {
  for (std::size_t i = 0; i < edges; ++i) {
    const auto begin = neighbourhood.begin(i), end = neighbourhood.end(i);
    std::vector<bool> seconded;
    bool speaks = false;
    for (auto k = begin; k < end; ++k) {
      seconded.push_back(neighbourhood.is_seconded(i, k, coarse_disparity));
      speaks = speaks || (seconded.back() && prior[k] > 0);
    }
    for (auto k = begin; k < end; ++k) {
      if (speaks && !seconded[k - begin]) prior[k] *= static_cast<double>(kCoarseDissent);
      belief[k] = prior[k];
    }
    normalise(belief, begin, end);
  }
}

}  // namespace

Candidates stereo_candidates(const EdgeSet& left, const EdgeSet& right, const EpipolarGeometry& geometry,
                             const DisparityProbe& probe) {
  Candidates candidates;
  candidates.first.assign(1, 0);
  const int last_row = static_cast<int>(right.row_first.size()) - 2;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    if (line.valid &&
        left_epipolar_sine(geometry, left.x[i], left.y[i], left.direction[i]) >= geometry.min_epipolar_sine) {
      const bool is_probe = probe.step > 0 && i % static_cast<std::size_t>(probe.step) == 0;
      const float s_max = is_probe ? std::max(line.s_max, probe.max_disparity) : line.s_max;
      const float s_low = -geometry.tolerance, s_high = s_max + geometry.tolerance;
      const float end_a = line.y + s_low * line.ey, end_b = line.y + s_high * line.ey;
      // Rows that the segment can touch; one row on either side for the sub-pixel shift.
      const float reach = geometry.epipolar_distance + 1.0f;
      const auto row = [&](float y) {
        return std::clamp(static_cast<int>(std::clamp(y, -1e6f, 1e6f)), 0, std::max(last_row, 0));
      };
      const auto begin =
          static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::min(end_a, end_b) - reach))]);
      const auto end =
          static_cast<std::size_t>(right.row_first[static_cast<std::size_t>(row(std::max(end_a, end_b) + reach)) + 1]);
      for (std::size_t j = begin; j < end; ++j) {
        const float dx = right.x[j] - line.x, dy = right.y[j] - line.y;
        const float s = dx * line.ex + dy * line.ey;
        const float distance = std::fabs(dx * -line.ey + dy * line.ex);
        if (distance > geometry.epipolar_distance || s < s_low || s > s_high) continue;
        if (angle_between(right.direction[j], left.direction[i]) > geometry.orientation) continue;
        candidates.target.push_back(static_cast<std::int32_t>(j));
      }
    }
    candidates.first.push_back(static_cast<std::int32_t>(candidates.target.size()));
  }
  return candidates;
}

double epipolar_shift(const EpipolarLine& line, double x, double y, double direction, double min_angle,
                      double max_shift) {
  const double dx = x - line.x, dy = y - line.y;
  const double s = dx * line.ex + dy * line.ey;
  const double distance = distance_from(line, x, y);
  const double across = -std::cos(direction) * line.ey + std::sin(direction) * line.ex;
  const double along = std::cos(direction) * line.ex + std::sin(direction) * line.ey;
  if (std::abs(across) <= std::sin(min_angle)) return s;
  const double shift = -distance / across;
  return std::abs(shift) < max_shift ? s + shift * along : s;
}

// LONG: a row from shift to similarity, as the kernel goes through it.
RefinedCandidates stereo_refinement(const ImageView& left_image, const ImageView& right_image,
                                    const std::vector<std::int8_t>& left_patches, const EdgeSet& left,
                                    const EdgeSet& right, const EpipolarGeometry& geometry,
                                    const Candidates& candidates, const StereoConfig& config, double patch_offset,
                                    CandidateScores& scores) {
  RefinedCandidates refined{std::vector<double>(candidates.target.size(), 0.0),
                            std::vector<double>(candidates.target.size(), 0.0)};
  const RefinementSettings settings{config.refine_steps, config.refine_tolerance, kRefinementHuber, kRefinementClamp};
  for (std::size_t i = 0; i < left.size(); ++i) {
    const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
    const double cosine = std::cos(left.direction[i]), sine = std::sin(left.direction[i]);
    const double line_sine = left_epipolar_sine(geometry, left.x[i], left.y[i], left.direction[i]);
    const double stiffness = std::pow(kRefinementNoise / config.refine_prior_sigma * line_sine, 2);
    const PatchFrame left_frame = patch_frame(left.x[i], left.y[i], cosine, sine, 0, 0);
    const auto begin = static_cast<std::size_t>(candidates.first[i]),
               end = static_cast<std::size_t>(candidates.first[i + 1]);
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const auto j = static_cast<std::size_t>(candidates.target[c]);
      refined.position[c] = epipolar_shift(line, right.x[j], right.y[j], right.direction[j], kShiftMinAngle, kShiftMax);
      for (std::size_t k = begin; k < c; ++k) {
        if (scores.state[k] != kCandidateAlive || std::abs(refined.position[k] - refined.position[c]) >= kSamePosition)
          continue;
        const bool better = scores.ncc[c] > scores.ncc[k];
        scores.state[better ? k : c] = kCandidateRepresented;
        if (!better) break;
      }
    }
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateAlive) continue;
      const double s = refined.position[c];
      const auto right_frame = [&](double position, double side) {
        return patch_frame(line.x + position * line.ex, line.y + position * line.ey, cosine, sine, side, patch_offset);
      };
      const PatchValues on_edge = cut_patch(left_image, left_frame, 0, 0);
      const auto found = align_edge(right_image, right_frame(s, 0), line.ex, line.ey, on_edge,
                                    patch_derivative(left_image, left_frame, line.ex, line.ey), stiffness, settings);
      if (!found) {
        scores.state[c] = static_cast<std::uint8_t>(order_of(StereoFilter::refinement));
        continue;
      }
      refined.position[c] = s + found->move;
      const auto side_ncc = [&](int side) {
        return patch_ncc(stored_side(left_patches.data() + i * kEdgePatchBytes, side),
                         cut_patch(right_image, right_frame(refined.position[c], side == 0 ? 1 : -1), 0, 0));
      };
      // A similar side cannot compensate for a dissimilar centre, which gets the lowest similarity of a side.
      const double centre = patch_ncc(on_edge, found->values);
      const double beside = 0.5 * (centre + 1) >= static_cast<double>(lowest_similarity(config))
                                ? std::max(side_ncc(0), side_ncc(1))
                                : -1;
      refined.similarity[c] = 0.5 * (centre + beside);
    }
    // Represented candidates stay where they are and take the similarity of the nearest alive one.
    for (std::size_t c = begin; c < end; ++c) {
      if (scores.state[c] != kCandidateRepresented) continue;
      std::size_t nearest = end;
      for (std::size_t k = begin; k < end; ++k) {
        if (scores.state[k] != kCandidateAlive) continue;
        if (nearest == end || std::abs(refined.position[k] - refined.position[c]) <
                                  std::abs(refined.position[nearest] - refined.position[c]))
          nearest = k;
      }
      if (nearest == end)
        scores.state[c] = static_cast<std::uint8_t>(order_of(StereoFilter::refinement));
      else
        refined.similarity[c] = refined.similarity[nearest];
    }
  }
  return refined;
}

StereoClusters stereo_clusters(const Candidates& candidates, const CandidateScores& scores,
                               const RefinedCandidates& refined, const EdgeSet& right) {
  const auto& positions = refined.position;
  StereoClusters clusters;
  clusters.first.assign(1, 0);
  for (std::size_t i = 0; i + 1 < candidates.first.size(); ++i) {
    std::vector<std::size_t> members;
    for (auto c = static_cast<std::size_t>(candidates.first[i]); c < static_cast<std::size_t>(candidates.first[i + 1]);
         ++c) {
      if (scores.state[c] == kCandidateAlive || scores.state[c] == kCandidateRepresented) members.push_back(c);
    }
    std::stable_sort(members.begin(), members.end(),
                     [&](std::size_t a, std::size_t b) { return positions[a] < positions[b]; });
    // Alive candidates come before represented ones.
    const auto rank = [&](std::size_t c) {
      const bool represented = scores.state[c] == kCandidateRepresented;
      return represented ? refined.similarity[c] - kBehindAll : refined.similarity[c];
    };
    const auto direction = [&](std::size_t c) {
      return right.direction[static_cast<std::size_t>(candidates.target[c])];
    };
    for (std::size_t from = 0, to = 0; from < members.size(); from = to) {
      to = from + 1;
      while (to < members.size() && static_cast<int>(to - from) < kClusterSizeMax &&
             positions[members[to]] - positions[members[to - 1]] < kClusterGap &&
             angle_between(direction(members[to]), direction(members[to - 1])) <= kClusterOrientation) {
        ++to;
      }
      double highest = rank(members[from]);
      for (std::size_t k = from; k < to; ++k) highest = std::max(highest, rank(members[k]));
      std::optional<std::size_t> chosen;
      for (std::size_t k = from; k < to; ++k) {
        const bool equal = rank(members[k]) >= highest - kSimilarityTie;
        if (equal && (!chosen || candidates.target[members[k]] < candidates.target[*chosen])) chosen = members[k];
      }
      double cosine = 0, sine = 0;
      for (std::size_t k = from; k < to; ++k) {
        const double weight =
            std::exp(-0.5 * std::pow((positions[members[k]] - positions[*chosen]) / kClusterSigma, 2));
        cosine += weight * std::cos(static_cast<double>(direction(members[k])));
        sine += weight * std::sin(static_cast<double>(direction(members[k])));
      }
      clusters.position.push_back(positions[*chosen]);
      clusters.direction.push_back(std::atan2(sine, cosine));
      clusters.anchor.push_back(candidates.target[*chosen]);
      clusters.similarity.push_back(rank(*chosen));
    }
    clusters.first.push_back(static_cast<std::int32_t>(clusters.position.size()));
  }
  return clusters;
}

void append(const EdgeSet& left, std::size_t i, const StereoClusters& clusters, std::size_t c,
            const EpipolarGeometry& geometry, StereoEdges& edges) {
  const EpipolarLine line = epipolar_line(geometry, left.x[i], left.y[i]);
  edges.left_index.push_back(static_cast<std::int32_t>(i));
  edges.right_index.push_back(clusters.anchor[c]);
  edges.left_x.push_back(left.x[i]);
  edges.left_y.push_back(left.y[i]);
  edges.left_direction.push_back(left.direction[i]);
  edges.right_x.push_back(static_cast<float>(line.x + clusters.position[c] * line.ex));
  edges.right_y.push_back(static_cast<float>(line.y + clusters.position[c] * line.ey));
  edges.right_direction.push_back(static_cast<float>(clusters.direction[c]));
  edges.ncc.push_back(static_cast<float>(clusters.similarity[c]));
}

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
    append(left, i, clusters, c, geometry, edges);
    edges.left_scale_shift.push_back(left.scale_shift[i]);
  }
  return edges;
}

StereoRelaxation stereo_relaxation(const StereoClusters& clusters, const EdgeSet& left,
                                   const EpipolarGeometry& geometry, int width, int height, const StereoConfig& config,
                                   const CoarseDisparity* coarse_disparity) {
  Neighbourhood neighbourhood(clusters, left, geometry, width, height);
  const auto lowest = static_cast<double>(lowest_similarity(config));
  const auto& similarity = clusters.similarity;
  std::vector<double> prior(similarity.size(), 0.0);
  std::vector<std::size_t> choosers;  // edges with more than one candidate
  StereoRelaxation result;
  result.belief.resize(similarity.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    double highest = -1;
    int candidates = 0;
    for (auto k = neighbourhood.begin(i); k < neighbourhood.end(i); ++k) highest = std::max(highest, similarity[k]);
    for (auto k = neighbourhood.begin(i); k < neighbourhood.end(i); ++k) {
      if (similarity[k] < lowest) continue;
      prior[k] = result.belief[k] = std::exp((similarity[k] - highest) / kRelaxationScale);
      ++candidates;
    }
    normalise(result.belief, neighbourhood.begin(i), neighbourhood.end(i));
    if (candidates > 0) neighbourhood.enter(i);
    if (candidates > 1) choosers.push_back(i);
  }
  for (int round = 0; round < config.relaxation_rounds; ++round) vote(neighbourhood, choosers, prior, result.belief);
  result.tally = tally_of(neighbourhood, left.size(), result.belief);
  if (coarse_disparity != nullptr) {
    consult(neighbourhood, left.size(), *coarse_disparity, prior, result.belief);
    for (int round = 0; round < config.relaxation_rounds; ++round) vote(neighbourhood, choosers, prior, result.belief);
  }
  for (std::size_t i = 0; i < left.size(); ++i) {
    std::optional<std::size_t> best;
    int candidates = 0;
    for (auto k = neighbourhood.begin(i); k < neighbourhood.end(i); ++k) {
      if (result.belief[k] <= 0) continue;
      ++candidates;
      if (!best || std::pair(result.belief[k], similarity[k]) > std::pair(result.belief[*best], similarity[*best]))
        best = k;
    }
    double score = 0;
    if (best) {
      const auto weight = static_cast<double>(support_weight(config));
      const bool asked = weight > 0 && (candidates > 1 || similarity[*best] < config.refined_ncc_min);
      score = similarity[*best] +
              weight * (asked ? neighbourhood.support(i, *best, result.belief) : static_cast<double>(kUsualSupport));
    }
    const bool passes = best && score >= config.refined_ncc_min;
    result.chosen.push_back(passes ? static_cast<std::int32_t>(*best) : -1);
    result.score.push_back(score);
  }
  return result;
}

}  // namespace quadedge::reference
