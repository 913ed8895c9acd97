// The built-in renderer: exactness of poses, depth and sub-pixel positions.
#include <catch2/catch.hpp>
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "data/synthetic_path.hpp"
#include "data/synthetic_render.hpp"
#include "quadedge/error.hpp"
#include "quadedge/synthetic.hpp"

using namespace quadedge;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

SyntheticOptions small_options(const char* scene) {
  SyntheticOptions options;
  options.scene = scene;
  options.frames = 8;
  options.width = 157;
  options.height = 83;
  options.focal = 90.0;
  options.supersampling = 2;
  return options;
}

float depth_at(const RenderedView& view, int x, int y) {
  return view.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.image.width) + static_cast<std::size_t>(x)];
}

/// Bilinear depth, or nothing where the four neighbours do not belong to one smooth surface or lie outside.
double smooth_depth(const RenderedView& view, const Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (x < 0 || y < 0 || x + 1 >= view.image.width || y + 1 >= view.image.height) return 0.0;
  const double a = depth_at(view, x, y), b = depth_at(view, x + 1, y), c = depth_at(view, x, y + 1), d = depth_at(view, x + 1, y + 1);
  if (std::max({a, b, c, d}) - std::min({a, b, c, d}) > 0.04 * a) return 0.0;
  const double fx = p.x() - x, fy = p.y() - y;
  const double inverse = (1 - fy) * ((1 - fx) / a + fx / b) + fy * ((1 - fx) / c + fx / d);  // 1 / z is linear on a plane
  return 1.0 / inverse;
}

struct Agreement {
  int visible = 0;     // pixels that land inside the other view and on a smooth part of it
  int agreeing = 0;    // ... on the same surface
  int hidden = 0;      // ... behind something nearer
  int impossible = 0;  // ... in front of what the other view sees
};

/// Carries every pixel of one view with its depth into the other view.
Agreement compare(const RenderedView& from, const RenderedView& to, const PinholeCamera& camera, const Isometry3d& to_from_from) {
  Agreement result;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vector3d point = to_from_from * Vector3d(depth_at(from, x, y) * camera.ray(Vector2d(x, y)));
      const double seen = smooth_depth(to, camera.project(point));
      if (seen == 0.0) continue;
      ++result.visible;
      const double difference = point.z() / seen - 1.0;
      if (std::abs(difference) < 0.004) ++result.agreeing;
      else if (difference > 0.0) ++result.hidden;
      else ++result.impossible;
    }
  }
  return result;
}

/// Row of the only edge in a column between a surface of grey `above` and one of grey `below`: the column's integral, which
/// is exact for pixels that are means over their squares.
double edge_row(const synthetic::Radiance& view, const PinholeCamera& camera, int x, double above, double below) {
  double sum = 0.0;
  for (int y = 0; y < camera.height; ++y) sum += view.grey[static_cast<std::size_t>(y * camera.width + x)];
  return camera.height - 0.5 - (sum - above * camera.height) / (below - above);
}

/// Largest and mean error [px] of the rendered edge over the columns. `true_row`: from geometry.
std::pair<double, double> edge_error(const synthetic::Radiance& view, const PinholeCamera& camera, int first, int last, double above,
                                     double below, const std::function<double(double)>& true_row) {
  double largest = 0.0, sum = 0.0;
  for (int x = first; x < last; ++x) {
    const double error = edge_row(view, camera, x, above, below) - true_row(x);
    largest = std::max(largest, std::abs(error));
    sum += error;
  }
  return {largest, sum / (last - first)};
}

/// Root of a function that changes its sign between low and high.
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
  return std::make_shared<synthetic::Texture>(style, 1, 5.0, 5.0, 0.1);
}

Isometry3d at(const Vector3d& place, double yaw = 0.0, double pitch = 0.0, double roll = 0.0) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = place;
  pose.linear() = (Eigen::AngleAxisd(yaw, Vector3d::UnitY()) * Eigen::AngleAxisd(pitch, Vector3d::UnitX()) *
                   Eigen::AngleAxisd(roll, Vector3d::UnitZ())).toRotationMatrix();
  return pose;
}

/// Grey of a plain surface that faces against `towards` under the scenes' light.
double shaded(double grey, const Vector3d& normal) { return grey * synthetic::shade(normal, synthetic::light_direction(), 0.72); }

