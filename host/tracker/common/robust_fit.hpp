#pragma once
/// \file robust_fit.hpp  Robust linear least squares: Cauchy weights, at twice the median distance.

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/numeric.hpp"

namespace quadedge {

/// Standard deviation of normal errors over their median magnitude.
constexpr double kDeviationOfMedian = 1.4826;

/// The fit of `Count` terms, as values = rows * terms, with the normal equations of its last round.
template <int Count>
struct RobustFit {
  using Terms = Eigen::Matrix<double, Count, 1>;
  using Matrix = Eigen::Matrix<double, Count, Count>;
  /// What a value is made of.
  struct Row {
    double value;
    Terms terms;
  };
  static constexpr int kRounds = 8;

  Terms terms = Terms::Zero();
  Matrix normal = Matrix::Zero();
  Terms right_side = Terms::Zero();
  Terms gradient = Terms::Zero();  ///< of the rows, at the terms from which the fit began
  double scatter = 0;              ///< median distance of a value from the fit; 0 without values

  /// Fits from the current terms on. `normal` and `right_side` are those of the rows alone.
  /// \param least no smaller scale of distances is used \param known_normal, known_right_side of a fit that is
  /// continued
  void fit(const std::vector<Row>& rows, double least, const Matrix& known_normal, const Terms& known_right_side) {
    measure(rows);
    for (int round = 0; round < kRounds; ++round) {
      const double scale = std::max(2 * scatter, least);
      normal.setZero();
      right_side.setZero();
      for (const Row& row : rows) {
        const double distance = (row.value - row.terms.dot(terms)) / scale, weight = 1 / (1 + distance * distance);
        normal += weight * row.terms * row.terms.transpose();
        right_side += weight * row.value * row.terms;
      }
      if (round == 0) gradient = right_side - normal * terms;
      terms = (known_normal + normal).ldlt().solve(known_right_side + right_side);
      measure(rows);
    }
  }
  /// The same from the median of the values on, for rows whose first term is 1.
  void fit(const std::vector<Row>& rows, double least) {
    distances_.clear();
    for (const Row& row : rows) distances_.push_back(row.value);
    terms.setZero();
    if (!distances_.empty()) terms[0] = upper_median(distances_);
    fit(rows, least, 1e-6 * Matrix::Identity(), Terms::Zero());
  }
  /// Sets the scatter of rows about the terms.
  void measure(const std::vector<Row>& rows) {
    distances_.clear();
    for (const Row& row : rows) distances_.push_back(std::abs(row.value - row.terms.dot(terms)));
    scatter = distances_.empty() ? 0 : upper_median(distances_);
  }

 private:
  std::vector<double> distances_;  ///< kept for its memory
};

}  // namespace quadedge
