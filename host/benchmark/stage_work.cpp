#include "benchmark/stage_work.hpp"

#include <cmath>
#include <limits>

#include "reference/patches.hpp"
#include "reference/sift.hpp"

namespace quadedge::bench {
namespace {

constexpr double kEdgeBytes = 4 * sizeof(float);   // x, y, direction, strength
constexpr double kPlaceBytes = 3 * sizeof(float);  // x, y, direction

/// doc/method.md section 1. The doubled grid has four cells per pixel, two phases per axis.
StageWork edges_work(const FrameSize& frame, const EdgesConfig& config) {
  const double pairs = std::ceil(4 * config.sigma) + 1;  // taps of a kernel, mirrored ones taken together
  const double tap = 3;                                  // add or subtract the mirrored samples, multiply, add up
  const double down = 2 * 2 * tap * pairs;               // per pixel: two phases of the Gaussian and its slope along y
  const double along = 4 * 2 * tap * pairs;              // per pixel: four cells, both gradients along x
  const double maximum = 4 * 15;                         // per pixel: four cells, magnitude, two probes, the test
  const double window = 2 * pairs;                       // samples per axis around an edge
  const double third_order =
      window * window * 5 * 2 + window * 14 * 2;  // five orders along x, then fourteen derivatives along y
  return {frame.pixels + frame.edges * kEdgeBytes, frame.pixels * (down + along + maximum) + frame.edges * third_order};
}

/// doc/method.md section 2: bilinear samples, mean-free, scaled to 8 bits, with their norm.
StageWork patches_work(const FrameSize& frame) {
  const double sample = 4 + 8 + 2 + 2 + 2 + 2;  // position, bilinear, mean, largest, scale and round, norm
  return {frame.pixels + frame.edges * (kPlaceBytes + kEdgePatchBytes), frame.edges * 2 * kPatchSamples * sample};
}

/// doc/method.md section 2: a blur of 13 taps along both axes and a gradient per pixel, 2 x 11 x 11 samples per edge
/// into 4 x 4 x 8 bins.
StageWork sift_work(const FrameSize& frame) {
  const double blur = 2 * (6 * 3 + 1), gradient = 10, samples = 2 * 11 * 11;
  const double sample = 4 + 8 + 8 * 2;  // turned position, weights, eight bins
  const double bin = 2 + 1 + 2 + 1;     // norm, clip, norm, scale
  return {frame.pixels + frame.edges * (kPlaceBytes + kEdgeSiftBytes),
          frame.pixels * (blur + gradient) + frame.edges * (samples * sample + kEdgeSiftBytes * bin)};
}

}  // namespace

StageWork least_work(const std::string& stage, const FrameSize& frame, const Config& config) {
  if (stage == "edge_detection") return edges_work(frame, config.edges);
  if (stage == "patches") return patches_work(frame);
  if (stage == "sift") return sift_work(frame);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  return {unknown, unknown};
}

}  // namespace quadedge::bench
