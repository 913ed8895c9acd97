#include "pose/ransac.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>
#include <utility>
#include <vector>

#include "pose/angles.hpp"
#include "pose/constraints.hpp"
#include "pose/sample_fit.hpp"
#include "pose/scoring.hpp"
#include "pose/two_quads.hpp"

namespace quadedge::pose {

namespace {

/// 0 .. count - 1, the same on every platform (std::uniform_int_distribution is not).
std::size_t below(std::mt19937_64& random, std::size_t count) {
  return static_cast<std::size_t>(((random() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

/// Quads in the order in which they are trusted; sorted as far as asked for.
class TrustOrder {
 public:
  explicit TrustOrder(const QuadObservations& quads) : quads_(quads), order_(quads.size()) {
    std::iota(order_.begin(), order_.end(), 0);
  }

  /// Makes the first `count` places right.
  void sort_first(std::size_t count) {
    if (count <= sorted_) return;
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    sorted_ = std::min(order_.size(), std::max(count, 2 * sorted_));
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    const auto before = [this](std::int32_t a, std::int32_t b) { return is_before(a, b); };
    std::nth_element(begin, end, order_.end(), before);
    std::sort(begin, end, before);
  }
  std::size_t size() const { return order_.size(); }
  std::size_t operator[](std::size_t place) const { return static_cast<std::size_t>(order_[place]); }

 private:
  bool is_before(std::int32_t a, std::int32_t b) const {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    if (quads_.rivals[i] != quads_.rivals[j]) return quads_.rivals[i] < quads_.rivals[j];
    if (quads_.ncc[i] != quads_.ncc[j]) return quads_.ncc[i] > quads_.ncc[j];
    return a < b;
  }

  const QuadObservations& quads_;
  std::vector<std::int32_t> order_;
  std::size_t sorted_ = 0;
};

/// `size` different rows of 0 .. count - 1 in random order.
std::vector<std::int32_t> random_subset(std::mt19937_64& random, std::size_t count, std::size_t size) {
  std::vector<std::int32_t> rows(count);
  std::iota(rows.begin(), rows.end(), 0);
  size = std::min(size, count);
  for (std::size_t i = 0; i < size; ++i) std::swap(rows[i], rows[i + below(random, count - i)]);
  rows.resize(size);
  return rows;
}

/// At most `size` different rows, the same number from each square cell of the current left image: as many as the median cell has, or
/// all that a cell has. So a thing counts by the area that it covers, not by the edges it is covered with. Cells and rows come in random
/// order.
std::vector<std::int32_t> balanced_subset(std::mt19937_64& random, const ScoringArrays& quads, double cell, std::size_t size) {
  if (quads.size() == 0) return {};
  const auto number = [&](float place) { return static_cast<std::int32_t>(std::floor(static_cast<double>(place) / cell)); };
  // Rows sorted by their cell.
  struct Placed {
    std::int32_t line, column, row;
  };
  std::vector<Placed> placed(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i) placed[i] = {number(quads.left_y[i]), number(quads.left_x[i]), static_cast<std::int32_t>(i)};
  const auto key = [](const Placed& p) { return std::tie(p.line, p.column, p.row); };
  std::sort(placed.begin(), placed.end(), [&](const Placed& a, const Placed& b) { return key(a) < key(b); });
  struct Cell {
    std::size_t begin, size;
  };
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < placed.size(); ++i) {
    if (i == 0 || placed[i].line != placed[i - 1].line || placed[i].column != placed[i - 1].column) cells.push_back({i, 0});
    ++cells.back().size;
  }
  for (std::size_t i = 0; i < cells.size(); ++i) std::swap(cells[i], cells[i + below(random, cells.size() - i)]);
  std::vector<std::size_t> held;
  for (const Cell& members : cells) held.push_back(members.size);
  const auto median = held.begin() + static_cast<std::ptrdiff_t>(held.size() / 2);
  std::nth_element(held.begin(), median, held.end());
  std::vector<std::int32_t> rows;
  rows.reserve(std::min(size, quads.size()));
  for (std::size_t round = 0; round < *median && rows.size() < size; ++round) {
    for (const Cell& members : cells) {
      if (members.size <= round || rows.size() == size) continue;
      Placed* const first = placed.data() + members.begin;
      std::swap(first[round], first[round + below(random, members.size - round)]);
      rows.push_back(first[round].row);
    }
  }
  return rows;
}

/// Indices of the non-zero bytes, ascending.
void mask_to_rows(const std::vector<std::uint8_t>& mask, std::vector<std::int32_t>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) rows.push_back(static_cast<std::int32_t>(i));
}

class Search {
 public:
  Search(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, std::uint64_t seed)
      : quads_(quads), rig_(rig), config_(config), noise_(config), random_(seed), limits_(config) {
    std::vector<std::int32_t> rows;
    if (config.scoring_cell > 0) {
      rows = balanced_subset(random_, quads.scoring, config.scoring_cell, static_cast<std::size_t>(config.scored));
    } else {
      rows = random_subset(random_, quads.size(), static_cast<std::size_t>(config.scored));
    }
    preview_rows_.assign(rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(std::min(rows.size(), static_cast<std::size_t>(config.preview))));
    for (auto [numbers, arrays] : {std::pair(&rows, &scored_), std::pair(&preview_rows_, &preview_)}) {
      std::sort(numbers->begin(), numbers->end());
      arrays->reserve(numbers->size());
      for (std::int32_t row : *numbers) arrays->append_row(quads.scoring, static_cast<std::size_t>(row));
    }
    preview_terms_.reserve(preview_rows_.size());
    for (std::int32_t row : preview_rows_) preview_terms_.push_back(make_term(quads, static_cast<std::size_t>(row), noise_));
    inlier_rows_.reserve(preview_rows_.size());
    const double diagonal = std::hypot(rig.left.width, rig.left.height);
    min_distance_squared_ = std::pow(config.min_pair_distance * diagonal, 2);
  }

  Consensus run(const std::optional<Eigen::Isometry3d>& initial) {
    if (initial) consider(*initial);
    if (quads_.size() >= 2) sample();
    return best_;
  }

 private:
  void sample() {
    TrustOrder order(quads_);
    // The pool grows linearly from the smallest subset worth sampling to all quads over the first max_hypotheses draws.
    const double first_pool = std::min<double>(static_cast<double>(order.size()), config_.min_inliers);
    const double growth = (static_cast<double>(order.size()) - first_pool) / config_.max_hypotheses;
    while (best_.draws < config_.max_draws && best_.hypotheses < std::min(needed_, config_.max_hypotheses)) {
      const double pool_size = std::min(first_pool + growth * best_.draws, static_cast<double>(order.size()));
      const std::size_t pool = std::max<std::size_t>(2, static_cast<std::size_t>(pool_size));
      order.sort_first(pool);
      ++best_.draws;
      const std::size_t a = below(random_, pool);
      std::size_t b = below(random_, pool - 1);
      if (b >= a) ++b;
      if (const auto motion = solve(order[a], order[b])) consider(*motion);
    }
  }

  std::optional<Eigen::Isometry3d> solve(std::size_t a, std::size_t b) {
    const double dx = static_cast<double>(quads_.scoring.left_x[a]) - static_cast<double>(quads_.scoring.left_x[b]);
    const double dy = static_cast<double>(quads_.scoring.left_y[a]) - static_cast<double>(quads_.scoring.left_y[b]);
    if (dx * dx + dy * dy < min_distance_squared_) return std::nullopt;
    OrientedPair before{quads_.previous_points[a], quads_.previous_points[b]};
    OrientedPair after{quads_.current_points[a], quads_.current_points[b]};
    const ConstraintCheck check = check_constraints(before, after, limits_);
    if (!check.all()) return std::nullopt;
    if (check.swapped) {
      std::swap(before.first, before.second);
      std::swap(after.first, after.second);
    }
    auto motion = solve_two_quads(before, after, limits_.max_cosine);
    if (!motion || config_.local_rounds == 0) return motion;
    pair_terms_[0] = make_term(quads_, a, noise_);
    pair_terms_[1] = make_term(quads_, b, noise_);
    Eigen::Isometry3d polished = *motion;
    const bool fitted = fit_sample(pair_terms_, pair_rows_, rig_, config_, polished, workspace_);
    return fitted ? polished : *motion;
  }

  void consider(const Eigen::Isometry3d& motion) {
    ++best_.hypotheses;
    const double raw = truncated_cost(preview_, LaterCameras(rig_, motion), config_.local_widening * config_.inlier_distance);
    if (best_.found && raw >= best_raw_) return;
    best_raw_ = raw;
    accept(motion);
    if (config_.local_rounds == 0) return;
    if (const auto better = optimise(motion)) accept(*better);
  }

  /// Fits over the preview's inliers, the distance narrowing geometrically to the inlier distance.
  std::optional<Eigen::Isometry3d> optimise(Eigen::Isometry3d motion) {
    const int rounds = config_.local_rounds;
    for (int round = 0; round < rounds; ++round) {
      const double share = rounds > 1 ? static_cast<double>(round) / (rounds - 1) : 1.0;
      const double distance = config_.inlier_distance * std::pow(config_.local_widening, 1.0 - share);
      select_inliers(preview_, LaterCameras(rig_, motion), distance, radians(config_.inlier_orientation), mask_);
      mask_to_rows(mask_, inlier_rows_);
      if (!fit_sample(preview_terms_, inlier_rows_, rig_, config_, motion, workspace_)) return std::nullopt;
    }
    return motion;
  }

  void accept(const Eigen::Isometry3d& motion) {
    const LaterCameras cameras(rig_, motion);
    const double cost = truncated_cost(scored_, cameras, config_.inlier_distance);
    if (best_.found && cost >= best_.cost) return;
    best_.found = true;
    best_.cost = cost;
    best_.current_from_previous = motion;
    const int inliers =
        select_inliers(scored_, cameras, config_.inlier_distance, radians(config_.inlier_orientation), mask_);
    const double share = static_cast<double>(inliers) / static_cast<double>(scored_.size());
    const double miss = std::log1p(-std::min(share * share, 1.0 - std::numeric_limits<double>::epsilon()));
    const double draws = std::log1p(-config_.confidence) / miss;
    needed_ = std::max(config_.min_hypotheses, draws < config_.max_hypotheses ? static_cast<int>(std::ceil(draws)) : config_.max_hypotheses);
  }

  const QuadObservations& quads_;
  const StereoRig& rig_;
  const PoseConfig& config_;
  NoiseModel noise_;
  std::mt19937_64 random_;
  ConstraintLimits limits_;
  ScoringArrays scored_, preview_;
  std::vector<std::int32_t> preview_rows_, inlier_rows_;
  std::vector<FitTerm> preview_terms_, pair_terms_ = std::vector<FitTerm>(2);
  const std::vector<std::int32_t> pair_rows_ = {0, 1};
  std::vector<std::uint8_t> mask_;
  SampleWorkspace workspace_;
  double min_distance_squared_ = 0;
  double best_raw_ = 1;
  int needed_ = std::numeric_limits<int>::max();
  Consensus best_;
};

}  // namespace

Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, std::uint64_t seed,
                         const std::optional<Eigen::Isometry3d>& initial) {
  return Search(quads, rig, config, seed).run(initial);
}

}  // namespace quadedge::pose
