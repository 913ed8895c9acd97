#include "common/matching_constants.hpp"
#include "device/stereo_matching.hpp"
#include "matching.hpp"
#include "reference/stereo_matching.hpp"

using namespace quadedge;
using namespace matching;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

Vector2d in_right(const StereoRig& rig, const Vector2d& pixel, double depth) {
  return rig.right.project(rig.right_from_left * Vector3d(depth * rig.left.ray(pixel)));
}

Vector2d at_infinity(const StereoRig& rig, const Vector2d& pixel) {
  return rig.right.project(rig.right_from_left.linear() * rig.left.ray(pixel));
}

/// Sine of the angle between a tangent and the left epipolar line: the image of the right ray through the counterpart,
/// in double precision.
double epipolar_sine(const StereoRig& rig, const Vector2d& pixel, double direction) {
  const Vector3d t = rig.right_from_left.linear().transpose() * rig.right_from_left.translation();
  const Vector3d normal =
      rig.left.matrix().inverse().transpose() * t.cross(rig.left.ray(pixel));  // the line's coefficients
  const Vector2d along = Vector2d(-normal.y(), normal.x()).normalized();
  return std::abs(std::cos(direction) * along.y() - std::sin(direction) * along.x());
}

/// At a right point.
double across(const RectificationError& error, const Vector2d& q, const PinholeCamera& right) {
  return error.at(q.x() / right.width - 0.5, q.y() / right.height - 0.5);
}

/// Filters 1 to 3 of doc/method.md section 3 by definition, in double precision. Positive: distance inside the limits
/// in units of single-precision error (2e-3 px, 1e-5 rad).
/// \param error of a rectified rig, without bend_xx, so that the lines stay straight
double margin(const StereoRig& rig, const StereoConfig& config, const DisparityProbe& probe,
              const RectificationError& error, const EdgeSet& left, std::size_t i, const EdgeSet& right,
              std::size_t j) {
  constexpr double kPixels = 2e-3, kRadians = 1e-5, kTolerance = 1.0;
  const Vector2d p(left.x[i], left.y[i]);
  if ((rig.right_from_left.linear() * rig.left.ray(p)).z() <= 0) return -1e9;
  const Vector2d far = at_infinity(rig, p), seen(right.x[j], right.y[j]);
  const Vector2d q = seen - Vector2d(-error.slope_x / rig.right.width * (far.y() - rig.right.cy),
                                     across(error, {seen.x(), far.y()}, rig.right));
  const Vector3d t = rig.right_from_left.translation();
  Eigen::Matrix3d cross;
  cross << 0, -t.z(), t.y(), t.z(), 0, -t.x(), -t.y(), t.x(), 0;
  const Vector3d line =
      rig.right.matrix().inverse().transpose() * cross * rig.right_from_left.linear() * rig.left.ray(p);
  const double distance = std::abs(line.dot(Vector3d(q.x(), q.y(), 1))) / line.head<2>().norm();
  const Vector2d growing = (in_right(rig, p, 1e2) - far).normalized();
  const double rise = (error.slope_x + error.bend_xy * (far.y() / rig.right.height - 0.5)) / rig.right.width;
  const double s = (q - far).dot(growing) - rise * (q.y() - far.y());
  double s_max = config.max_disparity > 0 ? config.max_disparity : (in_right(rig, p, config.min_depth) - far).norm();
  if (probe.step > 0 && i % static_cast<std::size_t>(probe.step) == 0)
    s_max = std::max(s_max, static_cast<double>(probe.max_disparity));
  const double turn = std::abs(
      std::remainder(static_cast<double>(left.direction[i]) - static_cast<double>(right.direction[j]), 2 * kPi));
  return std::min({(config.epipolar_distance - distance) / kPixels, (s + kTolerance) / kPixels,
                   (s_max + kTolerance - s) / kPixels, (config.orientation_rad() - turn) / kRadians,
                   (epipolar_sine(rig, p, left.direction[i]) - std::sin(kMinEpipolarAngle)) / kRadians});
}

