#include "rig_check/synchronisation.hpp"

#include <Eigen/LU>
#include <cmath>

#include "rig_check/rig_check_constants.hpp"

namespace quadedge::rig_check {

void Synchronisation::add(double u, double v, double across, double motion) {
  Terms row;
  row << 1, u, v, u * u, u * v, v * v, -motion;
  normal_ += row * row.transpose();
  right_side_ += row * across;
  squares_ += across * across;
  ++count_;
}

double Synchronisation::time_offset_frames() const {
  if (count_ < kMinSamples) return 0;
  const Eigen::FullPivLU<Eigen::Matrix<double, 7, 7>> solver(normal_);
  if (!solver.isInvertible()) return 0;
  const Terms terms = solver.solve(right_side_);
  const double variance = (squares_ - terms.dot(right_side_)) / (count_ - 7);
  const double sigma = std::sqrt(std::fmax(variance, 0) * solver.inverse()(6, 6));
  const double offset = std::abs(terms[6]);
  return offset > kMinTimeOffset && offset < kMaxTimeOffset && offset > kMinTimeSigmas * sigma ? terms[6] : 0;
}

}  // namespace quadedge::rig_check
