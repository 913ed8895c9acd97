/// \file device_frontend_taps.cpp  What the device frontend shows a tap after each filter; nothing here runs without
/// one.
#include <algorithm>

#include "common/filter_names.hpp"
#include "frontend/device_frontend.hpp"

namespace quadedge::frontend {
namespace {

constexpr float kAllDirections = 4.0f;  // rad, more than any angle

std::string stereo_name(int order) { return kStereoFilters[static_cast<std::size_t>(order)]; }
std::string temporal_name(int order) { return kTemporalFilters[static_cast<std::size_t>(order)]; }

/// The scores that filter number `order` of a cascade judges; null for filters that judge neither.
const opencl::Buffer<cl_float>* scores_for(const stages::DeviceCandidates& lists, int order, int sift_order,
                                           int ncc_order) {
  const int nearly_best_ncc = std::max(sift_order, ncc_order) + 1;
  if (order == sift_order || order == nearly_best_ncc + 1) return &lists.sift;
  if (order == ncc_order || order == nearly_best_ncc) return &lists.ncc;
  return nullptr;
}

}  // namespace

void DeviceFrontend::tap_candidates_without_limits() {
  stages::DeviceCandidates lists;
  opencl::Buffer<cl_float> geometry;
  for (int order = 1; order < kStereoSiftOrder - 1; ++order) {
    geometry.write(context_, without_limits(epipolar_, order < 2, order < 3).packed());
    stereo_candidates_.run(left_.edges, right_.edges, calibration_.right.height, geometry, lists);
    lists.state.fill(0, static_cast<std::size_t>(lists.host_total));
    tap_->stereo_filter(order, stereo_name(order), lists.alive_after(order, nullptr));
  }
}

void DeviceFrontend::tap_stereo() {
  for (int order = kStereoSiftOrder - 1; order <= kStereoNccOrder + 2; ++order) {
    const auto* scores = scores_for(candidates_, order + 1, kStereoSiftOrder, kStereoNccOrder);
    tap_->stereo_filter(order, stereo_name(order), candidates_.alive_after(order, scores));
  }
  const auto rows = static_cast<std::size_t>(candidates_.rows), size = static_cast<std::size_t>(candidates_.capacity);
  const auto first = candidates_.first.read(rows + 1);
  const auto count = clusters_.count.read(rows);
  const auto place = clusters_.position.read(size), likeness = clusters_.similarity.read(size);
  const auto anchor = clusters_.anchor.read(size);
  const auto x = left_.edges.x.read(rows), y = left_.edges.y.read(rows);
  for (const bool only_similar : {false, true}) {
    CandidateLists lists;
    lists.first.assign(1, 0);
    for (std::size_t i = 0; i < rows; ++i) {
      const auto line = epipolar_line(epipolar_, x[i], y[i]);
      for (auto k = static_cast<std::size_t>(first[i]); k < static_cast<std::size_t>(first[i] + count[i]); ++k) {
        if (only_similar && likeness[k] < static_cast<float>(config_.stereo.refined_ncc_min)) continue;
        lists.target.push_back(anchor[k]);
        lists.x.push_back(line.x + place[k] * line.ex);
        lists.y.push_back(line.y + place[k] * line.ey);
        lists.cue.push_back(likeness[k]);
      }
      lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
    }
    const int order = only_similar ? 9 : 8;
    tap_->stereo_filter(order, stereo_name(order), lists);
  }
  tap_->stereo(rigs_.current().edges);
}

void DeviceFrontend::tap_temporal(int side, const TemporalSearch& search) {
  stages::DeviceCandidates near;
  temporal_candidates_.run(predicted_[side], search.step, side == 0 ? left_index_ : right_index_, search.radius,
                           kAllDirections, near);
  near.state.fill(0, static_cast<std::size_t>(near.host_total));
  tap_->temporal_filter(1, temporal_name(1), side, near.alive_after(1, nullptr));
  const stages::DeviceCandidates& lists = side == 0 ? temporal_left_ : temporal_right_;
  for (int order = 2; order < kAgreementOrder; ++order) {
    const auto* scores = scores_for(lists, order + 1, kTemporalSiftOrder, kTemporalNccOrder);
    tap_->temporal_filter(order, temporal_name(order), side, lists.alive_after(order, scores));
  }
}

}  // namespace quadedge::frontend
