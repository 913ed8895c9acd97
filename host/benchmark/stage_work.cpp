#include "benchmark/stage_work.hpp"

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "common/layouts.hpp"
#include "frontend/prediction.hpp"
#include "quadedge/error.hpp"
#include "quadedge/tap.hpp"
#include "reference/patches.hpp"
#include "reference/sift.hpp"

namespace quadedge::bench {
namespace {

constexpr double kEdgeBytes = 4 * sizeof(float);   // x, y, direction, strength
constexpr double kPlaceBytes = 3 * sizeof(float);  // x, y, direction

/// doc/method.md section 1.
StageWork edges_work(const FrameSize& frame, const EdgesConfig& config) {
  const double pairs = std::ceil(4 * config.sigma) + 1;  // taps of a kernel, mirrored ones taken together
  const double tap = 3;                                  // add or subtract the mirrored samples, multiply, add up
  const double filters = 2 * 2 * tap * pairs;            // per pixel: the Gaussian and its slope, along both axes
  const double maximum = 15;                             // per pixel: magnitude, two probes, the test
  const double window = 2 * pairs;                       // samples per axis around an edge
  const double third_order =
      window * window * 5 * 2 + window * 14 * 2;  // five orders along x, then fourteen derivatives along y
  return {frame.pixels + frame.edges * kEdgeBytes, frame.pixels * (filters + maximum) + frame.edges * third_order};
}

/// doc/method.md section 2: bilinear samples, mean-free, scaled to 8 bits, with their norm.
StageWork patches_work(const FrameSize& frame) {
  const double sample = 4 + 8 + 2 + 2 + 2 + 2;  // position, bilinear, mean, largest, scale and round, norm
  const double edges = frame.with_candidates + frame.stereo_edges;  // those at their refined right positions
  return {frame.pixels + edges * (kPlaceBytes + kEdgePatchBytes), edges * 2 * kPatchSamples * sample};
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

/// doc/method.md section 1: gradient and noise operator on 3 x 3 pixels of every lattice point.
StageWork threshold_work(const FrameSize& frame) {
  const double points = frame.pixels / (kThresholdStep * kThresholdStep), gradient = 8, noise = 12, bin = 4;
  return {points * 9 * sizeof(float), points * (gradient + noise + bin)};
}

/// doc/method.md section 1: line and angle of a maximum, and whether it is the nearest; in the searched image for three
/// angles. The number of maxima is at least the number of selected edges.
StageWork selection_work(const FrameSize& frame) {
  const double maximum = 4 * sizeof(float), crossing = 35, nearest = 10;
  return {frame.edges * 2 * maximum, frame.edges * (crossing + 2 * nearest)};
}

/// Similarity of one candidate: the better of two pairs of patches.
constexpr double kSimilarity = 2 * 2 * kPatchSamples + 5;
constexpr double kTurned = 4;  // difference of two directions, compared

StageWork stereo_candidates_work(const FrameSize& frame) {
  const double line = 2 * 15 + 6 + 12, candidate = 6 + kTurned;  // h + t / Z at both ends; distance from the line
  return {frame.edges * kPlaceBytes + (frame.left_edges + frame.stereo_candidates) * sizeof(int),
          frame.left_edges * line + frame.stereo_candidates * candidate};
}

StageWork candidate_filters_work(const FrameSize& frame) {
  return {frame.edges * kEdgePatchBytes + frame.stereo_candidates * (sizeof(int) + sizeof(float) + 1),
          frame.stereo_candidates * (kSimilarity + 2)};
}

/// doc/method.md section 3, filter 8: one Gauss-Newton step and the similarity at its result.
StageWork stereo_refinement_work(const FrameSize& frame) {
  const double sample = 4 + 8 + 4 + 3 * 2;  // position, bilinear, gain and residual, two sums and the robust weight
  return {frame.pixels + frame.left_edges * kEdgePatchBytes + frame.refined * 3 * sizeof(float),
          frame.refined * (2 * kPatchSamples * sample + kSimilarity)};
}

/// doc/method.md section 3: at half size, a cost per pixel and level, and a step of four paths.
StageWork coarse_disparity_work(const FrameSize& frame) {
  const double cells = frame.pixels / 8 * (frame.disparity_range / 2), cost = 2, step = 4 + 3 + 2;
  return {frame.pixels + cells * (sizeof(std::uint8_t) + sizeof(std::uint16_t)), cells * (cost + 4 * step)};
}

StageWork stereo_relaxation_work(const FrameSize& frame, const StereoConfig& config) {
  const double support = 6;  // of one neighbour's candidate: difference along the edge, its reach, the best so far
  return {frame.clusters * config.relaxation_rounds * 2 * sizeof(float),
          frame.clusters * config.relaxation_rounds * kRelaxationNeighbours * support};
}

/// The sorted positions with their indices; a cell and a position per edge.
StageWork point_index_work(const FrameSize& frame) {
  const double edges = 2 * frame.stereo_edges;
  return {edges * (2 * kPlaceBytes + sizeof(int)), edges * 8};
}

constexpr double kNear = 5 + kTurned;  // distance and direction of one candidate in time

/// `candidates` of `searches`, as lists.
StageWork temporal_candidates_work(const FrameSize& frame, double candidates, double searches) {
  return {searches * 2 * frame.base_edges * (kPlaceBytes + sizeof(int)) + candidates * (kPlaceBytes + sizeof(int)),
          candidates * kNear};
}

StageWork temporal_match_work(const FrameSize& frame) {
  const double rows = 2 * (frame.base_edges + frame.stereo_edges);
  return {rows * (kPlaceBytes + kEdgePatchBytes) + frame.base_edges * kQuadRowInts * sizeof(int),
          frame.guided_candidates * (kNear + kSimilarity)};
}

StageWork temporal_quads_work(const FrameSize& frame, double candidates, double searches) {
  const double agreement = 2, score = 7;
  return {candidates * (sizeof(int) + sizeof(float) + 1) + searches * frame.base_edges * kQuadRowInts * sizeof(int),
          candidates / 2 * (agreement + score)};
}

/// Means of blocks, then 17 x 17 samples per edge, gradients of 15 x 15, and their weights in 4 x 4 cells.
StageWork wide_description_work(const FrameSize& frame) {
  const double edges = frame.wide_edges + frame.wide_base_edges, side = 15;
  const double samples = (side + 2) * (side + 2) * (4 + 8), gradients = side * side * (2 + kWideAngles * 4),
               cells = kWideBytes * (2 * 36 + 4);  // six by six samples reach a cell; scaled and clipped
  return {frame.pixels + edges * (kPlaceBytes + kWideBytes), frame.pixels + edges * (samples + gradients + cells)};
}

/// Every descriptor of one side compared with every one of the other.
StageWork wide_matching_work(const FrameSize& frame) {
  return {(frame.wide_edges + frame.wide_base_edges) * kWideBytes,
          frame.wide_edges * frame.wide_base_edges * (2 * kWideBytes + 2)};
}

/// Sums the lengths of the lists after the filters.
class CountingTap : public Tap {
 public:
  void stereo_filter(StereoFilter filter, const CandidateLists& lists) override {
    if (filter == StereoFilter::orientation) {
      size.stereo_candidates = count(lists);
      size.with_candidates =
          static_cast<double>(std::set<std::int32_t>(lists.target.begin(), lists.target.end()).size());
      for (std::size_t row = 0; row + 1 < lists.first.size(); ++row)
        size.with_candidates += lists.first[row + 1] > lists.first[row] ? 1 : 0;
    }
    if (next(filter) == StereoFilter::refinement) size.refined = count(lists);
    if (filter == StereoFilter::refinement) size.clusters = count(lists);
  }
  void temporal_filter(TemporalFilter filter, Side, const CandidateLists& lists) override {
    if (filter == TemporalFilter::orientation) near += count(lists);
  }

  FrameSize size;
  double near = 0;  ///< candidates in time so far

 private:
  static double count(const CandidateLists& lists) { return static_cast<double>(lists.target.size()); }
};

}  // namespace

FrameSize count_frame(frontend::Frontend& frontend, const FramePrefetcher::Frame& first,
                      const FramePrefetcher::Frame& second, const Config& config) {
  CountingTap tap;
  FrameSize& size = tap.size;
  const auto base = frontend.process(first.view());
  frontend.set_tap(&tap);
  const auto now = frontend.process(second.view());
  frontend.match(*base, frontend::search_without_motion(base->edges, config.temporal, false));
  size.guided_candidates = std::exchange(tap.near, 0);
  frontend.match(*base, frontend::search_without_motion(base->edges, config.temporal, true));
  size.coarse_candidates = tap.near;
  frontend.set_tap(nullptr);
  const auto some = [](std::size_t edges, int wanted) {
    return wanted > 0 ? std::ceil(static_cast<double>(edges) / wide_step(edges, wanted)) : 0;
  };
  size.pixels = static_cast<double>(second.left.pixel_count() + second.right.pixel_count());
  size.disparity_range = frontend.counts().disparity_range;
  size.left_edges = frontend.counts().edges_left;
  size.edges = size.left_edges + frontend.counts().edges_right;
  size.base_edges = static_cast<double>(base->edges.size());
  size.stereo_edges = static_cast<double>(now->edges.size());
  size.wide_base_edges = some(base->edges.size(), config.temporal.wide_edges);
  size.wide_edges = some(now->edges.size(), 2 * config.temporal.wide_edges);
  return size;
}

// LONG: one line per stage.
StageWork least_work(const std::string& stage, const FrameSize& frame, const Config& config) {
  const double both_searches = frame.guided_candidates + frame.coarse_candidates, place = kPlaceBytes;
  if (stage == "undistortion") return {frame.pixels * (2 + 2 * sizeof(float)), frame.pixels * (4 + 8)};
  // The lists of candidates and of stereo edges: both have a count per left edge.
  if (stage == "scan") return {2 * 2 * frame.left_edges * sizeof(int), 2 * frame.left_edges};
  if (stage == "edge_threshold") return threshold_work(frame);
  if (stage == "edge_mask") return {frame.pixels * 2, frame.pixels};
  if (stage == "edge_selection") return selection_work(frame);
  if (stage == "edge_detection") return edges_work(frame, config.edges);
  if (stage == "patches") return patches_work(frame);
  if (stage == "sift") return sift_work(frame);
  if (stage == "stereo_candidates") return stereo_candidates_work(frame);
  if (stage == "candidate_filters") return candidate_filters_work(frame);
  if (stage == "stereo_refinement") return stereo_refinement_work(frame);
  if (stage == "stereo_clusters") return {frame.refined * 2 * place, frame.refined * (2 + kTurned + 8)};
  if (stage == "coarse_disparity") return coarse_disparity_work(frame);
  if (stage == "stereo_relaxation") return stereo_relaxation_work(frame, config.stereo);
  if (stage == "stereo_mutual")
    return {frame.left_edges * place + frame.stereo_edges * 3 * place, frame.left_edges * 4};
  if (stage == "point_index") return point_index_work(frame);
  if (stage == "temporal_candidates") return temporal_candidates_work(frame, both_searches, 2);
  if (stage == "temporal_match") return temporal_match_work(frame);
  if (stage == "temporal_quads") return temporal_quads_work(frame, both_searches, 2);
  if (stage == "wide_description") return wide_description_work(frame);
  if (stage == "wide_matching") return wide_matching_work(frame);
  throw UsageError("the least work of the stage '" + stage + "' is not known");
}

}  // namespace quadedge::bench
