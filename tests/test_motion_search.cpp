#include "frontends.hpp"
#include "motion/motion_proposals.hpp"
#include "motion/motion_search.hpp"
#include "motion/odometry_constants.hpp"
#include "motion/pose_constants.hpp"
#include "motion/scoring.hpp"

using namespace quadedge;
using namespace matching;

namespace {

/// The reference front end with counters of its calls.
class CountingFrontend : public frontend::GlobalFrontend {
 public:
  CountingFrontend(const StereoRig& rig, const Config& config)
      : GlobalFrontend(rig, config), device_("reference"), reference_(frontend::make_frontend(rig, device_, config)) {}

  frontend::FrameEdgesHandle process(const StereoFrame& frame) override { return reference_->process(frame); }
  frontend::FrameEdgesHandle latest() const override { return reference_->latest(); }
  void match(const frontend::FrameEdges& base, const frontend::FrameEdges& current, const TemporalSearch& search,
             TemporalMatches& matches) override {
    ++(search.coarse ? coarse : search.step > 1 ? thinned : guided);
    largest_radius = std::max(largest_radius, search.radius);
    reference_->match(base, current, search, matches);
  }
  void match_globally(const frontend::FrameEdges& base, const frontend::FrameEdges& current, int edges,
                      TemporalMatches& matches) override {
    ++global;
    global_edges = edges;
    frontend::as_global(*reference_).match_globally(base, current, edges, matches);
  }
  void match_globally(const frontend::FrameEdges& base, const frontend::FrameEdges& current, const GlobalSearch& among,
                      TemporalMatches& matches) override {
    ++beside;
    frontend::as_global(*reference_).match_globally(base, current, among, matches);
  }
  frontend::KeptFrameEdges keep() override { return frontend::as_global(*reference_).keep(); }
  frontend::FrameEdgesHandle restore(const frontend::KeptFrameEdges& kept) override {
    return frontend::as_global(*reference_).restore(kept);
  }
  EdgeSet edges(Side side) override { return reference_->edges(side); }
  std::size_t device_bytes() const override { return 0; }

  int coarse = 0, guided = 0, thinned = 0, global = 0, beside = 0, global_edges = 0;
  float largest_radius = 0;

 private:
  Device device_;
  std::unique_ptr<frontend::Frontend> reference_;
};

/// Two frames of the room and the search between them.
struct TwoFrames {
  RenderedScene scene{"room", 200, 125, 2, 3};
  std::unique_ptr<CountingFrontend> frontend;
  std::unique_ptr<odometry::MotionSearch> search;
  odometry::MotionQuery query;

  explicit TwoFrames(int global_edges) {
    scene.config.temporal.global_edges = global_edges;
    frontend = std::make_unique<CountingFrontend>(scene.rig, scene.config);
    search = std::make_unique<odometry::MotionSearch>(scene.config, *frontend, scene.rig);
    query.rig.disparity_offset_sigma = scene.config.pose.disparity_offset_sigma;
    query.base = frontend->process(scene.frame(0));
    query.current = frontend->process(scene.frame(1));
  }
  Eigen::Isometry3d truth() const { return scene.world_from_left[1].inverse() * scene.world_from_left[0]; }

  /// Finds the motion and compares it with the true one.
  void check(const std::optional<Eigen::Isometry3d>& prediction) {
    query.prediction = prediction;
    frontend->coarse = frontend->guided = frontend->thinned = frontend->global = frontend->beside = 0;
    frontend->largest_radius = 0;
    const auto step = search->find(query);
    REQUIRE(step->ok());
    CHECK(step->base == query.base);
    CHECK((step->motion.current_from_previous.translation() - truth().translation()).norm() < 6e-3);
    CHECK(Eigen::AngleAxisd((step->motion.current_from_previous * truth().inverse()).linear()).angle() <
          0.15 * kDegree);
    search->remember(*step);
  }
};

/// A motion whose predictions are all wrong.
Eigen::Isometry3d turned(const Eigen::Isometry3d& motion) {
  return Eigen::AngleAxisd(30 * kDegree, Eigen::Vector3d::UnitY()) * motion;
}

}  // namespace