/// Counts the certain members; checks that every list is ascending, holds all certain members and no certain outsider.
std::size_t check_lists(const std::vector<std::int32_t>& first, const std::vector<std::int32_t>& target,
                        const StereoRig& rig, const StereoConfig& config, const DisparityProbe& probe,
                        const RectificationError& error, const EdgeSet& left, const EdgeSet& right) {
  REQUIRE(first.size() == left.size() + 1);
  REQUIRE(first.back() == static_cast<int>(target.size()));
  std::size_t certain = 0, missing = 0, extra = 0, disordered = 0;
  for (std::size_t i = 0; i < left.size(); ++i) {
    const auto begin = target.begin() + first[i], end = target.begin() + first[i + 1];
    disordered += std::adjacent_find(begin, end, [](auto a, auto b) { return a >= b; }) != end ? 1 : 0;
    for (std::size_t j = 0; j < right.size(); ++j) {
      const bool listed = std::binary_search(begin, end, static_cast<std::int32_t>(j));
      const double inside = margin(rig, config, probe, error, left, i, right, j);
      certain += inside > 1 ? 1 : 0;
      missing += inside > 1 && !listed ? 1 : 0;
      extra += inside < -1 && listed ? 1 : 0;
    }
  }
  CHECK(missing == 0);
  CHECK(extra == 0);
  CHECK(disordered == 0);
  return certain;
}

/// Compares the reference and every device and variant with the definition.
std::size_t check_everywhere(const StereoRig& rig, const StereoConfig& config, const EdgeSet& left,
                             const EdgeSet& right, const DisparityProbe& probe = {0, 0},
                             const RectificationError& error = {}) {
  const auto geometry = corrected(make_epipolar_geometry(rig, config), error, rig);
  const auto lists = reference::stereo_candidates(left, right, geometry, probe);
  const std::size_t certain = check_lists(lists.first, lists.target, rig, config, probe, error, left, right);
  check_stage("stereo_candidates", [&](opencl::Context& context, const Variants& variants) -> StageArrays {
    stages::StereoCandidates stage(context, variants);
    const auto device_left = upload(context, left), device_right = upload(context, right);
    stages::DeviceCandidates found;
    stage.run(device_left, device_right, rig.right.height, geometry, probe, found);
    const auto lists_found = found.read();
    check_lists(lists_found.first, lists_found.target, rig, config, probe, error, left, right);
    std::vector<cl_int> listed(right.size());
    for (const auto j : lists_found.target) listed[static_cast<std::size_t>(j)] = 1;
    if (left.size() == 0) listed.clear();
    return {{"first", lists_found.first},
            {"target", lists_found.target},
            {"listed", stage.listed().read(listed.size()), listed}};
  });
  return certain;
}

/// Left edges anywhere; half of the right edges near a counterpart of one, the other half anywhere.
std::pair<EdgeSet, EdgeSet> random_scene(const StereoRig& rig, int count, double min_depth, std::uint64_t seed) {
  Random random(seed);
  std::vector<Edge> left, right;
  for (int k = 0; k < count; ++k) {
    left.push_back({random(1, rig.left.width - 2), random(1, rig.left.height - 2), random(-kPi, kPi)});
    const Vector2d q = in_right(rig, {left.back().x, left.back().y}, min_depth / random(0.0, 1.1));
    right.push_back({q.x() + random(-0.8, 0.8), q.y() + random(-0.8, 0.8),
                     std::remainder(left.back().direction + random(-0.25, 0.25) + (k % 3 == 0 ? kPi : 0), 2 * kPi)});
    right.push_back({random(1, rig.right.width - 2), random(1, rig.right.height - 2), random(-kPi, kPi)});
  }
  const auto outside = [&](const Edge& e) {
    return e.x < 0.5 || e.y < 0.5 || e.x > rig.right.width - 1.5 || e.y > rig.right.height - 1.5;
  };
  right.erase(std::remove_if(right.begin(), right.end(), outside), right.end());
  return {make_edges(left, rig.left.height, 0.35, seed + 1), make_edges(right, rig.right.height, 0.35, seed + 2)};
}

}  // namespace

