// The renderer's geometry: silhouettes and textures agree with analytic projection.
#include "scenes/reflectance.hpp"
#include "scenes/render.hpp"
#include "testing.hpp"

using namespace quadedge;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Root of a function that changes sign between low and high.
double bisect(double low, double high, const std::function<double(double)>& function) {
  const bool low_sign = function(low) > 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (function(middle) > 0.0 ? low_sign : !low_sign) ? low = middle : high = middle;
  }
  return 0.5 * (low + high);
}

std::shared_ptr<const synthetic::Texture> plain(double grey) {
  synthetic::TextureStyle style;
  style.noise = 0.0;
  style.mean = grey;
  return std::make_shared<synthetic::Texture>(synthetic::dead_leaves(style, 1), 5.0, 5.0, 0.1);
}

Isometry3d at(const Vector3d& position, double yaw = 0.0, double pitch = 0.0, double roll = 0.0) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = position;
  pose.linear() = (Eigen::AngleAxisd(yaw, Vector3d::UnitY()) * Eigen::AngleAxisd(pitch, Vector3d::UnitX()) *
                   Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
                      .toRotationMatrix();
  return pose;
}

/// Grey level of a plain surface with this outward normal in the scenes' light.
double shaded(double grey, const Vector3d& normal) {
  return grey * synthetic::shade(normal, synthetic::light_direction(), 0.72);
}

}  // namespace

TEST_CASE("the rendered silhouette of a curved tube agrees with analytic geometry", "[long][synthetic]") {
  const PinholeCamera camera{400.0, 400.0, 101.3, 58.7, 200, 120};
  const Isometry3d camera_from_world = at({0.02, -0.03, 0.05}, 0.02, -0.03, 0.015);
  const double wall = shaded(200.0, -Vector3d::UnitZ());
  const std::vector<Vector3d> control = {{-1.2, 0.1, 2.1}, {-0.8, 0.0, 2.0}, {-0.4, 0.15, 1.9}, {0.0, -0.1, 2.0},
                                         {0.4, 0.1, 2.2},  {0.8, 0.0, 2.0},  {1.2, 0.1, 2.0}};
  const double radius = 0.02;
  synthetic::Scene scene;
  scene.surfaces.push_back(synthetic::plane_surface(at({0, 0, 4}), 5.0, 5.0, plain(200.0)));
  scene.surfaces.push_back(synthetic::tube_surface(control, radius, 0.0, 1e-5));
  const auto view = render(scene, camera, camera_from_world, 8, 2);
  // The curve by repeated averaging of the control polygon (Lane-Riesenfeld), with points 0.1 mm apart.
  std::vector<Vector3d> curve = control;
  for (int level = 0; level < 12; ++level) {
    std::vector<Vector3d> finer;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i) {
      finer.push_back(0.5 * (curve[i] + curve[i + 1]));
      if (i + 2 < curve.size()) finer.push_back((curve[i] + 6.0 * curve[i + 1] + curve[i + 2]) / 8.0);
    }
    curve = finer;
  }
  for (Vector3d& point : curve) point = camera_from_world * point;
  const auto clearance = [&](double x, double y) {
    const Vector3d ray = camera.ray({x, y}).normalized();
    double nearest = 1e9;
    for (const Vector3d& point : curve) nearest = std::min(nearest, (point - ray.dot(point) * ray).squaredNorm());
    return std::sqrt(nearest) - radius;
  };
  for (int x = 12; x < 190; x += 25) {
    double inside = 0.0, least = 1e9;
    for (int y = 0; y < camera.height; ++y)
      if (const double c = clearance(x, y); c < least) least = c, inside = y;
    REQUIRE(least < 0.0);
    double height = 0.0;
    for (int sample = 0; sample < 3; ++sample) {  // mean over the pixel's width (Simpson)
      const double column = x + 0.5 * (sample - 1);
      const auto across = [&](double y) { return clearance(column, y); };
      height += (sample == 1 ? 4.0 : 1.0) / 6.0 *
                (bisect(inside, inside + 30.0, across) - bisect(inside - 30.0, inside, across));
    }
    double dark = 0.0;
    for (int y = 0; y < camera.height; ++y)
      dark += 1.0 - view.grey[static_cast<std::size_t>(y * camera.width + x)] / wall;
    CAPTURE(x, dark, height);
    CHECK(std::abs(dark - height) < 0.02);
  }
}

