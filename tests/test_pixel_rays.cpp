#include "data/sequence_writer.hpp"
#include "dataset_files.hpp"
#include "geometry/lens_mapping.hpp"
#include "scenes/lenses.hpp"
#include "scenes/render.hpp"
#include "scenes/scenes.hpp"

using namespace quadedge;

namespace {

constexpr int kRaysWidth = 236, kRaysHeight = 122;
constexpr double kFocal = 135;

Lens small_lens(const std::string& name) {
  Lens lens = synthetic::make_lens(name, kFocal);
  lens.camera.cx = 0.51 * kRaysWidth;
  lens.camera.cy = 0.48 * kRaysHeight;
  lens.camera.width = kRaysWidth;
  lens.camera.height = kRaysHeight;
  return lens;
}

float interpolated(const std::vector<double>& grey, double x, double y) {
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  const auto at = [&](int column, int row) { return grey[static_cast<std::size_t>(row * kRaysWidth + column)]; };
  const double a = x - i, b = y - j;
  return static_cast<float>((1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
                            b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1)));
}

}  // namespace

TEST_CASE("pixel rays: every lens follows its calibration", "[synthetic]") {
  for (const std::string& name : synthetic_lenses()) {
    INFO(name);
    const Lens lens = small_lens(name);
    const LensMapping mapping(lens);
    const synthetic::PixelRays rays(lens);
    int seen = 0;
    for (int y = 0; y < kRaysHeight; y += 7) {
      for (int x = 0; x < kRaysWidth; x += 5) {
        if (!rays.is_visible(x, y)) continue;
        ++seen;
        CHECK((*mapping.project(rays.centre(x, y)) - Eigen::Vector2d(x, y)).norm() < 1e-9);
        CHECK((*mapping.project(rays.corner(x, y)) - Eigen::Vector2d(x - 0.5, y - 0.5)).norm() < 1e-9);
        const Eigen::Vector2d offset(0.31, -0.22);
        CHECK((*mapping.project(rays.within(x, y, offset)) - Eigen::Vector2d(x, y) - offset).norm() < 0.02);
        CHECK((rays.within(x, y, {0.5, 0}) - rays.within(x, y, {-0.5, 0})).norm() * rays.focal_length(x, y) ==
              Approx(1).margin(name == "pinhole" || name == "radtan" ? 0.3 : 2));
      }
    }
    CHECK(seen > 700);  // of 864
  }
}

TEST_CASE("pixel rays: a rendered lens image, undistorted, equals the rendered pinhole view", "[synthetic]") {
  const synthetic::Scene scene = synthetic::make_scene("room", 7, kFocal);
  const Eigen::Isometry3d pose(Eigen::AngleAxisd(0.1, Eigen::Vector3d(0.2, 1, 0).normalized()));
  for (const std::string& name : synthetic_lenses()) {
    if (name == "pinhole") continue;
    INFO(name);
    StereoCalibration calibration;
    calibration.left = calibration.right = small_lens(name);
    calibration.right_from_left.translation().x() = -0.1;
    const StereoRig rig = make_rig(calibration);
    const auto recorded = synthetic::render(scene, calibration.left, pose, 4, 2),
               expected = synthetic::render(scene, rig.left, pose, 4, 2);
    // Shift between the undistorted image and the other, by least squares over its gradient.
    double moved[2] = {0, 0}, squares[2] = {0, 0}, depth_error = 0;
    int compared = 0;
    for (int y = 5; y < kRaysHeight - 5; ++y) {
      for (int x = 5; x < kRaysWidth - 5; ++x) {
        const auto at = static_cast<std::size_t>(y * kRaysWidth + x);
        if (!rig.left_mask.empty() && rig.left_mask.hidden[at] != 0) continue;
        const double from_x = static_cast<double>(rig.left_undistortion.source_x[at]),
                     from_y = static_cast<double>(rig.left_undistortion.source_y[at]);
        if (!(from_x < kRaysWidth - 2 && from_y < kRaysHeight - 2)) continue;
        const double difference = static_cast<double>(interpolated(recorded.grey, from_x, from_y)) - expected.grey[at];
        const double slope[2] = {0.5 * (expected.grey[at + 1] - expected.grey[at - 1]),
                                 0.5 * (expected.grey[at + kRaysWidth] - expected.grey[at - kRaysWidth])};
        for (int axis = 0; axis < 2; ++axis) {
          moved[axis] += difference * slope[axis];
          squares[axis] += slope[axis] * slope[axis];
        }
        const float depth =
            recorded.depth[static_cast<std::size_t>(std::lround(from_y) * kRaysWidth + std::lround(from_x))];
        depth_error += std::abs(static_cast<double>(depth / expected.depth[at]) - 1) < 0.02 ? 0 : 1;
        ++compared;
      }
    }
    CHECK(compared > 20'000);
    CHECK(std::abs(moved[0] / squares[0]) < 0.01);
    CHECK(std::abs(moved[1] / squares[1]) < 0.01);
    CHECK(depth_error < 0.06 * compared);  // outlines
  }
}

TEST_CASE("pixel rays: a lens and a rotated camera are read back as they were rendered", "[synthetic]") {
  const TemporaryFolder folder;
  auto options = rendering(kRaysWidth, kRaysHeight, kFocal, 2, 1);
  options.right_rotation = {0.3, 2, -0.5};
  for (const char* lens : {"pinhole", "equidistant", "omni"}) {
    INFO(lens);
    options.lens = lens;
    const SyntheticSequence sequence(options);
    const Eigen::Isometry3d left_from_right = sequence.rig().right_from_left.inverse();
    CHECK((left_from_right.translation() - Eigen::Vector3d(options.baseline, 0, 0)).norm() < 2e-9);
    const Eigen::AngleAxisd turn(left_from_right.linear());
    CHECK((turn.angle() * turn.axis() - options.right_rotation * kDegree).norm() < 2e-9);
    write_eth3d_slam(folder / lens, sequence);
    const Dataset set = open_dataset(folder / lens);
    CHECK(check_dataset(folder / lens).errors.empty());
    CHECK(set.rig.left.matrix() == sequence.rig().left.matrix());
    CHECK(set.rig.right_undistortion.source_x.values() == sequence.rig().right_undistortion.source_x.values());
    CHECK(set.rig.right_mask.hidden == sequence.rig().right_mask.hidden);
    CHECK((set.rig.right_from_left.matrix() - sequence.rig().right_from_left.matrix()).cwiseAbs().maxCoeff() < 1e-15);
    CHECK(read_grey_image(set.frames[1].right).pixels == sequence.render(1, Side::right).image.pixels);
  }
}