TEST_CASE("epipolar line: corrected by a rectification error it is that of a displaced and rolled right camera") {
  constexpr double kRoll = 2e-3;  // rad
  StereoConfig config;
  config.max_disparity = 40;
  StereoRig vertical = flat_rig(640, 480, 500, 0.2);
  vertical.right_from_left.translation() = Vector3d(0, -0.2, 0);
  for (const auto& [rig, margin] :
       {std::pair(flat_rig(640, 480, 500, 0.2), 1e-3), std::pair(vertical, 1e-3), std::pair(crooked_rig(), 0.1)}) {
    const auto geometry = make_epipolar_geometry(rig, config);
    const EpipolarLine middle =
        epipolar_line(geometry, static_cast<float>(rig.left.cx), static_cast<float>(rig.left.cy));
    const Vector2d normal(middle.ey, -middle.ex);
    StereoRig moved = rig;
    moved.right.cx += 0.8 * normal.x();
    moved.right.cy += 0.8 * normal.y();
    moved.right_from_left = Eigen::AngleAxisd(kRoll, Vector3d::UnitZ()) * rig.right_from_left;
    RectificationError error{0.8, kRoll * rig.right.width * normal.y(), -kRoll * rig.right.height * normal.x()};
    error.offset += error.slope_x * (0.5 - rig.right.cx / rig.right.width) +
                    error.slope_y * (0.5 - rig.right.cy / rig.right.height);
    const auto wanted = make_epipolar_geometry(moved, config), found = corrected(geometry, error, rig);
    Random random(3);
    for (int k = 0; k < 200; ++k) {
      const auto x = static_cast<float>(random(0, rig.left.width)), y = static_cast<float>(random(0, rig.left.height));
      const EpipolarLine there = epipolar_line(wanted, x, y), line = epipolar_line(found, x, y);
      REQUIRE(line.valid);
      CHECK(line.x == Approx(there.x).margin(margin));
      CHECK(line.y == Approx(there.y).margin(margin));
      CHECK(line.ex * there.ey - line.ey * there.ex == Approx(0).margin(1.1 * kRoll));
    }
    const auto same = corrected(geometry, {}, rig);
    CHECK(std::equal(std::begin(same.h), std::end(same.h), std::begin(geometry.h)));
  }
}

TEST_CASE("epipolar line: an error of the second degree moves it to where the points of the line lie") {
  StereoConfig config;
  config.max_disparity = 40;
  // Without a roll, so that nothing moves along the lines.
  const RectificationError error{0.4, 0, 0, 0.6, 5, -0.8};
  StereoRig vertical = flat_rig(640, 480, 500, 0.2);
  vertical.right_from_left.translation() = Vector3d(0, -0.2, 0);
  for (const auto& rig : {flat_rig(640, 480, 500, 0.2), vertical, crooked_rig()}) {
    const auto geometry = make_epipolar_geometry(rig, config), found = corrected(geometry, error, rig);
    Random random(5);
    for (int k = 0; k < 200; ++k) {
      const auto x = static_cast<float>(random(0, rig.left.width)), y = static_cast<float>(random(0, rig.left.height));
      const EpipolarLine of_calibration = epipolar_line(geometry, x, y), line = epipolar_line(found, x, y);
      const double s = random(0, 40);
      const Vector2d direction(of_calibration.ex, of_calibration.ey), normal(direction.y(), -direction.x()),
          q = Vector2d(of_calibration.x, of_calibration.y) + s * direction,
          seen = q + across(error, q, rig.right) * normal;
      const Vector2d from = seen - Vector2d(line.x, line.y);
      // The points lie on a curve, the line is its tangent at infinite depth.
      const double u = s * direction.x() / rig.right.width, v = s * direction.y() / rig.right.height;
      const double sag = error.bend_xx * u * u + error.bend_xy * u * v + error.bend_yy * v * v;
      CHECK(from.x() * line.ey - from.y() * line.ex == Approx(sag).margin(0.01));
      CHECK(from.dot(Vector2d(line.ex, line.ey)) == Approx(s).margin(0.05));
    }
  }
}