/// Shift [px] of `to` against `from` carried over with its exact depth, by least squares over smooth places (one
/// Lucas-Kanade step), and the median absolute grey difference there.
struct Photometry {
  Vector2d shift = Vector2d::Zero();
  double median_difference = 0.0;
};
Photometry photometry(const RenderedView& from, const RenderedView& to, const PinholeCamera& camera, const Isometry3d& to_from_from,
                      const Vector2d& bias = Vector2d::Zero()) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Vector2d side = Vector2d::Zero();
  std::vector<double> differences;
  const auto grey = [&](const Vector2d& p) {
    const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
    const double fx = p.x() - x, fy = p.y() - y;
    const ImageView v = to.image.view();
    return (1 - fy) * ((1 - fx) * v.at(x, y) + fx * v.at(x + 1, y)) + fy * ((1 - fx) * v.at(x, y + 1) + fx * v.at(x + 1, y + 1));
  };
  const auto is_smooth = [](const RenderedView& view, const Vector2d& p) {  // no step of depth within two pixels
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx)
        if (smooth_depth(view, p + Vector2d(dx, dy)) == 0.0) return false;
    return true;
  };
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vector3d point = to_from_from * Vector3d(depth_at(from, x, y) * camera.ray(Vector2d(x, y)));
      const Vector2d p = camera.project(point) + bias;
      if (!is_smooth(from, Vector2d(x, y)) || !is_smooth(to, p)) continue;
      if (std::abs(point.z() / smooth_depth(to, p) - 1.0) > 0.02) continue;
      const Vector2d slope(0.5 * (grey(p + Vector2d::UnitX()) - grey(p - Vector2d::UnitX())),
                           0.5 * (grey(p + Vector2d::UnitY()) - grey(p - Vector2d::UnitY())));
      const double difference = from.image.view().at(x, y) - grey(p);
      normal += slope * slope.transpose();
      side += slope * difference;
      differences.push_back(std::abs(difference));
    }
  }
  Photometry result;
  result.shift = normal.ldlt().solve(side);
  std::nth_element(differences.begin(), differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2), differences.end());
  result.median_difference = differences[differences.size() / 2];
  return result;
}

}  // namespace

TEST_CASE("a synthetic sequence gives the same bytes again, on any number of threads", "[synthetic]") {
  for (const char* scene : {"room", "cables"}) {
    SyntheticOptions options = small_options(scene);
    options.threads = 1;
    const RenderedView one = SyntheticSequence(options).render(3, true);
    options.threads = 5;
    const SyntheticSequence again(options);
    again.render(0, false);  // paints texture tiles in another order
    const RenderedView five = again.render(3, true);
    CHECK(one.image.pixels == five.image.pixels);
    CHECK(one.depth == five.depth);
    options.seed = 8;
    CHECK(one.image.pixels != SyntheticSequence(options).render(3, true).image.pixels);
  }
}

