/// \file reprojection_terms.cpp  Evaluates quads in vector lanes and adds up their equations in blocks of rows.
#include "motion/reprojection_terms.hpp"

#include <algorithm>
#include <array>

#include "common/parallel.hpp"

namespace quadedge::pose {

namespace {

struct Columns {
  explicit Columns(const ReprojectionTerms& terms) {
    for (std::size_t k = 0; k < ReprojectionTerms::kColumns; ++k) values[k] = terms.column(k);
  }
  const double* values[ReprojectionTerms::kColumns];
};

/// Processes kLanes quads from row `first` on; the compiler vectorises the loop.
template <std::size_t Values>
[[gnu::always_inline]] inline void evaluate_lanes(const Columns& columns, const double* depth, std::size_t first,
                                                  const Evaluation& at, Contributions<Values, kLanes>& lanes) {
  for (std::size_t lane = 0; lane < kLanes; ++lane)
    contribute(row_of<ReprojectionTerm>(columns.values, first + lane), depth[lane], at, lane, lanes);
}

template <std::size_t Values>
[[gnu::always_inline]] inline void sum_rows(const Columns& columns, double* depth, double* error, std::size_t begin,
                                            std::size_t end, const Evaluation& at, double* sums) {
  double total[Values][kLanes] = {};
  for (std::size_t i = begin; i < end; i += kLanes) {
    Contributions<Values, kLanes> lanes;  // on the stack, so that it cannot alias its inputs
    evaluate_lanes(columns, depth + i, i, at, lanes);
    for (std::size_t k = 0; k < kLanes; ++k) {
      depth[i + k] = lanes.depth[k];
      error[i + k] = lanes.error[k] < 0 ? error[i + k] : lanes.error[k];
    }
    for (std::size_t j = 0; j < Values; ++j)
      for (std::size_t k = 0; k < kLanes; ++k) total[j][k] += lanes.values[j][k];
  }
  for (std::size_t j = 0; j < Values; ++j) {
    sums[j] = 0;
    for (std::size_t k = 0; k < kLanes; ++k) sums[j] += total[j][k];
  }
}

QUADEDGE_VECTOR_CLONES
void sum_by_pose(const Columns& columns, double* depth, double* error, std::size_t begin, std::size_t end,
                 const Evaluation& at, double* sums) {
  sum_rows<kPoseValues>(columns, depth, error, begin, end, at, sums);
}

QUADEDGE_VECTOR_CLONES
void sum_by_pose_and_offset(const Columns& columns, double* depth, double* error, std::size_t begin, std::size_t end,
                            const Evaluation& at, double* sums) {
  sum_rows<kOffsetValues>(columns, depth, error, begin, end, at, sums);
}

QUADEDGE_VECTOR_CLONES
void evaluate_few(const Columns& columns, const double* depth, std::size_t first, const Evaluation& at,
                  LaneContributions& result) {
  LaneContributions lanes;
  evaluate_lanes(columns, depth + first, first, at, lanes);
  result = lanes;
}

template <std::size_t Values>
struct Sums {
  double values[Values] = {};
  Sums& operator+=(const Sums& other) {
    for (std::size_t j = 0; j < Values; ++j) values[j] += other.values[j];
    return *this;
  }
};

template <std::size_t Values>
Sums<Values> sum_all(ReprojectionTerms& terms, const Evaluation& at, decltype(sum_by_pose)& sum_block) {
  const Columns columns(terms);
  return sum_row_blocks(terms.padded_size(), Sums<Values>(),
                        [&](std::size_t begin, std::size_t end, Sums<Values>& sum) {
                          sum_block(columns, terms.depth.data(), terms.error.data(), begin, end, at, sum.values);
                        });
}

}  // namespace

void ReprojectionTerms::assign(const QuadObservations& quads, const std::vector<std::int32_t>& rows,
                               const PinholeCamera& left, const NoiseModel& noise, double scale) {
  static_assert(kBlockRows % kLanes == 0);
  size_ = rows.size();
  const std::size_t padded = padded_size();
  for (auto& column : columns_)
    if (column.size() < padded) column.resize(padded);
  depth.assign(padded, 0.0);
  error.assign(padded, 0.0);
  for_row_blocks(padded, [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (k >= size_) {
        for (auto& column : columns_) column[k] = 0;
        continue;
      }
      const auto quad = static_cast<std::size_t>(rows[k]);
      set_row(columns_, k, make_reprojection_term(quads, quad, left, noise, scale));
    }
  });
}