TEST_CASE("epipolar geometry: refuses an unlimited search") {
  CHECK_THROWS_AS(make_epipolar_geometry(flat_rig(), StereoConfig{}), UsageError);
}

TEST_CASE("stereo candidates: the lists match the definition", "[device]") {
  StereoConfig config;
  config.min_depth = 0.7;
  for (const auto& rig : {flat_rig(131, 77, 120, 0.12), crooked_rig()}) {
    const auto [left, right] = random_scene(rig, 400, config.min_depth, 17);
    CHECK(check_everywhere(rig, config, left, right) > 80);
  }
  config.max_disparity = 7;  // takes precedence over min_depth
  config.epipolar_distance = 3;
  config.orientation = 60;
  const auto [left, right] = random_scene(crooked_rig(), 400, 0.7, 23);
  CHECK(check_everywhere(crooked_rig(), config, left, right) > 200);
}

TEST_CASE("stereo candidates: probes search farther than the other edges", "[device]") {
  StereoConfig config;
  config.max_disparity = 5;
  for (const auto& rig : {flat_rig(131, 77, 120, 0.12), crooked_rig()}) {
    const auto [left, right] = random_scene(rig, 400, 0.7, 31);
    const std::size_t without = check_everywhere(rig, config, left, right),
                      with = check_everywhere(rig, config, left, right, {3, 25}),
                      all = check_everywhere(rig, config, left, right, {1, 25});
    CHECK(with > without);
    CHECK(all > with);
  }
}

TEST_CASE("stereo candidates: with a rectification error they lie around the corrected line", "[device]") {
  StereoConfig config;
  config.min_depth = 0.7;
  const StereoRig rig = flat_rig(131, 77, 120, 0.12);
  const auto [left, right] = random_scene(rig, 400, config.min_depth, 17);
  CHECK(check_everywhere(rig, config, left, right, {0, 0}, {0.9, 0.6, -0.4, 0, 2, -1}) > 60);
}

TEST_CASE("stereo candidates: small and empty lists, and lines outside the image", "[device][oclgrind]") {
  StereoConfig config;
  config.min_depth = 0.7;
  const StereoRig rig = crooked_rig();
  const EdgeSet none_left = make_edges({}, rig.left.height), none_right = make_edges({}, rig.right.height);
  const auto [left, right] = random_scene(rig, 20, config.min_depth, 29);
  check_everywhere(rig, config, left, right);
  CHECK(check_everywhere(rig, config, none_left, right) == 0);
  CHECK(check_everywhere(rig, config, left, none_right) == 0);
  CHECK(check_everywhere(rig, config, none_left, none_right) == 0);
  for (const double angle : {1.0, 3.1}) {  // the right camera points sideways, then away
    StereoRig aside = rig;
    aside.right_from_left.linear() = Eigen::AngleAxisd(angle, Vector3d::UnitX()).toRotationMatrix();
    check_everywhere(aside, config, left, right);
  }
}

TEST_CASE("stereo candidates: lists longer than the initial capacity are complete", "[device]") {
  const StereoRig rig = flat_rig(161, 21, 100, 0.1);
  StereoConfig config;
  config.max_disparity = 200;
  std::vector<Edge> left, right;
  for (int k = 0; k < 37; ++k) left.push_back({115 + 0.5 * k, 10, 1.5});
  for (int k = 0; k < 205; ++k) right.push_back({5 + 0.5 * k, 10, 1.5});
  CHECK(check_everywhere(rig, config, make_edges(left, 21), make_edges(right, 21)) == 37 * 205);
}
