/// \file measured_edges.cpp  Measures eight edges at once in plain numbers, in vector lanes.
#include "geometry/measured_edges.hpp"

#include <algorithm>

#include "common/parallel.hpp"
#include "geometry/lanes.hpp"
#include "geometry/stereo_numbers.hpp"

namespace quadedge::pose {

namespace {

QUADEDGE_VECTOR_CLONES
void measure_lanes(const RigNumbers& rig, const Lanes<ObservedNumbers>& edges, Lanes<MeasuredNumbers>& result) {
  Lanes<MeasuredNumbers> lanes;  // on the stack, so that it cannot alias its inputs
  for (std::size_t k = 0; k < kLanes; ++k) set_row(lanes, k, measure_numbers(rig, row_of<ObservedNumbers>(edges, k)));
  result = lanes;
}

}  // namespace

void measure_edges(const StereoRig& rig, const StereoEdges& edges, double min_epipolar_angle, MeasuredEdges& measured) {
  const RigNumbers numbers(rig, min_epipolar_angle);
  measured.resize(edges.size());
  for_row_blocks(edges.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    Lanes<ObservedNumbers> observed = {};
    Lanes<MeasuredNumbers> lanes;
    for (std::size_t first = begin; first < end; first += kLanes) {
      const std::size_t count = std::min(kLanes, end - first);
      for (std::size_t k = 0; k < count; ++k) set_row(observed, k, numbers_of(observation_of(edges, first + k)));
      measure_lanes(numbers, observed, lanes);
      for (std::size_t k = 0; k < count; ++k)
        measured[first + k] = measurement_of(row_of<ObservedNumbers>(observed, k), row_of<MeasuredNumbers>(lanes, k));
    }
  });
}

}  // namespace quadedge::pose