TEST_CASE("the synthetic camera starts at the identity and moves smoothly", "[synthetic]") {
  SyntheticOptions options = small_options("room");
  options.frames = 1500;
  const SyntheticSequence sequence(options);
  CHECK(sequence.frames() == 1500);
  CHECK(sequence.stamp_ns(0) == 0);
  CHECK(sequence.stamp_ns(1499) == 74'950'000'000);
  CHECK(sequence.world_from_left(0).matrix() == Eigen::Matrix4d::Identity());

  Vector3d last_step = Vector3d::Zero();
  Vector3d sway = Vector3d::Zero(), travel = Vector3d::Zero();
  for (int frame = 1; frame < options.frames; ++frame) {
    const Isometry3d before = sequence.world_from_left(frame - 1), now = sequence.world_from_left(frame);
    const Isometry3d step = before.inverse() * now;
    const Eigen::AngleAxisd turn(step.linear());
    REQUIRE((now.linear().transpose() * now.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    REQUIRE(step.translation().norm() >= 0.01);
    REQUIRE(step.translation().norm() <= 0.04);
    REQUIRE(turn.angle() <= 1.0 * M_PI / 180.0);
    const Vector3d moved = now.translation() - before.translation();
    if (frame > 1) REQUIRE((moved - last_step).norm() < 0.003);
    last_step = moved;
    REQUIRE(now.translation().norm() < 0.8);
    sway = sway.cwiseMax((turn.angle() * turn.axis()).cwiseAbs());
    travel = travel.cwiseMax(now.translation().cwiseAbs());
  }
  CHECK(sway.minCoeff() > 0.1 * M_PI / 180.0);  // all six degrees of freedom
  CHECK(travel.minCoeff() > 0.05);
}

TEST_CASE("the synthetic rig is rectified with the asked baseline and focal length", "[synthetic]") {
  const SyntheticOptions options;
  const StereoRig rig = SyntheticSequence(options).rig();
  CHECK(rig.left.width == 942);
  CHECK(rig.left.height == 489);
  CHECK(rig.left.fx == 541.764);
  CHECK(rig.left.fy == 541.764);
  CHECK(std::abs(rig.left.cx - 470.5) < 20.0);
  CHECK(rig.left.cx != 470.5);
  CHECK(rig.left.cy != 244.0);
  CHECK(rig.right.matrix() == rig.left.matrix());
  CHECK(rig.right_from_left.linear() == Eigen::Matrix3d::Identity());
  CHECK(rig.right_from_left.translation() == Vector3d(-0.0598913, 0.0, 0.0));
}

TEST_CASE("synthetic depth agrees between the views wherever it is visible in both", "[synthetic]") {
  const SyntheticSequence sequence(small_options("room"));
  const PinholeCamera& camera = sequence.rig().left;
  const RenderedView left = sequence.render(0, false), right = sequence.render(0, true), later = sequence.render(6, false);
  for (const auto& [view, pose] : {std::pair(&right, sequence.rig().right_from_left),
                                   std::pair(&later, sequence.world_from_left(6).inverse())}) {
    const Agreement result = compare(left, *view, camera, pose);
    CAPTURE(result.visible, result.agreeing, result.hidden, result.impossible);
    CHECK(result.visible > 0.75 * camera.width * camera.height);
    CHECK(result.agreeing > 0.93 * result.visible);
    CHECK(result.impossible < 0.01 * result.visible);  // creases between two planes, where depth is interpolated
  }
}

TEST_CASE("synthetic depth obeys disparity = f b / Z and occludes", "[synthetic]") {
  const SyntheticSequence sequence(small_options("room"));
  const StereoRig& rig = sequence.rig();
  const RenderedView left = sequence.render(0, false);
  int steps = 0;
  for (int y = 0; y < rig.left.height; ++y)
    for (int x = 0; x + 1 < rig.left.width; ++x) steps += std::abs(depth_at(left, x + 1, y) / depth_at(left, x, y) - 1.0) > 0.2;
  CHECK(steps > rig.left.height);  // objects stand in front of one another
  // The right view shows the same grey f b / Z further left, to a small part of a pixel.
  SyntheticOptions clean = small_options("room");
  clean.noise = 0.0;
  clean.supersampling = 4;
  clean.width = 314;
  clean.height = 166;
  clean.focal = 180.0;
  const SyntheticSequence quiet(clean);
  const PinholeCamera& camera = quiet.rig().left;
  const RenderedView a = quiet.render(0, false), b = quiet.render(0, true), c = quiet.render(2, false);
  const Isometry3d next = quiet.world_from_left(2).inverse();
  CHECK(photometry(a, b, camera, quiet.rig().right_from_left).shift.norm() < 0.02);
  CHECK(photometry(a, c, camera, next).shift.norm() < 0.02);
  const double aligned = photometry(a, b, camera, quiet.rig().right_from_left).median_difference;
  const double displaced = photometry(a, b, camera, quiet.rig().right_from_left, {1.0, 0.0}).median_difference;
  CAPTURE(aligned, displaced);
  CHECK(aligned < 0.5 * displaced);
}

TEST_CASE("nothing in view is nearer than the synthetic sequence's largest disparity says", "[synthetic]") {
  for (const char* scene : {"room", "cables"}) {
    SyntheticOptions options = small_options(scene);
    options.frames = 1000;
    options.supersampling = 1;
    const SyntheticSequence sequence(options);
    double largest = 0.0;
    for (int frame = 0; frame < options.frames; frame += 29)
      for (float depth : sequence.render(frame, frame % 2 == 1).depth) {
        REQUIRE(depth > 0.0f);
        largest = std::max(largest, options.focal * options.baseline / depth);
      }
    CAPTURE(scene, largest);
    CHECK(largest <= sequence.max_disparity());
    CHECK(largest > 0.6 * (sequence.max_disparity() - 1.0));
  }
}

TEST_CASE("rendered silhouettes lie where geometry says", "[synthetic]") {
  const PinholeCamera camera{400.0, 400.0, 101.3, 58.7, 200, 120};
  const Isometry3d camera_from_world = at({0.02, -0.03, 0.05}, 0.02, -0.03, 0.015);
  const auto scene_with = [&](std::unique_ptr<synthetic::Surface> front) {
    synthetic::Scene scene;
    scene.surfaces.push_back(std::make_unique<synthetic::PlaneSurface>(at({0, 0, 4}), 5.0, 5.0, plain(200.0)));
    scene.surfaces.push_back(std::move(front));
    return scene;
  };
  const double wall = shaded(200.0, -Vector3d::UnitZ());

  SECTION("a tilted plane") {
    const Isometry3d pose = at({0.0, 0.3, 2.0}, 0.5, 0.2, 0.06);
    const auto view = render(scene_with(std::make_unique<synthetic::PlaneSurface>(pose, 1.0, 0.3, plain(60.0))), camera,
                             camera_from_world, 8, 2);
    const Vector2d a = camera.project(camera_from_world * pose * Vector3d(-1.0, -0.3, 0.0));
    const Vector2d b = camera.project(camera_from_world * pose * Vector3d(1.0, -0.3, 0.0));
    const auto [largest, mean] = edge_error(view, camera, 0, 200, wall, shaded(60.0, -pose.linear().col(2)), [&](double x) {
      return a.y() + (b.y() - a.y()) * (x - a.x()) / (b.x() - a.x());
    });
    CHECK(largest < 0.02);
    CHECK(std::abs(mean) < 0.002);
  }
  SECTION("a curved tube") {
    const std::vector<Vector3d> control = {{-1.2, 0.1, 2.1}, {-0.8, 0.0, 2.0}, {-0.4, 0.15, 1.9}, {0.0, -0.1, 2.0},
                                           {0.4, 0.1, 2.2},  {0.8, 0.0, 2.0},  {1.2, 0.1, 2.0}};
    const double radius = 0.02;
    synthetic::Scene scene;  // black below the upper silhouette, nothing (0) must be told from the wall: both edges are summed
    scene.surfaces.push_back(std::make_unique<synthetic::PlaneSurface>(at({0, 0, 4}), 5.0, 5.0, plain(200.0)));
    scene.surfaces.push_back(std::make_unique<synthetic::TubeSurface>(control, radius, 0.0, 1e-5));
    const auto view = render(scene, camera, camera_from_world, 8, 2);
    // The curve by repeated averaging of the control polygon (Lane-Riesenfeld), so finely that its points are 0.1 mm apart.
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
        height += (sample == 1 ? 4.0 : 1.0) / 6.0 * (bisect(inside, inside + 30.0, across) - bisect(inside - 30.0, inside, across));
      }
      double dark = 0.0;
      for (int y = 0; y < camera.height; ++y) dark += 1.0 - view.grey[static_cast<std::size_t>(y * camera.width + x)] / wall;
      CAPTURE(x, dark, height);
      CHECK(std::abs(dark - height) < 0.02);
    }
  }
  SECTION("a ball") {
    const Vector3d centre(0.1, 0.05, 2.0);
    const double radius = 0.15;
    const auto view = render(scene_with(std::make_unique<synthetic::SphereSurface>(at(centre, 0.3), radius, plain(60.0))), camera,
                             camera_from_world, 8, 2);
    const Vector3d seen = camera_from_world * centre;
    int pixels = 0, wrong = 0;
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x, ++pixels) {
        const double angle = std::acos(camera.ray(Vector2d(x, y)).normalized().dot(seen.normalized()));
        const double margin = (std::asin(radius / seen.norm()) - angle) * camera.fx;  // px inside the outline
        const double depth = view.depth[static_cast<std::size_t>(y * camera.width + x)];
        if (std::abs(margin) > 0.001) wrong += (margin > 0.0) != (depth < 3.0);
      }
    CHECK(wrong == 0);
    // The front of the ball is exactly one radius nearer than its centre.
    const Vector2d middle = camera.project(seen);
    const PinholeCamera centred{400.0, 400.0, camera.cx - middle.x() + 100.0, camera.cy - middle.y() + 60.0, 200, 120};
    const auto moved = render(scene_with(std::make_unique<synthetic::SphereSurface>(at(centre), radius, plain(60.0))), centred,
                              camera_from_world, 1, 1);
    CHECK(moved.depth[60 * 200 + 100] == Approx(seen.z() * (1.0 - radius / seen.norm())).epsilon(1e-6));
  }
}

