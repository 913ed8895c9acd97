#include "reference/stereo_relaxation.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/filter_limits.hpp"
#include "common/matching_constants.hpp"

namespace quadedge::reference {
namespace {

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

  /// Whether the witness knows a position near that of a cluster, at edge i or beside it.
  bool is_seconded(std::size_t i, std::size_t candidate, const CoarseDisparity& witness) const {
    const int column = static_cast<int>(0.5F * left_.x[i]), row = static_cast<int>(0.5F * left_.y[i]);
    if (row >= witness.search.height) return false;
    for (int x = std::max(column - kBeside, 0); x <= std::min(column + kBeside, witness.search.width - 1); ++x) {
      const float coarse = witness.positions[static_cast<std::size_t>(row * witness.search.width + x)];
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

/// Makes the candidates of an edge less likely that the witness does not second, if it seconds another one.
void consult(const Neighbourhood& neighbourhood, std::size_t edges, const CoarseDisparity& witness,
             std::vector<double>& prior, std::vector<double>& belief) {
  for (std::size_t i = 0; i < edges; ++i) {
    const auto begin = neighbourhood.begin(i), end = neighbourhood.end(i);
    std::vector<bool> seconded;
    bool speaks = false;
    for (auto k = begin; k < end; ++k) {
      seconded.push_back(neighbourhood.is_seconded(i, k, witness));
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

StereoRelaxation stereo_relaxation(const StereoClusters& clusters, const EdgeSet& left,
                                   const EpipolarGeometry& geometry, int width, int height, const StereoConfig& config,
                                   const CoarseDisparity* witness) {
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
  if (witness != nullptr) {
    consult(neighbourhood, left.size(), *witness, prior, result.belief);
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
