#include <opencv2/calib3d.hpp>

#include "geometry/lens_mapping.hpp"
#include "testing.hpp"

using namespace quadedge;

namespace {

Lens lens_of(LensModel model, std::vector<double> parameters) {
  Lens lens;
  lens.model = model;
  lens.camera = {458.654, 457.296, 367.215, 248.375, 752, 480};
  lens.parameters = std::move(parameters);
  return lens;
}

/// Lenses of every model, with typical parameters of real cameras.
std::vector<Lens> typical_lenses() {
  return {
      lens_of(LensModel::radial_tangential, {}),
      lens_of(LensModel::radial_tangential, {-0.28, 0.074, 2e-4, 2e-5}),
      lens_of(LensModel::radial_tangential, {-0.33, 0.14, -5e-4, 3e-4, -0.03}),
      lens_of(LensModel::radial_tangential, {2.1, 1.3, 1e-4, -2e-4, 0.09, 2.4, 1.9, 0.3}),
      lens_of(LensModel::radial_tangential, {-0.27, 0.08, 2e-4, 2e-5, 0, 0.01, 0, 0, 3e-3, -1e-3, 2e-3, 1e-3}),
      lens_of(LensModel::radial_tangential,
              {-0.27, 0.08, 2e-4, 2e-5, 0, 0.01, 0, 0, 3e-3, -1e-3, 2e-3, 1e-3, 0.02, -0.03}),
      lens_of(LensModel::equidistant, {0.0035, 0.0007, -0.0021, 0.0002}),
      lens_of(LensModel::equidistant, {-0.0033, 0.054, -0.0516, 0.0107}),
      lens_of(LensModel::field_of_view, {0.93}),
      lens_of(LensModel::double_sphere, {-0.2, 0.58}),
      lens_of(LensModel::double_sphere, {0.3, 0.4}),
      lens_of(LensModel::extended_unified, {0.57, 1.2}),
      lens_of(LensModel::omnidirectional, {0.9, -0.1, 0.05, 1e-4, -1e-4}),
      lens_of(LensModel::omnidirectional, {1.2, -0.2, 0.1, 1e-4, -1e-4}),
  };
}

}  // namespace

TEST_CASE("lens: radial, tangential, rational, prism and tilted coefficients agree with OpenCV to 1e-9 px") {
  int counts = 0;
  for (const Lens& lens : typical_lenses()) {
    if (lens.model != LensModel::radial_tangential || lens.parameters.empty()) continue;
    ++counts;
    INFO(lens.parameters.size() << " coefficients");
    const LensMapping mapping(lens);
    const Eigen::Matrix3d k = lens.camera.matrix();
    const cv::Matx33d matrix(k(0, 0), 0, k(0, 2), 0, k(1, 1), k(1, 2), 0, 0, 1);
    for (double y = -0.5; y <= 0.5; y += 0.1) {
      for (double x = -0.8; x <= 0.8; x += 0.1) {
        std::vector<cv::Point2d> expected;
        cv::projectPoints(std::vector<cv::Point3d>{{2 * x, 2 * y, 2}}, cv::Vec3d(0, 0, 0), cv::Vec3d(0, 0, 0), matrix,
                          lens.parameters, expected);
        const auto seen = mapping.project({2 * x, 2 * y, 2});
        REQUIRE(seen);
        CHECK((*seen - Eigen::Vector2d(expected[0].x, expected[0].y)).norm() < 1e-9);
      }
    }
  }
  CHECK(counts == 5);
}

TEST_CASE("lens: equidistant agrees with OpenCV's fisheye model to 1e-9 px") {
  for (const Lens& lens : typical_lenses()) {
    if (lens.model != LensModel::equidistant) continue;
    const LensMapping mapping(lens);
    const cv::Matx33d matrix(458.654, 0, 367.215, 0, 457.296, 248.375, 0, 0, 1);
    const cv::Vec4d coefficients(lens.parameters[0], lens.parameters[1], lens.parameters[2], lens.parameters[3]);
    for (double angle = 0.02; angle < 1.5; angle += 0.05) {
      const Eigen::Vector3d ray(std::sin(angle) * std::cos(3 * angle), std::sin(angle) * std::sin(3 * angle),
                                std::cos(angle));
      std::vector<cv::Point2d> expected;
      cv::fisheye::projectPoints(std::vector<cv::Point3d>{{ray.x(), ray.y(), ray.z()}}, expected, cv::Vec3d(0, 0, 0),
                                 cv::Vec3d(0, 0, 0), matrix, coefficients);
      const auto seen = mapping.project(ray);
      REQUIRE(seen);
      CHECK((*seen - Eigen::Vector2d(expected[0].x, expected[0].y)).norm() < 1e-9);
    }
  }
}

