#include "device/temporal_matching.hpp"
#include "matching.hpp"
#include "reference/temporal_matching.hpp"

using namespace quadedge;
using namespace matching;

namespace {

constexpr int kRowWidth = 90;  // px

EdgePositions positions_of(const std::vector<Edge>& edges) {
  EdgePositions positions;
  for (const Edge& edge : edges) {
    positions.x.push_back(static_cast<float>(edge.x));
    positions.y.push_back(static_cast<float>(edge.y));
    positions.direction.push_back(static_cast<float>(edge.direction));
  }
  return positions;
}

/// Distance inside the limits in units of single-precision error (1e-4 px, 1e-6 rad); positive: inside.
double margin(const EdgePositions& predicted, std::size_t i, const EdgePositions& current, std::size_t j, double radius,
              double orientation) {
  if (!std::isfinite(predicted.x[i]) || !std::isfinite(predicted.y[i]) || !std::isfinite(predicted.direction[i]))
    return -1e9;
  const double distance = std::hypot(static_cast<double>(current.x[j]) - static_cast<double>(predicted.x[i]),
                                     static_cast<double>(current.y[j]) - static_cast<double>(predicted.y[i]));
  const double turn = std::abs(
      std::remainder(static_cast<double>(current.direction[j]) - static_cast<double>(predicted.direction[i]), 2 * kPi));
  return std::min((radius - distance) / 1e-4, (orientation - turn) / 1e-6);
}

/// Compares the lists with the definition over all pairs.
std::size_t check_lists(const std::vector<std::int32_t>& first, const std::vector<std::int32_t>& target,
                        const EdgePositions& predicted, const EdgePositions& current, double radius, double orientation,
                        int step) {
  std::size_t certain = 0, missing = 0, extra = 0;
  const auto rows = (predicted.x.size() + static_cast<std::size_t>(step) - 1) / static_cast<std::size_t>(step);
  REQUIRE(first.size() == rows + 1);
  REQUIRE(first.back() == static_cast<std::int32_t>(target.size()));
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t j = 0; j < current.x.size(); ++j) {
      const auto times =
          std::count(target.begin() + first[row], target.begin() + first[row + 1], static_cast<std::int32_t>(j));
      const double inside = margin(predicted, row * static_cast<std::size_t>(step), current, j, radius, orientation);
      certain += inside > 1 ? 1 : 0;
      missing += inside > 1 && times != 1 ? 1 : 0;
      extra += (inside < -1 && times != 0) || times > 1 ? 1 : 0;
    }
  }
  CHECK(missing == 0);
  CHECK(extra == 0);
  return certain;
}

std::size_t check_everywhere(const std::vector<Edge>& predicted_edges, const std::vector<Edge>& current_edges,
                             int height, double radius, double orientation, int step) {
  const auto predicted = positions_of(predicted_edges), current = positions_of(current_edges);
  reference::PointIndex index;
  reference::make_point_index(current.x, current.y, kRowWidth, height, index);
  const auto truth = reference::temporal_candidates(predicted, current, index, static_cast<float>(radius),
                                                    static_cast<float>(orientation), step);
  const auto certain = check_lists(truth.first, truth.target, predicted, current, radius, orientation, step);
  check_stage("temporal_candidates", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::DevicePositions device_current, device_predicted;
    device_current.write(context, {current});
    stages::DevicePointIndex device_index(kRowWidth, height), other(kRowWidth, height);
    stages::PointIndex(context, variants).run(device_current.list(), device_current.list(), device_index, other);
    device_predicted.write(context, {predicted});
    stages::TemporalCandidates stage(context, variants);
    stages::DeviceCandidates lists;
    stage.run(device_predicted.list(), step, device_index, static_cast<float>(radius), static_cast<float>(orientation),
              lists);
    const auto found = lists.read();
    check_lists(found.first, found.target, predicted, current, radius, orientation, step);
    return {{"first", found.first}, {"target", found.target}};
  });
  return certain;
}

std::vector<Edge> scattered_edges(int count, double width, double height, std::uint64_t seed, double beyond = 0) {
  Random random(seed);
  std::vector<Edge> edges;
  for (int k = 0; k < count; ++k)
    edges.push_back({random(-beyond, width + beyond), random(-beyond, height + beyond), random(-kPi, kPi)});
  return edges;
}

}  // namespace

TEST_CASE("temporal candidates: the lists match the definition, also beyond the initial capacity", "[device]") {
  const auto current = scattered_edges(700, 90, 61, 3);
  auto predicted = scattered_edges(300, 90, 61, 4, 15);
  for (std::size_t i = 0; i < predicted.size(); i += 9) predicted[i].x = std::nan("");  // has none
  CHECK(check_everywhere(predicted, current, 61, 10, 0.6, 1) > 500);
  CHECK(check_everywhere(scattered_edges(301, 90, 61, 5, 15), current, 61, 7.3, 1.5, 8) > 50);
  CHECK(check_everywhere(scattered_edges(20, 50, 40, 6), scattered_edges(400, 50, 40, 7), 40, 200, 4, 1) == 20 * 400);
}

TEST_CASE("temporal candidates: few and empty queries and targets", "[device][oclgrind]") {
  const auto some = scattered_edges(9, 50, 40, 7);
  CHECK(check_everywhere(some, scattered_edges(60, 50, 40, 8), 40, 10, 2, 1) > 5);
  for (const auto& [queries, targets] : {std::pair(0, 9), std::pair(9, 0), std::pair(0, 0)})
    CHECK(check_everywhere(queries == 0 ? std::vector<Edge>() : some, targets == 0 ? std::vector<Edge>() : some, 40, 10,
                           4, queries == 9 ? 8 : 1) == 0);
}
