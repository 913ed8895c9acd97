/// \file device_frontend_taps.cpp  Passes data of the device front end to a tap after each filter; runs only if there
/// is a tap.
#include "common/filter_limits.hpp"
#include "frontend/device_frontend.hpp"

namespace quadedge::frontend {
namespace {

constexpr float kAllDirections = 4.0f;  // rad, larger than any angle

/// The scores that a filter compares; null for filters that use neither.
template <class Filter>
const std::vector<float>* scores_for(const stages::JudgedCandidates& lists, Filter filter) {
  if (filter == Filter::sift || filter == Filter::nearly_best_sift) return &lists.sift;
  if (filter == Filter::ncc || filter == Filter::nearly_best_ncc) return &lists.ncc;
  return nullptr;
}

/// The candidates that a filter leaves, with the scores that the next filter compares.
template <class Filter>
CandidateLists passing(const stages::JudgedCandidates& lists, Filter filter) {
  return lists.alive_after(order_of(filter), scores_for(lists, next(filter)));
}

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
  const auto judged = candidates_.read_judged();
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, passing(judged, filter));
  const auto rows = static_cast<std::size_t>(candidates_.rows), size = static_cast<std::size_t>(candidates_.capacity);
  const auto count = clusters_.count.read(rows);
  const auto position = clusters_.packed.read(size),
             similarity = clusters_.packed.read(size, 2 * static_cast<std::size_t>(clusters_.stride));
  const auto anchor = clusters_.anchor.read(size);
  const auto x = left_.edges.packed.read(rows),
             y = left_.edges.packed.read(rows, static_cast<std::size_t>(left_.edges.stride));
  const auto clusters_that = [&](const auto& pass) {
    CandidateLists lists;
    lists.first.assign(1, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      const auto line = epipolar_line(range_.geometry(), x[i], y[i]);
      const auto begin = static_cast<std::size_t>(judged.first[i]);
      for (std::size_t k = begin; k < begin + static_cast<std::size_t>(count[i]); ++k) {
        if (!pass(i, k)) continue;
        lists.target.push_back(anchor[k]);
        lists.x.push_back(line.x + position[k] * line.ex);
        lists.y.push_back(line.y + position[k] * line.ey);
        lists.cue.push_back(similarity[k]);
      }
      lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
    }
    return lists;
  };
  tap_->stereo_filter(StereoFilter::refinement, clusters_that([](std::size_t, std::size_t) { return true; }));
  // As in the kernel: clusters that pass compete, and the others are not marked.
  tap_->stereo_filter(StereoFilter::similarity, clusters_that([&](std::size_t, std::size_t k) {
                        return similarity[k] >= lowest_similarity(config_.stereo);
                      }));
  const auto chosen = relaxed_.chosen.read(rows);
  const auto is_chosen = [&](std::size_t i, std::size_t k) { return chosen[i] == static_cast<std::int32_t>(k); };
  tap_->stereo_filter(StereoFilter::relaxation, clusters_that(is_chosen));
  const auto owner = owners_.owner.read(static_cast<std::size_t>(right_.edges.host_count));
  tap_->stereo_filter(StereoFilter::one_to_one, clusters_that([&](std::size_t i, std::size_t k) {
                        return is_chosen(i, k) &&
                               owner[static_cast<std::size_t>(anchor[k])] == static_cast<std::int32_t>(i);
                      }));
}

/// Both sides, up to the agreement. The kernel combines filter 1 with filter 2: for filter 1 it runs again with the
/// limit of filter 2 removed.
void DeviceFrontend::tap_temporal(const TemporalSearch& search) {
  stages::DeviceCandidates lists;
  for (const Side side : kSides) {
    temporal_candidates_.run(predicted_.list(index_of(side)), search.step, index(side), search.radius, kAllDirections,
                             lists);
    tap_->temporal_filter(TemporalFilter::displacement, side, lists.read());
  }
  const auto left = temporal_left_.read_judged(), right = temporal_right_.read_judged();
  for (auto filter = TemporalFilter::orientation; filter < TemporalFilter::refinement; filter = next(filter)) {
    tap_->temporal_filter(filter, Side::left, passing(left, filter));
    tap_->temporal_filter(filter, Side::right, passing(right, filter));
  }
  const auto agreeing = passing(left, TemporalFilter::agreement);
  for (const Side side : kSides) tap_->temporal_filter(TemporalFilter::agreement, side, agreeing);
}

}  // namespace quadedge::frontend
