#include "rig/row_model.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"
#include "rig/rig_constants.hpp"

namespace quadedge::rig {

template <int Count>
RowFit<Count>::RowFit(const PinholeCamera& right, const Sums& sums) : right_(right), sums_(sums) {
  if (sums.frames > 0) terms_ = sums.normal.ldlt().solve(sums.right_side);
}

template <int Count>
typename RowFit<Count>::Terms RowFit<Count>::row_of(const CornerMatch& match) const {
  const double u = match.right.x() / right_.width - 0.5, v = match.right.y() / right_.height - 0.5;
  const Eigen::Vector3d ray = right_.ray(match.right);
  const double square = ray.head<2>().squaredNorm(), cubic = right_.fy * ray.y() * square;
  Eigen::Matrix<double, 8, 1> row;
  row << 1, u, v, u * u - kMeanSquare, u * v, v * v - kMeanSquare, cubic, cubic * square;
  return row.head<Count>();
}

template <int Count>
double RowFit<Count>::scatter(const std::vector<CornerMatch>& matches) {
  distances_.clear();
  for (const CornerMatch& match : matches) distances_.push_back(std::abs(match.across - row_of(match).dot(terms_)));
  return upper_median(distances_);
}

template <int Count>
void RowFit<Count>::add(const std::vector<CornerMatch>& matches) {
  if (matches.size() < kMinFitCorners) return;
  constexpr double kKept = 1 - 1.0 / kRowMemory;
  const Normal before = kKept * sums_.normal;
  const Terms sums_before = kKept * sums_.right_side;
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
    sums_.normal = before + normal;
    sums_.right_side = sums_before + right_side;
    terms_ = sums_.normal.ldlt().solve(sums_.right_side);
  }
  sums_.shared *= kKept * kKept;
  if (sums_.frames > 0) sums_.shared += contribution * contribution.transpose();
  sums_.frames = kKept * sums_.frames + 1;
  const double deviation = kDeviationOfMedian * scatter(matches);
  sums_.variance += (deviation * deviation - sums_.variance) / sums_.frames;
  distances_.clear();
  for (const CornerMatch& match : matches) distances_.push_back(std::abs(match.across));
  const double distance = kDeviationOfMedian * upper_median(distances_);
  sums_.whole_variance += (distance * distance - sums_.whole_variance) / sums_.frames;
}

template <int Count>
typename RowFit<Count>::Terms RowFit<Count>::certain_terms() const {
  Terms terms = Terms::Zero();
  if (sums_.frames == 0) return terms;
  Normal normal = sums_.normal, spread = sums_.shared + sums_.variance * sums_.normal;
  Terms right_side = sums_.right_side;
  for (int dropped = 0; dropped < Count; ++dropped) {
    const Normal inverse = normal.inverse();
    terms = inverse * right_side;
    const Terms variances = kTermSigmas * kTermSigmas * (inverse * spread * inverse).diagonal();
    // Ratios above 1 are not certain; dropped terms are 0 with no variance.
    const Eigen::Array<double, Count, 1> ratios = variances.array() / terms.array().square().max(1e-12);
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
  return terms;
}

template class RowFit<RowModel::kTerms>;
template class RowFit<RowModel::kTerms + 2>;

void RowModel::add(const std::vector<CornerMatch>& matches) {
  fit_.add(matches);
  with_lens_.add(matches);
}

double RowModel::unexplained() const {
  return sums().whole_variance > 0 ? std::sqrt(sums().variance / sums().whole_variance) : 1;
}

RectificationError RowModel::error() const {
  const Terms terms = fit_.certain_terms();
  return {terms[0] - kMeanSquare * (terms[3] + terms[5]), terms[1], terms[2], terms[3], terms[4], terms[5]};
}

RightCameraError RowModel::camera_error() const {
  if (with_lens_.sums().frames < kFewestFrames) return known_;
  const auto terms = with_lens_.certain_terms();
  const double width = right_.width, height = right_.height;
  RightCameraError error = with_lens_.sums().frames < kSufficientFrames ? known_ : RightCameraError();
  if (terms[4] != 0) error.yaw = -terms[4] * right_.fx / (width * height);
  if (terms[5] != 0) error.pitch = terms[5] * right_.fy / (height * height);
  if (terms[6] != 0 || terms[7] != 0) error.radial_3 = terms[6], error.radial_5 = terms[7];
  return error;
}

RowModel::Estimate RowModel::estimate() const {
  Normal of_error = Normal::Identity();  // see RowFit
  of_error(0, 3) = of_error(0, 5) = -kMeanSquare;
  const Normal change = of_error * sums().normal.inverse();
  return {of_error * fit_.terms(), change * (sums().shared + sums().variance * sums().normal) * change.transpose()};
}

}  // namespace quadedge::rig
