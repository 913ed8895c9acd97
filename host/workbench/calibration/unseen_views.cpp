/// \file unseen_views.cpp  Fits motions and points with either calibration, then compares view by view.
#include "calibration/unseen_views.hpp"

#include <algorithm>
#include <cmath>

#include "common/numeric.hpp"

namespace quadedge::rig {
namespace {

constexpr int kPlaceColumns = 12, kPlaceRows = 8;
constexpr std::array<double, 6> kFarthest = {2, 5, 10, 20, 50, 1e9};  // of each range [m]

/// Distances with one calibration fall against those with another below this part if it is better. What is learned has
/// errors of its own: falls to 0.78 and 0.86 (MH_01, Karlsruhe) made poses worse, to 0.4 (KITTI's raw drives) and 0.75
/// (a rendered rig with 0.1 degrees of yaw) better.
constexpr double kMaxRatio = 0.75;
/// Cells of an image in which the given calibration may be that much better than the learned one.
constexpr int kMaxRisingCells = 4;

double median_of_many(std::vector<double>& values) {
  constexpr std::size_t kFewest = 20;
  return values.size() < kFewest ? kNan : upper_median(values);
}

template <class Values>
int rising(const Values& given, const Values& learned) {
  int count = 0;
  for (std::size_t i = 0; i < given.size(); ++i) count += given[i] < kMaxRatio * learned[i] ? 1 : 0;
  return count;
}

std::size_t place_of(const PairAdjustment::Residual& residual, const PinholeCamera& camera) {
  const int column = static_cast<int>(residual.at.x() * kPlaceColumns / camera.width),
            row = static_cast<int>(residual.at.y() * kPlaceRows / camera.height);
  return static_cast<std::size_t>(std::clamp(row, 0, kPlaceRows - 1) * kPlaceColumns +
                                  std::clamp(column, 0, kPlaceColumns - 1));
}

std::size_t range_of(const PairAdjustment::Residual& residual) {
  std::size_t range = 0;
  while (range + 1 < kFarthest.size() && residual.inverse_depth * kFarthest[range] <= 1) ++range;
  return range;
}

}  // namespace

void UnseenViews::add(const RigUnknowns& unknowns, const std::vector<const FramePair*>& pairs,
                      const Eigen::VectorXd& values) {
  PairAdjustment given(unknowns, pairs), learned(unknowns, pairs);
  given.fit(Eigen::VectorXd::Zero(unknowns.count()));
  learned.fit(values);
  const auto before = given.residuals(), after = learned.residuals();
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!before[i].takes_part && !after[i].takes_part) continue;
    const std::size_t side = before[i].view % 2;  // views of the left and the right camera take turns
    const Lens& lens = side == 0 ? unknowns.given().left : unknowns.given().right;
    points_ += before[i].view == kLeftFirst ? 1 : 0;
    views_.push_back({side,
                      place_of(before[i], lens.camera),
                      range_of(after[i].takes_part ? after[i] : before[i]),
                      {before[i].distance, after[i].distance}});
  }
}

std::array<double, 2> UnseenViews::distances(Calibration of) const {
  std::array<std::vector<double>, 2> sides;
  for (const View& view : views_) sides[view.side].push_back(view.distance[of]);
  return {median_of_many(sides[0]), median_of_many(sides[1])};
}

std::array<std::vector<double>, 3> UnseenViews::parts(Calibration of) const {
  using Parts = std::vector<std::vector<double>>;
  const Parts cells(kPlaceRows * kPlaceColumns);
  std::array<Parts, 3> all = {cells, cells, Parts(kFarthest.size())};
  for (const View& view : views_) {
    all[view.side][view.place].push_back(view.distance[of]);
    all[2][view.range].push_back(view.distance[of]);
  }
  std::array<std::vector<double>, 3> medians;
  for (std::size_t i = 0; i < medians.size(); ++i)
    for (auto& part : all[i]) medians[i].push_back(median_of_many(part));
  return medians;
}

bool UnseenViews::fall() const { return rising(distances(kLearned), distances(kGiven)) == 2; }

bool UnseenViews::rise_in_parts() const {
  const auto given = parts(kGiven), learned = parts(kLearned);
  return rising(given[2], learned[2]) > 0 || rising(given[0], learned[0]) > kMaxRisingCells ||
         rising(given[1], learned[1]) > kMaxRisingCells;
}

}  // namespace quadedge::rig
