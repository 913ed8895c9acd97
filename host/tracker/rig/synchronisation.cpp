/// \file synchronisation.cpp  Recursive robust least squares with forgetting.
#include "rig/synchronisation.hpp"

#include <cmath>
#include <limits>

#include "rig/rig_constants.hpp"

namespace quadedge::rig {

Synchronisation::Fit::Row Synchronisation::row(double u, double v, double across, double motion) {
  Fit::Terms terms;
  terms << 1, u, v, u * u, u * v, v * v, -motion;
  return {across, terms};
}

void Synchronisation::add(const std::vector<Fit::Row>& frame) {
  if (frame.size() < kMinFitCorners) return;
  constexpr double kKept = 1 - 1.0 / kTimeMemory;
  normal_ = kKept * normal_ + 1e-3 * Fit::Matrix::Identity();
  right_side_ *= kKept;
  fit_.fit(frame, kMinScale, normal_, right_side_);
  normal_ += fit_.normal;
  right_side_ += fit_.right_side;
  frames_ = kKept * frames_ + 1;
  count_ = kKept * count_ + static_cast<double>(frame.size());
  const double deviation = std::fmax(kMinScale, kDeviationOfMedian * fit_.scatter);
  variance_ += (deviation * deviation - variance_) / frames_;
}

double Synchronisation::sigma() const {
  if (count_ < kMinSamples) return std::numeric_limits<double>::infinity();
  return std::sqrt(variance_ * normal_.ldlt().solve(Fit::Terms::Unit(6))[6]);
}

double Synchronisation::time_offset_frames() const {
  const double offset = fit_.terms[6], size = std::abs(offset);
  return size > kMinTimeOffset && size < kMaxTimeOffset && size > kMinTimeSigmas * sigma() ? offset : 0;
}

bool Synchronisation::is_settled() const { return kMinTimeSigmas * sigma() < kMinTimeOffset; }

bool Synchronisation::is_contradicted_by(const std::vector<Fit::Row>& frame) const {
  Fit fit;
  fit.terms = fit_.terms;
  fit.measure(frame);
  const double with = fit.scatter;
  fit.terms[6] = 0;
  fit.measure(frame);
  return fit.scatter < kLeftLines * with;
}

}  // namespace quadedge::rig