TEST_CASE("a texture lies on its plane where geometry says", "[synthetic]") {
  synthetic::TextureStyle style;
  style.feature = 0.2;
  const auto texture = std::make_shared<synthetic::Texture>(style, 5, 1.0, 1.0, 0.002);
  const Isometry3d pose = at({0.05, 0.02, 1.5}, 0.4, -0.3, 0.2);
  synthetic::Scene scene;
  scene.surfaces.push_back(std::make_unique<synthetic::PlaneSurface>(pose, 1.0, 1.0, texture));
  const PinholeCamera camera{200.0, 200.0, 31.0, 21.5, 64, 44};
  const auto view = render(scene, camera, Isometry3d::Identity(), 4, 2);
  const Vector3d normal = pose.linear().col(2);
  double worst = 0.0, low = 255.0, high = 0.0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      double sum = 0.0;  // by a much finer plain grid
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) {
          const Vector3d ray = camera.ray(Vector2d(x + (i + 0.5) / 24 - 0.5, y + (j + 0.5) / 24 - 0.5));
          const Vector3d place = pose.inverse() * Vector3d(ray * (normal.dot(pose.translation()) / normal.dot(ray)));
          sum += texture->sample(place.x(), place.y());
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

TEST_CASE("synthetic camera noise has the asked standard deviation and is independent", "[synthetic]") {
  SyntheticOptions options = small_options("room");
  options.supersampling = 1;
  options.noise = 0.0;
  const SyntheticSequence clean(options);
  options.noise = 3.0;
  const SyntheticSequence noisy(options);
  const auto noise = [&](int frame, bool right) {
    const std::vector<std::uint8_t> a = noisy.render(frame, right).image.pixels, b = clean.render(frame, right).image.pixels;
    Eigen::VectorXd difference(static_cast<Eigen::Index>(a.size()));
    for (std::size_t i = 0; i < a.size(); ++i) difference[static_cast<Eigen::Index>(i)] = static_cast<double>(a[i]) - b[i];
    return difference;
  };
  const Eigen::VectorXd first = noise(0, false), right = noise(0, true), second = noise(1, false);
  const auto count = static_cast<double>(first.size());
  const double expected = std::sqrt(9.0 + 2.0 / 12.0);  // both images are rounded
  CHECK(std::sqrt(first.squaredNorm() / count) == Approx(expected).epsilon(0.025));
  CHECK(std::abs(first.mean()) < 0.1);
  for (const Eigen::VectorXd& other : {right, second, Eigen::VectorXd(first.tail(first.size() - 1))}) {
    const Eigen::Index n = std::min(first.size(), other.size());
    CHECK(std::abs(first.head(n).dot(other.head(n))) / count / (expected * expected) < 0.04);
  }
}

TEST_CASE("synthetic options that make no sense are refused", "[synthetic]") {
  const auto refuses = [](const std::function<void(SyntheticOptions&)>& change) {
    SyntheticOptions options = small_options("room");
    change(options);
    CHECK_THROWS_AS(SyntheticSequence(options), UsageError);
  };
  refuses([](SyntheticOptions& o) { o.scene = "kitchen"; });
  refuses([](SyntheticOptions& o) { o.frames = 0; });
  refuses([](SyntheticOptions& o) { o.width = 0; });
  refuses([](SyntheticOptions& o) { o.height = -3; });
  refuses([](SyntheticOptions& o) { o.focal = std::nan(""); });
  refuses([](SyntheticOptions& o) { o.baseline = 0.0; });
  refuses([](SyntheticOptions& o) { o.noise = -1.0; });
  refuses([](SyntheticOptions& o) { o.supersampling = 0; });
  refuses([](SyntheticOptions& o) { o.threads = -1; });
  const SyntheticSequence sequence(small_options("room"));
  CHECK_THROWS_AS(sequence.render(8, false), UsageError);
  CHECK_THROWS_AS(sequence.render(-1, false), UsageError);
}
