/// \file device_frontend_taps.cpp  Passes data of the device front end to a tap after each filter; runs only if there
/// is a tap.
#include "common/filter_limits.hpp"
#include "edges/device_frontend.hpp"
#include "edges/tap_lists.hpp"

namespace quadedge::frontend {
namespace {

/// Candidates with their scores and the decisions of the filters.
struct Judged {
  Candidates lists;
  CandidateScores scores;  ///< undefined where no filter has computed them

  explicit Judged(const stages::DeviceCandidates& read)
      : lists{read.first.read(static_cast<std::size_t>(read.rows) + 1), read.target.read(size(read))},
        scores{read.ncc.read(size(read)), read.sift.read(size(read)), read.state.read(size(read))} {}
  static std::size_t size(const stages::DeviceCandidates& read) { return static_cast<std::size_t>(read.host_total); }

  /// The candidates that a filter leaves, with the scores that the next filter compares.
  template <class Filter>
  CandidateLists after(Filter filter) const {
    return alive_after(filter, lists, scores);
  }
};

}  // namespace

void DeviceFrontend::tap_stereo() {
  // The kernel combines filters 1 and 2 with filter 3: it runs again without the limits of the later filters.
  for (const auto filter : {StereoFilter::epipolar_distance, StereoFilter::disparity}) {
    stages::DeviceCandidates lists;
    stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height,
                           without_limits(corrected_geometry(), filter < StereoFilter::disparity, true),
                           range_.probe(left_.edges.host_count), lists);
    tap_->stereo_filter(filter, lists.read());
  }
  const Judged judged(candidates_);
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, judged.after(filter));
  const auto rows = static_cast<std::size_t>(candidates_.rows), size = static_cast<std::size_t>(candidates_.capacity);
  const auto count = clusters_.count.read(rows);
  const auto position = clusters_.packed.read(size),
             similarity = clusters_.packed.read(size, 2 * static_cast<std::size_t>(clusters_.stride));
  const StereoClusters clusters{judged.lists.first,
                                {position.begin(), position.end()},
                                {},
                                clusters_.anchor.read(size),
                                {similarity.begin(), similarity.end()}};
  const auto x = left_.edges.packed.read(rows),
             y = left_.edges.packed.read(rows, static_cast<std::size_t>(left_.edges.stride));
  const auto tap_clusters = [&](StereoFilter filter, const auto& passes) {
    const auto exists = [&](std::size_t i, std::size_t k) {
      return k < static_cast<std::size_t>(clusters.first[i] + count[i]) && passes(i, k);
    };
    tap_->stereo_filter(filter, clusters_that(clusters, range_.geometry(), x, y, exists));
  };
  tap_clusters(StereoFilter::refinement, [](std::size_t, std::size_t) { return true; });
  // As in the kernel: clusters that pass compete, and the others are not marked.
  tap_clusters(StereoFilter::similarity,
               [&](std::size_t, std::size_t k) { return similarity[k] >= lowest_similarity(config_.stereo); });
  const auto chosen = relaxed_.chosen.read(rows);
  const auto is_chosen = [&](std::size_t i, std::size_t k) { return chosen[i] == static_cast<std::int32_t>(k); };
  tap_clusters(StereoFilter::relaxation, is_chosen);
  const auto owner = mutual_.owners().read(static_cast<std::size_t>(right_.edges.host_count));
  tap_clusters(StereoFilter::one_to_one, [&](std::size_t i, std::size_t k) {
    return is_chosen(i, k) && owner[static_cast<std::size_t>(clusters.anchor[k])] == static_cast<std::int32_t>(i);
  });
}

/// Both sides, up to the agreement. The kernel combines filter 1 with filter 2: for filter 1 it runs again with the
/// limit of filter 2 removed.
void DeviceFrontend::tap_temporal(const TemporalSearch& search) {
  stages::DeviceCandidates lists;
  for (const Side side : kSides) {
    temporal_candidates_.run(predicted_.list(index_of(side)), search.step, index(side), search.radius, kAnyDirection,
                             lists);
    tap_->temporal_filter(TemporalFilter::displacement, side, lists.read());
  }
  const Judged left(temporal_left_), right(temporal_right_);
  for (auto filter = TemporalFilter::orientation; filter < TemporalFilter::refinement; filter = next(filter)) {
    tap_->temporal_filter(filter, Side::left, left.after(filter));
    tap_->temporal_filter(filter, Side::right, right.after(filter));
  }
  const auto agreeing = left.after(TemporalFilter::agreement);
  for (const Side side : kSides) tap_->temporal_filter(TemporalFilter::agreement, side, agreeing);
}

}  // namespace quadedge::frontend