Normal<6> normal_by_pose(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous, double offset,
                         const StudentWeights& weights) {
  const auto sums = sum_all<kPoseValues>(terms, Evaluation(current_from_previous, offset, weights), sum_by_pose);
  Normal<6> normal;
  unpack_pose(sums.values, 1, normal.matrix);
  normal.gradient = Eigen::Map<const Vector6d>(sums.values + kMatrixValues);
  return normal;
}

Normal<7> normal_by_pose_and_offset(ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous,
                                    double offset, const StudentWeights& weights) {
  const auto sums =
      sum_all<kOffsetValues>(terms, Evaluation(current_from_previous, offset, weights), sum_by_pose_and_offset);
  Normal<7> normal;
  unpack_pose(sums.values, 1, normal.matrix);
  normal.gradient.head<6>() = Eigen::Map<const Vector6d>(sums.values + kMatrixValues);
  normal.matrix.topRightCorner<6, 1>() = Eigen::Map<const Vector6d>(sums.values + kPoseValues);
  normal.matrix.bottomLeftCorner<1, 6>() = normal.matrix.topRightCorner<6, 1>().transpose();
  normal.matrix(6, 6) = sums.values[kPoseValues + 6];
  normal.gradient(6) = sums.values[kPoseValues + 7];
  return normal;
}

DisparityErrors disparity_errors(const ReprojectionTerms& terms, const Eigen::Isometry3d& current_from_previous,
                                 double offset) {
  constexpr std::size_t kMost = 2048;
  constexpr double kEqualWeights = 1e12;  // degrees of freedom
  const Columns columns(terms);
  const Evaluation at(current_from_previous, offset, {1, kEqualWeights});
  struct Quad {
    double information, by_offset, others;
  };
  std::array<Quad, kMost> quads;
  std::size_t count = 0;
  for (std::size_t i = 0; i + kLanes <= terms.size(); i += kLanes * (terms.size() / kMost + 1)) {
    Contributions<kOffsetValues, kLanes> lanes;
    evaluate_lanes(columns, terms.depth.data() + i, i, at, lanes);
    for (std::size_t k = 0; k < kLanes; ++k) {
      // o^T P o and o^T P e; the cost lacks what the quad's own error explains.
      const double by_offset = lanes.values[kPoseValues + 6][k], gradient = lanes.values[kPoseValues + 7][k];
      const double variance = row_of<ReprojectionTerm>(columns.values, i + k).disparity_variance;
      const double left_over = 1 - variance * by_offset, explained = gradient * gradient / (by_offset * left_over);
      if (by_offset > 0 && left_over > 0)
        quads[count++] = {by_offset / left_over, explained, lanes.error[k] - left_over * explained};
    }
  }
  if (count < 2) return {};
  Quad *const middle = quads.data() + count / 2, *const end = quads.data() + count;
  std::nth_element(quads.data(), middle, end,
                   [](const Quad& a, const Quad& b) { return a.information < b.information; });
  const auto median = [&](double Quad::*of) {
    Quad* const found = middle + (end - middle) / 2;
    std::nth_element(middle, found, end, [&](const Quad& a, const Quad& b) { return a.*of < b.*of; });
    return found->*of;
  };
  const double noise = median(&Quad::others) / kDirectionMedian;
  if (!(noise > 0)) return {};
  const double information = median(&Quad::information) / noise;
  return {(median(&Quad::by_offset) / (kOffsetMedian * noise) - 1) / information, information};
}

void contributions_by_pose(const ReprojectionTerms& terms, const Evaluation& at, std::size_t first,
                           LaneContributions& result) {
  evaluate_few(Columns(terms), terms.depth.data(), first, at, result);
}

}  // namespace quadedge::pose
