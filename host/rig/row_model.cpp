#include "rig/row_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {

RowModel::Terms RowModel::row_of(const CornerMatch& match) const {
  const double u = match.right.x() / width_ - 0.5, v = match.right.y() / height_ - 0.5;
  Terms row;
  row << 1, u, v, u * u - kMeanSquare, u * v, v * v - kMeanSquare;
  return row;
}

double RowModel::scatter(const std::vector<CornerMatch>& matches) {
  distances_.clear();
  for (const CornerMatch& match : matches) distances_.push_back(std::abs(match.across - row_of(match).dot(terms_)));
  return upper_median(distances_);
}

void RowModel::add(const std::vector<CornerMatch>& matches) {
  if (matches.size() < kMinFitCorners) return;
  constexpr double kKept = 1 - 1.0 / kRowMemory;
  const Normal before = kKept * normal_;
  const Terms sums_before = kKept * right_side_;
  Terms contribution = Terms::Zero();
  for (int round = 0; round < kFitRounds; ++round) {
    const double scale = std::max(2 * scatter(matches), kMinScale);
    Normal normal = 1e-3 * Normal::Identity();
    Terms right_side = Terms::Zero();
    for (const CornerMatch& match : matches) {
      const Terms row = row_of(match);
      const double distance = (match.across - row.dot(terms_)) / scale, weight = 1 / (1 + distance * distance);
      normal += weight * row * row.transpose();
      right_side += weight * match.across * row;
    }
    if (round == 0) contribution = right_side - normal * terms_;
    normal_ = before + normal;
    right_side_ = sums_before + right_side;
    terms_ = normal_.ldlt().solve(right_side_);
  }
  shared_ *= kKept * kKept;
  if (frames_ > 0) shared_ += contribution * contribution.transpose();
  frames_ = kKept * frames_ + 1;
  const double deviation = kDeviationOfMedian * scatter(matches);
  variance_ += (deviation * deviation - variance_) / frames_;
  distances_.clear();
  for (const CornerMatch& match : matches) distances_.push_back(std::abs(match.across));
  const double distance = kDeviationOfMedian * upper_median(distances_);
  whole_variance_ += (distance * distance - whole_variance_) / frames_;
}

double RowModel::unexplained() const { return whole_variance_ > 0 ? std::sqrt(variance_ / whole_variance_) : 1; }

RectificationError RowModel::error() const {
  if (frames_ == 0) return {};
  Normal normal = normal_, spread = shared_ + variance_ * normal_;
  Terms right_side = right_side_, terms = Terms::Zero();
  for (int dropped = 0; dropped < kTerms; ++dropped) {
    const Normal inverse = normal.inverse();
    terms = inverse * right_side;
    const Terms variances = kTermSigmas * kTermSigmas * (inverse * spread * inverse).diagonal();
    // Ratios above 1 are not certain; dropped terms are 0 with no variance.
    const Eigen::Array<double, kTerms, 1> ratios = variances.array() / terms.array().square().max(1e-12);
    Eigen::Index least = 0;
    if (ratios.maxCoeff(&least) < 1) {
      terms.array() *= 1 - ratios;
      break;
    }
    for (Normal* matrix : {&normal, &spread}) {
      matrix->row(least).setZero();
      matrix->col(least).setZero();
    }
    normal(least, least) = 1;
    right_side[least] = terms[least] = 0;
  }
  return {terms[0] - kMeanSquare * (terms[3] + terms[5]), terms[1], terms[2], terms[3], terms[4], terms[5]};
}

}  // namespace quadedge::rig