TEST_CASE("a texture on its plane agrees with analytic geometry", "[long][synthetic]") {
  synthetic::TextureStyle style;
  style.feature = 0.2;
  const auto texture = std::make_shared<synthetic::Texture>(synthetic::dead_leaves(style, 5), 1.0, 1.0, 0.002);
  const Isometry3d pose = at({0.05, 0.02, 1.5}, 0.4, -0.3, 0.2);
  synthetic::Scene scene;
  scene.surfaces.push_back(synthetic::plane_surface(pose, 1.0, 1.0, texture));
  const PinholeCamera camera{200.0, 200.0, 31.0, 21.5, 64, 44};
  const auto view = render(scene, camera, Isometry3d::Identity(), 4, 2);
  const Vector3d normal = pose.linear().col(2);
  double worst = 0.0, low = 255.0, high = 0.0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      double sum = 0.0;  // over a much finer regular grid
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) {
          const Vector3d ray = camera.ray(Vector2d(x + (i + 0.5) / 24 - 0.5, y + (j + 0.5) / 24 - 0.5));
          const Vector3d position = pose.inverse() * Vector3d(ray * (normal.dot(pose.translation()) / normal.dot(ray)));
          sum += texture->sample(position.x(), position.y());
        }
      const double grey = view.grey[static_cast<std::size_t>(y * camera.width + x)];
      worst = std::max(worst, std::abs(grey - shaded(sum / 576.0, -normal)));
      low = std::min(low, grey);
      high = std::max(high, grey);
    }
  CAPTURE(worst);
  CHECK(worst < 4.0);  // 16 rays against 576 on reflectance steps of up to 200 levels
  CHECK(high - low > 80.0);
}

TEST_CASE("a texture has no seams between its tiles and never repeats", "[synthetic]") {
  synthetic::TextureStyle style;
  style.feature = 0.3;
  style.alignment = 0.5;
  const double texel = 0.004, half = 0.8;
  const synthetic::Texture texture(synthetic::dead_leaves(style, 11), half, half, texel);
  double jump = 0.0;
  for (int tile = 1; tile < 6; ++tile) {
    const double seam = 64 * tile * texel - half;
    for (int i = 0; i < 2000; ++i) {
      const double along = (2.0 * i / 2000 - 1.0) * half;
      jump = std::max({jump, std::abs(texture.sample(seam - 1e-9, along) - texture.sample(seam + 1e-9, along)),
                       std::abs(texture.sample(along, seam - 1e-9) - texture.sample(along, seam + 1e-9))});
    }
  }
  CHECK(jump < 0.01);
  // A patch of 0.4 x 0.4 m has a low correlation with all others nearby.
  const auto patch = [&](double u, double v) {
    Eigen::ArrayXd greys(400);
    for (int i = 0; i < 400; ++i) greys[i] = texture.sample(u + i % 20 * 0.02, v + i / 20 * 0.02);
    greys -= greys.mean();
    return Eigen::ArrayXd(greys / std::sqrt(greys.square().sum()));
  };
  const Eigen::ArrayXd here = patch(-0.75, -0.75);
  double highest = 0.0;
  for (double v = -0.75; v < 0.35; v += 0.02)
    for (double u = -0.35; u < 0.35; u += 0.02) highest = std::max(highest, (here * patch(u, v)).sum());
  CHECK(highest < 0.6);
  CHECK((here * patch(-0.745, -0.755)).sum() > 0.75);  // and the check would detect a copy half a step off
}

TEST_CASE("cladding repeats with its pitch, and a texture's coarser levels are means", "[synthetic]") {
  synthetic::CladdingStyle style;
  style.unit_width = 0.24;
  style.unit_height = 0.08;
  style.joint = 0.012;
  style.bond = 0.5;
  style.spread = 0.0;
  style.noise = 0.0;
  style.joint_grey = 200.0;
  const double texel = 0.002, half = 1.0;
  const synthetic::Texture texture(synthetic::cladding(style, 3), half, half, texel, 7);
  // A brick's centre, the joints beside and below it, and the next course, half a brick farther.
  CHECK(texture.sample(0.12, 0.04) == Approx(130.0).margin(0.01));
  CHECK(texture.sample(0.24, 0.04) == Approx(200.0).margin(0.01));
  CHECK(texture.sample(0.12, 0.08) == Approx(200.0).margin(0.01));
  CHECK(texture.sample(0.12, 0.12) == Approx(200.0).margin(0.01));
  for (double u = -0.7; u < 0.5; u += 0.0137)
    CHECK(texture.sample(u, 0.03) == Approx(texture.sample(u + style.unit_width, 0.03)).margin(1e-3));
  double mean = 0.0, worst = 0.0;
  for (int i = 0; i < 120; ++i)
    for (int j = 0; j < 80; ++j) mean += texture.sample(-0.24 + 0.004 * (i + 0.5), -0.16 + 0.004 * (j + 0.5)) / 9600.0;
  const double joints = 1.0 - (0.228 / 0.24) * (0.068 / 0.08);
  CHECK(mean == Approx(130.0 + 70.0 * joints).margin(0.5));
  for (double u = -0.6; u < 0.6; u += 0.05)
    worst = std::max(worst, std::abs(texture.sample(u, 0.3 * u, 64 * texel) - mean));
  CAPTURE(worst);
  CHECK(worst < 4.0);  // texels of 13 cm, means over 19 cm: hardly any brick pattern remains
  for (const double footprint : {texel, 1.5 * texel, 4.0 * texel, 6.0 * texel})
    CHECK(texture.sample(0.12, 0.04, footprint) == Approx(130.0).margin(0.01));  // one grey level inside a brick
}
