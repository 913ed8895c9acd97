/// \file test_taps.cpp  What a tap is told of the searches in time, and that it changes nothing.
#include "frontends.hpp"

using namespace quadedge;

namespace {

/// The searches of the last frame and what each found.
class Searches : public Tap {
 public:
  void edges(const EdgeSet&, const EdgeSet&) override {
    observed.clear();
    found.clear();
    for (auto& rows : alive) rows.clear();
  }
  void temporal_search(const ObservedSearch& search) override { observed.push_back(search); }
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& lists) override {
    if (filter != TemporalFilter::nearly_best_sift) return;
    int rows = 0;
    for (std::size_t row = 0; row + 1 < lists.first.size(); ++row) rows += lists.first[row] < lists.first[row + 1];
    alive[index_of(side)].push_back(rows);
  }
  void quads(const TemporalMatches& matches) override { found.push_back(matches); }

  std::vector<ObservedSearch> observed;
  std::vector<TemporalMatches> found;  ///< one per search
  std::vector<int> alive[2];           ///< per side and search: edges with a candidate before the agreement
};

/// Two frames of the cables, then four of the room: tracking is lost in between and resumes from the lost frame.
std::vector<FrameResult> track_with_loss(const std::string& device_name, Tap* tap,
                                         const std::function<void(const FrameResult&, const FrameDetails&)>& visit) {
  static const matching::RenderedScene before("cables", 240, 150, 2), after("room", 240, 150, 4);
  Config config = after.config;
  config.stereo.max_disparity = std::max(config.stereo.max_disparity, before.config.stereo.max_disparity);
  Device device(device_name, kept_programs());
  StereoOdometry odometry(after.rig, device, config);
  odometry.set_tap(tap);
  std::vector<FrameResult> results;
  for (const auto* scene : {&before, &after}) {
    for (std::size_t i = 0; i < scene->left.size(); ++i) {
      StereoFrame frame = scene->frame(i);
      frame.stamp_ns = static_cast<std::int64_t>(results.size());
      results.push_back(odometry.track(frame));
      visit(results.back(), odometry.details());
    }
  }
  return results;
}

}  // namespace

TEST_CASE("A tap receives the base frame of each search and the one that gave the motion, and the poses stay the same",
          "[device]") {
  for (const auto& device : all_devices()) {
    Searches tap;
    int frame = 0, relocalisations = 0, oldest = 0;
    const auto seen = track_with_loss(device, &tap, [&](const FrameResult& result, const FrameDetails& details) {
      INFO("device " << device << ", frame " << frame);
      CHECK((result.status == FrameStatus::tracked) == (result.diagnostics.search >= 0));
      for (std::size_t s = 0; s < tap.observed.size(); ++s) {
        CHECK(tap.observed[s].number == static_cast<int>(s));
        CHECK(tap.observed[s].base_frame < frame);
        CHECK(tap.observed[s].base_frame >= oldest);  // older frames may be forgotten
      }
      oldest = result.reference_frame;
      if (result.diagnostics.search >= 0) {
        const auto s = static_cast<std::size_t>(result.diagnostics.search);
        REQUIRE(s < tap.found.size());
        CHECK(tap.observed[s].step == 1);
        CHECK(tap.observed[s].base_frame == result.diagnostics.base_frame);
        CHECK(tap.observed[s].left.x.size() == details.previous_stereo.size());
        CHECK(matching::same_bytes(tap.found[s], details.quads));
        CHECK(details.quads.search == result.diagnostics.search);
        CHECK(result.counts.temporal_left == tap.alive[0][s]);
        CHECK(result.counts.temporal_right == tap.alive[1][s]);
        if (result.message.find("relocalised") != std::string::npos) {
          ++relocalisations;
          CHECK(tap.observed[s].base_frame == frame - 1);
        }
      }
      ++frame;
    });
    CHECK(relocalisations == 1);
    const auto unseen = track_with_loss(device, nullptr, [](const FrameResult&, const FrameDetails&) {});
    REQUIRE(seen.size() == unseen.size());
    for (std::size_t i = 0; i < seen.size(); ++i) {
      INFO("device " << device << ", frame " << i);
      CHECK(seen[i].status == unseen[i].status);
      CHECK(seen[i].diagnostics.search == unseen[i].diagnostics.search);
      CHECK(seen[i].pose_or_prediction().matrix() == unseen[i].pose_or_prediction().matrix());
      CHECK(seen[i].relative_covariance == unseen[i].relative_covariance);
    }
  }
}