TEST_CASE("motion search: a good prediction ends it, any other starts the global search", "[long]") {
  TwoFrames frames(3000);
  for (int first = 0; first < 3; ++first) {  // are also searched for a second motion
    frames.check(frames.truth());
    CHECK(frames.frontend->global == 0);
    CHECK(frames.frontend->beside == 1);
  }
  frames.check(frames.truth());
  CHECK(frames.frontend->coarse == 1);
  CHECK(frames.frontend->guided > 0);
  CHECK(frames.frontend->global == 0);
  CHECK(frames.frontend->beside == 0);
  frames.check(std::nullopt);
  CHECK(frames.frontend->coarse == 0);
  CHECK(frames.frontend->global == 1);
  frames.check(turned(frames.truth()));
  CHECK(frames.frontend->coarse == 1);
  CHECK(frames.frontend->global == 1);
}

TEST_CASE("motion search: at the start few global matches suffice, unless they leave a doubt") {
  TwoFrames frames(3000);
  frames.query.at_start = true;
  frames.check(std::nullopt);
  CHECK(frames.frontend->global == 1);
  CHECK(frames.frontend->global_edges == 1000);
  CHECK(frames.frontend->beside == 1);  // what does not follow is searched for another motion all the same
  odometry::MotionStep ambiguous;
  ambiguous.verdict.refusal = odometry::Refusal::none;
  ambiguous.verdict.ambiguity = {odometry::AmbiguityKind::competing_motion, 0.5};
  frames.search->remember(ambiguous);
  frames.check(std::nullopt);
  CHECK(frames.frontend->global == 2);
  CHECK(frames.frontend->global_edges == 3000);
  frames.query.at_start = false;
  frames.search->remember(ambiguous);
  frames.check(frames.truth());
  CHECK(frames.frontend->thinned == 2);  // shows that the camera does not stand still, nor edges around what moves

  TwoFrames sparse(120);
  sparse.query.at_start = true;
  sparse.check(std::nullopt);  // the matches of 40 edges lie in too few cells
  CHECK(sparse.frontend->global == 2);
  CHECK(sparse.frontend->global_edges == 120);
  sparse.query.at_start = false;
  sparse.check(std::nullopt);
  CHECK(sparse.frontend->global == 2);
  CHECK(sparse.frontend->global_edges == 120);
}

TEST_CASE("motion search: another motion is searched for at the start, in every tenth frame and after a loss",
          "[long]") {
  TwoFrames frames(3000);
  frames.query.prediction = frames.truth();
  const auto is_checked = [&] {
    frames.frontend->beside = 0;
    const auto step = frames.search->find(frames.query);
    CHECK(step->ok());
    CHECK(step->is_checked == (frames.frontend->beside == 1));
    frames.search->remember(*step);
    return step->is_checked;
  };
  for (int frame = 0; frame < 22; ++frame) CHECK(is_checked() == (frame < 3 || frame == 12));
  frames.search->remember(odometry::MotionStep());
  for (int frame = 0; frame < 4; ++frame) CHECK(is_checked() == (frame < 3));
}

TEST_CASE("motion search: without the global search the coarse search widens") {
  TwoFrames frames(0);
  const double wide = odometry::kLargeRadiusRatio * 200;
  frames.check(frames.truth());
  CHECK(frames.frontend->coarse == 1);
  CHECK(frames.frontend->largest_radius == static_cast<float>(frames.scene.config.temporal.coarse_radius));
  frames.check(std::nullopt);
  CHECK(frames.frontend->coarse == 1);
  CHECK(frames.frontend->largest_radius == static_cast<float>(wide));
  CHECK(frames.frontend->global == 0);
}