TEST_CASE("lens: projection inverts unprojection to 1e-9 px in every model") {
  for (const Lens& lens : typical_lenses()) {
    INFO(to_string(lens.model) << ", " << lens.parameters.size() << " parameters");
    const LensMapping mapping(lens);
    int seen = 0;
    for (int y = -20; y < 500; y += 13) {
      for (int x = -20; x < 772; x += 17) {
        const auto ray = mapping.ray(Eigen::Vector2d(x, y));
        if (!ray) continue;
        ++seen;
        CHECK(std::abs(ray->norm() - 1) < 1e-12);
        const auto back = mapping.project(3.7 * *ray);
        REQUIRE(back);
        CHECK((*back - Eigen::Vector2d(x, y)).norm() < 1e-9);
      }
    }
    CHECK(seen > 1700);  // of 1800: every model covers all but the corners
  }
}

TEST_CASE("lens: special parameters give known projections") {
  const double f = 458.654;
  const auto radius = [&](LensModel model, std::vector<double> parameters, double angle) {
    Lens lens = lens_of(model, std::move(parameters));
    lens.camera.cx = lens.camera.cy = 0;
    return LensMapping(lens).project({std::sin(angle), 0, std::cos(angle)})->x();
  };
  for (const double angle : {0.1, 0.7, 1.3}) {
    CHECK(radius(LensModel::equidistant, {0, 0, 0, 0}, angle) == Approx(f * angle).epsilon(1e-12));
    CHECK(radius(LensModel::double_sphere, {0, 0}, angle) == Approx(f * std::tan(angle)).epsilon(1e-12));
    // Stereographic: projected from the far pole of the sphere.
    CHECK(radius(LensModel::double_sphere, {0, 0.5}, angle) == Approx(2 * f * std::tan(angle / 2)).epsilon(1e-12));
    CHECK(radius(LensModel::omnidirectional, {1}, angle) == Approx(f * std::tan(angle / 2)).epsilon(1e-12));
    CHECK(radius(LensModel::omnidirectional, {0}, angle) == Approx(f * std::tan(angle)).epsilon(1e-12));
    // alpha d + (1 - alpha) z = (1 - alpha) (z + xi d) with xi = alpha / (1 - alpha): focal lengths by 1 / (1 - alpha).
    CHECK(radius(LensModel::extended_unified, {0.6, 1}, angle) ==
          Approx(radius(LensModel::omnidirectional, {0.6 / 0.4}, angle) / 0.4).epsilon(1e-12));
    // tan(w / 2) = 1 / 2 leaves atan(tan(angle)) = angle.
    const double w = 2 * std::atan(0.5);
    CHECK(radius(LensModel::field_of_view, {w}, angle) == Approx(f * angle / w).epsilon(1e-12));
  }
}

TEST_CASE("lens: the scale on the axis equals the scale of small angles") {
  for (const Lens& lens : typical_lenses()) {
    INFO(to_string(lens.model));
    const LensMapping mapping(lens);
    const Eigen::Vector2d step = (*mapping.project({1e-5, 0, 1}) - *mapping.project({-1e-5, 0, 1})) / 2e-5;
    const bool is_tilted = lens.parameters.size() == 14;
    CHECK(step.x() == Approx(mapping.axial_scale() * lens.camera.fx).epsilon(is_tilted ? 1e-2 : 1e-8));
  }
}

TEST_CASE("lens: nothing projects beyond the angle where the image folds back") {
  // r (1 - 0.3 r^2) is largest at r^2 = 1 / 0.9.
  const double turn = std::sqrt(1 / 0.9);
  const LensMapping radial(lens_of(LensModel::radial_tangential, {-0.3, 0, 0, 0}));
  CHECK(radial.project({turn - 1e-3, 0, 1}));
  CHECK_FALSE(radial.project({turn + 1e-3, 0, 1}));
  CHECK_FALSE(radial.project({0.1, 0, -1}));
  CHECK(radial.ray({458.654 * (turn * 2 / 3 - 1e-4) + 367.215, 248.375}));
  CHECK_FALSE(radial.ray({458.654 * (turn * 2 / 3 + 1e-4) + 367.215, 248.375}));
  // theta (1 - theta^2 / 3) is largest at theta = 1.
  const LensMapping fisheye(lens_of(LensModel::equidistant, {-1.0 / 3, 0, 0, 0}));
  CHECK(fisheye.project({std::sin(0.97), 0, std::cos(0.97)}));
  CHECK_FALSE(fisheye.project({std::sin(1.02), 0, std::cos(1.02)}));
  // A fisheye without a fold also sees points behind its image plane.
  const LensMapping wide(lens_of(LensModel::equidistant, {0, 0, 0, 0}));
  CHECK(wide.project({1, 0, -0.5})->x() == Approx(458.654 * (kPi - std::atan(2.0)) + 367.215));
}
