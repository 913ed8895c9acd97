/// \file row_model.cpp  Recursive robust least squares with forgetting; insignificant terms are dropped one by one.
#include "rig/row_model.hpp"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {

void RowModel::read(const std::vector<CornerMatch>& matches) {
  rows_.clear();
  for (const CornerMatch& match : matches) {
    const double u = match.right.x() / right_.width - 0.5, v = match.right.y() / right_.height - 0.5;
    Terms terms;
    terms << 1, u, v, u * u - kMeanSquare, u * v, v * v - kMeanSquare,
        match.motion ? -match.motion->dot(match.normal) : 0;
    rows_.push_back({match.across, terms});
  }
}

double RowModel::scatter(const std::vector<CornerMatch>& matches) {
  read(matches);
  fit_.measure(rows_);
  return fit_.scatter;
}

void RowModel::add(const std::vector<CornerMatch>& matches) {
  if (matches.size() < kMinMatches) return;
  read(matches);
  sums_.normal = kept_ * sums_.normal + 1e-3 * Normal::Identity();
  sums_.right_side *= kept_;
  fit_.fit(rows_, kMinScale, sums_.normal, sums_.right_side);
  sums_.normal += fit_.normal;
  sums_.right_side += fit_.right_side;
  sums_.shared *= kept_ * kept_;
  if (sums_.frames > 0) sums_.shared += fit_.gradient * fit_.gradient.transpose();
  sums_.frames = kept_ * sums_.frames + 1;
  sums_.matches = kept_ * sums_.matches + static_cast<double>(matches.size());
  const double deviation = kDeviationOfMedian * fit_.scatter;
  sums_.variance += (deviation * deviation - sums_.variance) / sums_.frames;
  Fit none;
  none.measure(rows_);
  const double distance = kDeviationOfMedian * none.scatter;
  sums_.whole_variance += (distance * distance - sums_.whole_variance) / sums_.frames;
}

RowModel::Terms RowModel::certain_terms() const {
  Terms terms = Terms::Zero();
  if (sums_.frames == 0) return terms;
  Normal normal = sums_.normal, spread = sums_.shared + sums_.variance * sums_.normal;
  Terms right_side = sums_.right_side;
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
  return terms;
}

double RowModel::unexplained() const {
  return sums_.whole_variance > 0 ? std::sqrt(sums_.variance / sums_.whole_variance) : 1;
}

double RowModel::delay_sigma() const {
  if (sums_.matches < kMinSamples) return std::numeric_limits<double>::infinity();
  return std::sqrt(std::fmax(kMinScale * kMinScale, sums_.variance) *
                   sums_.normal.ldlt().solve(Terms::Unit(kDelay))[kDelay]);
}

double RowModel::delay() const {
  const double delay = fit_.terms[kDelay], size = std::abs(delay);
  return size > kMinTimeOffset && size < kMaxTimeOffset && size > kMinTimeSigmas * delay_sigma() ? delay : 0;
}

bool RowModel::would_show_delay() const { return kMinTimeSigmas * delay_sigma() < kMinTimeOffset; }

bool RowModel::is_delay_contradicted_by(const std::vector<CornerMatch>& matches) const {
  RowModel without = *this;
  const double with = without.scatter(matches);
  without.fit_.terms[kDelay] = 0;
  return without.scatter(matches) < kLeftLines * with;
}

RectificationError RowModel::error() const {
  const Terms terms = certain_terms();
  return {terms[0] - kMeanSquare * (terms[3] + terms[5]), terms[1], terms[2], terms[3], terms[4], terms[5]};
}

}  // namespace quadedge::rig
