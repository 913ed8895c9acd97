#include "scenes/reflectance.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"
#include "tracked_room.hpp"

using namespace quadedge;
using namespace matching;
using namespace tracked_room;

namespace {

/// Period of the panels [m].
constexpr double kPanel = 0.6;

/// A camera that looks straight at equal panels, as at solar panels from above, and is at these places along them [m].
/// \param spots whether every panel has spots of its own
RenderedScene panels(const std::vector<double>& places, bool spots) {
  const StereoRig rig = room().rig;
  synthetic::SceneBuilder build(11, rig.left.fx, Eigen::Isometry3d::Identity());
  const double half = 0.5 * kPanel, distance = 3;
  const auto texture = [&](double size) {
    return build.speckled(synthetic::leaves(0.12, 3, 0.5, 120.0), size, size, distance);
  };
  const auto panel = texture(half);
  for (int column = -6; column < 14; ++column)
    for (int row = -4; row <= 4; ++row) {
      const Eigen::Vector3d centre(column * kPanel, row * kPanel, distance);
      build.plane(synthetic::pose(centre, 0, 0, 0), half, half, panel);
      const Eigen::Vector3d spot = centre + Eigen::Vector3d(0.04 * (column % 4), 0.05 * (row % 3), -0.001);
      if (spots) build.plane(synthetic::pose(spot, 0, 0, 0), 0.12, 0.12, texture(0.12));
    }
  const synthetic::Scene scene = build.finish(distance, {});
  RenderedScene rendered = room();
  rendered.left.clear();
  rendered.right.clear();
  rendered.world_from_left.clear();
  const auto render = [&](const PinholeCamera& camera, const Eigen::Isometry3d& camera_from_world) {
    const auto view = synthetic::render(scene, camera, camera_from_world, 3, 0);
    Image image(camera.width, camera.height);
    for (std::size_t i = 0; i < view.grey.size(); ++i)
      image.pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(view.grey[i]), 0L, 255L));
    return image;
  };
  for (const double place : places) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation().x() = place;
    rendered.world_from_left.push_back(pose);
    rendered.left.push_back(render(rig.left, pose.inverse()));
    rendered.right.push_back(render(rig.right, rig.right_from_left * pose.inverse()));
  }
  return rendered;
}

/// What is said of a step from one frame to the next.
struct Steps {
  int wrong = 0;     ///< and not ambiguous, nor lost
  int doubtful = 0;  ///< ambiguous or lost
};

Steps steps_of(const RenderedScene& scene) {
  Steps steps;
  const auto results = track(scene, all_devices().front(), scene.config);
  for (std::size_t i = 1; i < results.size(); ++i) {
    INFO(i << " " << results[i].message);
    const bool doubtful = !results[i].world_from_left || results[i].ambiguous_motion;
    steps.doubtful += doubtful ? 1 : 0;
    if (doubtful || !results[i - 1].world_from_left) continue;
    const double step = (results[i - 1].world_from_left->inverse() * *results[i].world_from_left).translation().x(),
                 truth = scene.world_from_left[i].translation().x() - scene.world_from_left[i - 1].translation().x();
    steps.wrong += std::abs(step - truth) > 0.02 ? 1 : 0;
  }
  return steps;
}

}  // namespace

TEST_CASE("repetition: a scene that repeats is ambiguous at full speed from the start, and stays so",
          "[odometry][device]") {
  const double step = 0.75 * kPanel;
  const Steps steps = steps_of(panels({0, step, 2 * step, 3 * step, 4 * step}, false));
  CHECK(steps.wrong == 0);
  CHECK(steps.doubtful == 4);
}

TEST_CASE("repetition: what tells the copies apart decides", "[odometry][device]") {
  const double step = 0.75 * kPanel;
  const Steps steps = steps_of(panels({0, step, 2 * step, 3 * step, 4 * step}, true));
  CHECK(steps.wrong == 0);
  CHECK(steps.doubtful <= 1);
}

TEST_CASE("repetition: the predicted motion of a repeated scene leaves no doubt below half a period",
          "[odometry][device]") {
  const Steps steps = steps_of(panels({0, 0, 0.05, 0.12, 0.21, 0.33, 0.48, 0.65, 0.84, 1.05, 1.28}, false));
  CHECK(steps.wrong == 0);
  CHECK(steps.doubtful == 0);
}
