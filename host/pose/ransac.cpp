#include "pose/ransac.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "common/angles.hpp"
#include "pose/constraints.hpp"
#include "pose/scoring.hpp"
#include "pose/two_quads.hpp"

namespace quadedge::pose {

namespace {

/// 0 .. count - 1, the same on every platform (std::uniform_int_distribution is not).
std::size_t below(std::mt19937_64& random, std::size_t count) {
  return static_cast<std::size_t>(((random() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

/// A number's bits as an integer that compares like the number.
std::uint32_t ordered_bits(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

/// Quads in the order in which they are trusted: fewest rivals, then highest NCC, then lowest index. Sorted as far as
/// asked for.
class TrustOrder {
 public:
  using Entry = ConsensusWorkspace::Trusted;

  TrustOrder(const QuadObservations& quads, std::vector<Entry>& order) : order_(order) {
    order_.resize(quads.size());
    for (std::size_t i = 0; i < order_.size(); ++i) {
      const auto rivals = static_cast<std::uint64_t>(static_cast<std::uint32_t>(quads.rivals[i]));
      order_[i] = {rivals << 32 | ~ordered_bits(quads.ncc[i]), static_cast<std::int32_t>(i)};
    }
  }

  /// Makes the first `count` places right.
  void sort_first(std::size_t count) {
    if (count <= sorted_) return;
    const auto before = [](const Entry& a, const Entry& b) { return a.key != b.key ? a.key < b.key : a.row < b.row; };
    const auto begin = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    sorted_ = std::min(order_.size(), std::max(count, kGrowth * sorted_));
    const auto end = order_.begin() + static_cast<std::ptrdiff_t>(sorted_);
    std::nth_element(begin, end, order_.end(), before);
    std::sort(begin, end, before);
  }
  std::size_t size() const { return order_.size(); }
  std::size_t operator[](std::size_t place) const { return static_cast<std::size_t>(order_[place].row); }

 private:
  static constexpr std::size_t kGrowth = 4;  ///< every time that more is asked for, all that is left is gone through

  std::vector<Entry>& order_;
  std::size_t sorted_ = 0;
};

/// `size` different rows of 0 .. count - 1 in random order.
void random_subset(std::mt19937_64& random, std::size_t count, std::size_t size, std::vector<std::int32_t>& rows) {
  rows.resize(count);
  std::iota(rows.begin(), rows.end(), 0);
  size = std::min(size, count);
  for (std::size_t i = 0; i < size; ++i) std::swap(rows[i], rows[i + below(random, count - i)]);
  rows.resize(size);
}

/// Sorts the quads by the square cell of the current left image that they lie in: cells line by line, those without
/// quads left out, quads of a cell in their order.
void sort_into_cells(const ScoringArrays& quads, double side, ConsensusWorkspace& workspace) {
  const auto number = [&](float place) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(place) / side));
  };
  const auto [left, right] = std::minmax_element(quads.left_x.begin(), quads.left_x.end());
  const auto [top, bottom] = std::minmax_element(quads.left_y.begin(), quads.left_y.end());
  const std::int32_t first_column = number(*left), first_line = number(*top);
  const std::int32_t columns = number(*right) - first_column + 1, lines = number(*bottom) - first_line + 1;
  auto &cell_of = workspace.cell_of, &first = workspace.cell_first;
  cell_of.resize(quads.size());
  first.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(lines) + 1, 0);
  for (std::size_t i = 0; i < quads.size(); ++i) {
    cell_of[i] = (number(quads.left_y[i]) - first_line) * columns + number(quads.left_x[i]) - first_column;
    ++first[static_cast<std::size_t>(cell_of[i]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  workspace.cells.clear();
  for (std::size_t c = 0; c + 1 < first.size(); ++c)
    if (first[c + 1] > first[c])
      workspace.cells.push_back(
          {static_cast<std::size_t>(first[c]), static_cast<std::size_t>(first[c + 1] - first[c])});
  workspace.members.resize(quads.size());
  for (std::size_t i = 0; i < quads.size(); ++i)
    workspace.members[static_cast<std::size_t>(first[static_cast<std::size_t>(cell_of[i])]++)] =
        static_cast<std::int32_t>(i);
}

/// At most `size` different rows, the same number from each square cell of the current left image: as many as the
/// median cell has, or all that a cell has. So a thing counts by the area that it covers, not by the edges it is
/// covered with. Cells and rows come in random order.
void balanced_subset(std::mt19937_64& random, const ScoringArrays& quads, double side, std::size_t size,
                     ConsensusWorkspace& workspace) {
  auto& rows = workspace.scored_rows;
  rows.clear();
  if (quads.size() == 0) return;
  sort_into_cells(quads, side, workspace);
  auto& cells = workspace.cells;
  auto& held = workspace.cell_sizes;
  for (std::size_t i = 0; i < cells.size(); ++i) std::swap(cells[i], cells[i + below(random, cells.size() - i)]);
  held.clear();
  for (const auto& cell : cells) held.push_back(cell.size);
  const auto median = held.begin() + static_cast<std::ptrdiff_t>(held.size() / 2);
  std::nth_element(held.begin(), median, held.end());
  for (std::size_t round = 0; round < *median && rows.size() < size; ++round) {
    for (const auto& cell : cells) {
      if (cell.size <= round || rows.size() == size) continue;
      std::int32_t* const first = workspace.members.data() + cell.begin;
      std::swap(first[round], first[round + below(random, cell.size - round)]);
      rows.push_back(first[round]);
    }
  }
}

/// Indices of the non-zero bytes, ascending.
void mask_to_rows(const std::vector<std::uint8_t>& mask, std::vector<std::int32_t>& rows) {
  rows.clear();
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) rows.push_back(static_cast<std::int32_t>(i));
}

class Search {
 public:
  Search(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config, std::uint64_t seed,
         ConsensusWorkspace& workspace)
      : quads_(quads), rig_(rig), config_(config), noise_(config), random_(seed), limits_(config), work_(workspace) {
    const auto scored = static_cast<std::size_t>(config.scoring_quads),
               preview = static_cast<std::size_t>(config.preview_quads);
    if (config.scoring_cell > 0) {
      balanced_subset(random_, quads.scoring, config.scoring_cell, scored, work_);
    } else {
      random_subset(random_, quads.size(), scored, work_.scored_rows);
    }
    auto &scored_rows = work_.scored_rows, &preview_rows = work_.preview_rows;
    preview_rows.assign(scored_rows.begin(),
                        scored_rows.begin() + static_cast<std::ptrdiff_t>(std::min(scored_rows.size(), preview)));
    for (auto [numbers, arrays] : {std::pair(&scored_rows, &work_.scored), std::pair(&preview_rows, &work_.preview)}) {
      std::sort(numbers->begin(), numbers->end());
      arrays->clear();
      arrays->reserve(numbers->size());
      for (std::int32_t row : *numbers) arrays->append_row(quads.scoring, static_cast<std::size_t>(row));
    }
    work_.preview_terms.clear();
    for (std::int32_t row : preview_rows)
      work_.preview_terms.push_back(make_term(quads, static_cast<std::size_t>(row), noise_));
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
    TrustOrder order(quads_, work_.order);
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
    OrientedPair before{quads_.previous[a].oriented_point(), quads_.previous[b].oriented_point()};
    OrientedPair after{quads_.current[a].oriented_point(), quads_.current[b].oriented_point()};
    const ConstraintCheck check = check_constraints(before, after, limits_);
    if (!check.all()) return std::nullopt;
    if (check.swapped) {
      std::swap(before.first, before.second);
      std::swap(after.first, after.second);
    }
    auto motion = solve_two_quads(before, after, limits_.max_cosine);
    if (!motion || config_.local_optimisation_rounds == 0) return motion;
    work_.pair_terms[0] = make_term(quads_, a, noise_);
    work_.pair_terms[1] = make_term(quads_, b, noise_);
    Eigen::Isometry3d polished = *motion;
    const bool fitted = fit_sample(work_.pair_terms, pair_rows_, rig_, config_, polished, work_.fit);
    return fitted ? polished : *motion;
  }

  void consider(const Eigen::Isometry3d& motion) {
    ++best_.hypotheses;
    const double raw = truncated_cost(work_.preview, LaterCameras(rig_, motion),
                                      config_.local_optimisation_widening * config_.inlier_distance);
    if (best_.found && raw >= best_raw_) return;
    best_raw_ = raw;
    accept(motion);
    if (config_.local_optimisation_rounds == 0) return;
    if (const auto better = optimise(motion)) accept(*better);
  }

  /// Fits over the preview's inliers, the distance narrowing geometrically to the inlier distance.
  std::optional<Eigen::Isometry3d> optimise(Eigen::Isometry3d motion) {
    const int rounds = config_.local_optimisation_rounds;
    for (int round = 0; round < rounds; ++round) {
      const double share = rounds > 1 ? static_cast<double>(round) / (rounds - 1) : 1.0;
      const double distance = config_.inlier_distance * std::pow(config_.local_optimisation_widening, 1.0 - share);
      select_inliers(work_.preview, LaterCameras(rig_, motion), distance, radians(config_.inlier_orientation),
                     work_.mask);
      mask_to_rows(work_.mask, work_.inlier_rows);
      if (!fit_sample(work_.preview_terms, work_.inlier_rows, rig_, config_, motion, work_.fit)) return std::nullopt;
    }
    return motion;
  }

  void accept(const Eigen::Isometry3d& motion) {
    const LaterCameras cameras(rig_, motion);
    const double cost = truncated_cost(work_.scored, cameras, config_.inlier_distance);
    if (best_.found && cost >= best_.cost) return;
    best_.found = true;
    best_.cost = cost;
    best_.current_from_previous = motion;
    const int inliers =
        select_inliers(work_.scored, cameras, config_.inlier_distance, radians(config_.inlier_orientation), work_.mask);
    const double share = static_cast<double>(inliers) / static_cast<double>(work_.scored.size());
    const double miss = std::log1p(-std::min(share * share, 1.0 - std::numeric_limits<double>::epsilon()));
    const double draws = std::log1p(-config_.confidence) / miss;
    needed_ = std::max(config_.min_hypotheses,
                       draws < config_.max_hypotheses ? static_cast<int>(std::ceil(draws)) : config_.max_hypotheses);
  }

  const QuadObservations& quads_;
  const StereoRig& rig_;
  const PoseConfig& config_;
  NoiseModel noise_;
  std::mt19937_64 random_;
  ConstraintLimits limits_;
  ConsensusWorkspace& work_;
  const std::vector<std::int32_t> pair_rows_ = {0, 1};
  double min_distance_squared_ = 0;
  double best_raw_ = 1;
  int needed_ = std::numeric_limits<int>::max();
  Consensus best_;
};

}  // namespace

Consensus find_consensus(const QuadObservations& quads, const StereoRig& rig, const PoseConfig& config,
                         std::uint64_t seed, const std::optional<Eigen::Isometry3d>& initial,
                         ConsensusWorkspace& workspace) {
  return Search(quads, rig, config, seed, workspace).run(initial);
}

}  // namespace quadedge::pose
