/// \file reference_frontend_taps.cpp  Passes data of the reference's stereo cascade to a tap, from the candidate lists
/// on.
#include "frontend/reference_frontend.hpp"

namespace quadedge::frontend {
namespace {

/// Candidates that no filter up to `filter` has rejected, with the scores that the next filter compares.
CandidateLists alive_after(StereoFilter filter, const reference::Candidates& candidates,
                           const reference::CandidateScores& scores) {
  const StereoFilter judge = next(filter);
  const bool by_sift = judge == StereoFilter::sift || judge == StereoFilter::nearly_best_sift,
             by_ncc = judge == StereoFilter::ncc || judge == StereoFilter::nearly_best_ncc;
  CandidateLists lists;
  lists.first.assign(1, 0);
  for (std::size_t row = 0; row + 1 < candidates.first.size(); ++row) {
    for (auto c = static_cast<std::size_t>(candidates.first[row]);
         c < static_cast<std::size_t>(candidates.first[row + 1]); ++c) {
      if (scores.state[c] != kCandidateAlive && scores.state[c] <= order_of(filter)) continue;
      lists.target.push_back(candidates.target[c]);
      if (by_sift || by_ncc) lists.cue.push_back(by_sift ? scores.sift[c] : scores.ncc[c]);
    }
    lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
  }
  return lists;
}

}  // namespace

void ReferenceFrontend::tap_candidates() {
  for (auto filter = StereoFilter::orientation; filter < StereoFilter::refinement; filter = next(filter))
    tap_->stereo_filter(filter, alive_after(filter, candidates_, scores_));
}

void ReferenceFrontend::tap_clusters() {
  const auto lists_that = [&](const auto& pass) {
    CandidateLists lists;
    lists.first.assign(1, 0);
    for (std::size_t i = 0; i + 1 < clusters_.first.size(); ++i) {
      const auto line = epipolar_line(range_.geometry(), left_edges_.x[i], left_edges_.y[i]);
      for (auto k = static_cast<std::size_t>(clusters_.first[i]); k < static_cast<std::size_t>(clusters_.first[i + 1]);
           ++k) {
        if (!pass(i, k)) continue;
        const auto position = static_cast<float>(clusters_.position[k]);
        lists.target.push_back(clusters_.anchor[k]);
        lists.x.push_back(line.x + position * line.ex);
        lists.y.push_back(line.y + position * line.ey);
        lists.cue.push_back(static_cast<float>(clusters_.similarity[k]));
      }
      lists.first.push_back(static_cast<std::int32_t>(lists.target.size()));
    }
    return lists;
  };
  tap_->stereo_filter(StereoFilter::refinement, lists_that([](std::size_t, std::size_t) { return true; }));
  tap_->stereo_filter(StereoFilter::relaxation, lists_that([&](std::size_t i, std::size_t k) {
                        return relaxation_.chosen[i] == static_cast<std::int32_t>(k);
                      }));
}

}  // namespace quadedge::frontend
