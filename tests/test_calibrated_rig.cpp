#include "dataset_files.hpp"
#include "geometry/lens_mapping.hpp"

using namespace quadedge;
using Catch::Matchers::Contains;

namespace {

StereoCalibration calibration_of(LensModel model, std::vector<double> parameters, int width = 160, int height = 120) {
  StereoCalibration calibration;
  calibration.left.model = model;
  calibration.left.camera = {100, 101, 79.5, 60.25, width, height};
  calibration.left.parameters = std::move(parameters);
  calibration.right = calibration.left;
  calibration.right_from_left.translation().x() = -0.1;
  calibration.files = "rig.yaml";
  return calibration;
}

std::size_t hidden_pixels(const PixelMask& mask) {
  return static_cast<std::size_t>(std::count(mask.hidden.begin(), mask.hidden.end(), 1));
}

}  // namespace

TEST_CASE("calibrated rig: images of pinhole cameras stay unchanged") {
  const StereoRig rig = make_rig(calibration_of(LensModel::radial_tangential, {0, 0, 0, 0}));
  CHECK(rig.left_undistortion.empty());
  CHECK(rig.left_mask.empty());
  CHECK(rig.left.fx == 100);
  CHECK(rig.disparity_range() == Approx(100 * 0.1 / 0.5));
}

TEST_CASE("calibrated rig: the view keeps the lens's scale up to 120 degrees, or has the requested field of view") {
  CHECK(make_rig(calibration_of(LensModel::double_sphere, {-0.2, 0.5})).left.fx == Approx(125));
  // 160 px at 30 px per radian would be 139 degrees.
  StereoCalibration wide = calibration_of(LensModel::equidistant, {0, 0, 0, 0});
  wide.left.camera.fx = 30;
  wide.left.camera.fy = 33;
  const StereoRig bounded = make_rig(wide);
  CHECK(bounded.left.fx == Approx(80 / std::tan(60 * kDegree)));
  CHECK(bounded.left.fy == Approx(1.1 * bounded.left.fx));
  CHECK(bounded.right.fx == 100);
  const StereoRig asked = make_rig(wide, 90);
  CHECK(asked.left.fx == Approx(80));
  CHECK(asked.left.cx == 79.5);
  CHECK(asked.left.width == 160);
  CHECK_THROWS_AS(make_rig(wide, 180), UsageError);
  CHECK_THROWS_AS(make_rig(wide, -1), UsageError);
  wide.right.camera.width = wide.right.camera.height = 0;
  CHECK_THROWS_WITH(make_rig(wide), Contains("rig.yaml") && Contains("size"));
}

TEST_CASE("calibrated rig: the mask hides exactly the area outside the recorded image") {
  // Pincushion: the pinhole view extends beyond the recorded image.
  for (const auto& calibration : {calibration_of(LensModel::radial_tangential, {0.3, 0, 0, 0}),
                                  calibration_of(LensModel::radial_tangential, {-0.6, 0, 0, 0})}) {
    const StereoRig rig = make_rig(calibration);
    const LensMapping mapping(calibration.left);
    std::size_t hidden = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 160; ++x) {
        const auto seen = mapping.project(rig.left.ray(Eigen::Vector2d(x, y)));
        const bool shown = seen && seen->x() >= 0 && seen->x() <= 159 && seen->y() >= 0 && seen->y() <= 119;
        const auto at = static_cast<std::size_t>(y * 160 + x);
        REQUIRE(rig.left_mask.hidden[at] == (shown ? 0 : 1));
        hidden += shown ? 0 : 1;
        CHECK(std::isfinite(rig.left_undistortion.source_x[at]));
      }
    }
    CHECK(hidden > 500);
    CHECK(hidden < 10'000);
    CHECK_NOTHROW(check_rig(rig, "here"));
  }
}

TEST_CASE("calibrated rig: a user's mask is mapped to the pinhole image") {
  const TemporaryFolder folder;
  cv::Mat drawn(120, 160, CV_8UC1, cv::Scalar(255));
  drawn(cv::Rect(0, 100, 160, 20)) = 0;  // a car's bonnet
  REQUIRE(cv::imwrite(folder / "bonnet.png", drawn));
  StereoRig plain = make_rig(calibration_of(LensModel::radial_tangential, {}));
  mask_rig(plain, folder / "bonnet.png");
  CHECK(hidden_pixels(plain.left_mask) == 160u * 20u);
  CHECK(hidden_pixels(plain.right_mask) == 160u * 20u);
  CHECK(plain.left_mask.hidden[100 * 160] == 1);
  StereoRig bent = make_rig(calibration_of(LensModel::radial_tangential, {-0.2, 0, 0, 0}));
  REQUIRE(bent.left_mask.empty());
  mask_rig(bent, folder / "bonnet.png");
  for (std::size_t i = 0; i < bent.left_mask.hidden.size(); ++i)
    REQUIRE(bent.left_mask.hidden[i] == (bent.left_undistortion.source_y[i] > 99 ? 1 : 0));
  // One mask per camera.
  REQUIRE(cv::imwrite(folder / "all.png", cv::Mat(120, 160, CV_8UC1, cv::Scalar(1))));
  StereoRig half = make_rig(calibration_of(LensModel::radial_tangential, {}));
  mask_rig(half, (folder / "all.png") + "," + (folder / "bonnet.png"));
  CHECK(hidden_pixels(half.left_mask) == 0);
  CHECK(hidden_pixels(half.right_mask) == 160u * 20u);

  REQUIRE(cv::imwrite(folder / "small.png", cv::Mat(60, 80, CV_8UC1, cv::Scalar(255))));
  CHECK_THROWS_WITH(mask_rig(half, folder / "small.png"), Contains("small.png") && Contains("80 x 60"));
  REQUIRE(cv::imwrite(folder / "black.png", cv::Mat(120, 160, CV_8UC1, cv::Scalar(0))));
  CHECK_THROWS_WITH(mask_rig(half, folder / "black.png"), Contains("black everywhere"));
  CHECK_THROWS_AS(mask_rig(half, folder / "absent.png"), DataError);
}
