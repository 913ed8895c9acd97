// The built-in sequences: poses, depth, noise; that images show it, test_synthetic_geometry and test_edges.py hold.
#include "testing.hpp"

using namespace quadedge;
using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

SyntheticOptions small_options(const std::string& scene) {
  auto options = rendering(157, 83, 90, 8, 2);
  options.scene = scene;
  return options;
}

float depth_at(const RenderedView& view, int x, int y) {
  return view
      .depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.image.width) + static_cast<std::size_t>(x)];
}

/// Bilinear depth; none where the four neighbours lie outside or do not belong to one smooth surface.
double smooth_depth(const RenderedView& view, const Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (x < 0 || y < 0 || x + 1 >= view.image.width || y + 1 >= view.image.height) return 0.0;
  const double a = depth_at(view, x, y), b = depth_at(view, x + 1, y);
  const double c = depth_at(view, x, y + 1), d = depth_at(view, x + 1, y + 1);
  if (std::max({a, b, c, d}) - std::min({a, b, c, d}) > 0.04 * a) return 0.0;
  const double fx = p.x() - x, fy = p.y() - y;
  const double inverse =
      (1 - fy) * ((1 - fx) / a + fx / b) + fy * ((1 - fx) / c + fx / d);  // 1 / z is linear on a plane
  return 1.0 / inverse;
}

/// Whether 1 / depth is linear, as on a plane, over the 4 x 4 pixels around a position. Frames and slats protrude so
/// little from their walls that a difference in depth alone does not reveal them.
bool is_on_one_plane(const RenderedView& view, const Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x())), y = static_cast<int>(std::floor(p.y()));
  if (x < 1 || y < 1 || x + 2 >= view.image.width || y + 2 >= view.image.height) return false;
  const auto is_linear = [&](int column, int row, int dx, int dy) {
    const auto inverse = [&](int step) { return 1.0 / depth_at(view, column + step * dx, row + step * dy); };
    return std::abs(inverse(-1) - 2.0 * inverse(0) + inverse(1)) < 0.001 * inverse(0);
  };
  for (int k = 0; k < 2; ++k)
    for (int line = -1; line <= 2; ++line)
      if (!is_linear(x + k, y + line, 1, 0) || !is_linear(x + line, y + k, 0, 1)) return false;
  return true;
}

struct Agreement {
  int visible = 0;     // pixels that map into the other view and to a smooth part of it
  int agreeing = 0;    // ... on the same surface
  int occluded = 0;    // ... behind something nearer
  int impossible = 0;  // ... in front of what the other view sees
};

/// Maps every pixel of one view with its depth into the other view.
Agreement compare(const RenderedView& from, const RenderedView& to, const PinholeCamera& camera,
                  const Isometry3d& to_from_from, bool on_planes_alone) {
  Agreement result;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const Vector3d point = to_from_from * Vector3d(depth_at(from, x, y) * camera.ray(Vector2d(x, y)));
      const double seen = smooth_depth(to, camera.project(point));
      if (seen == 0.0 || (on_planes_alone && !is_on_one_plane(to, camera.project(point)))) continue;
      ++result.visible;
      const double difference = point.z() / seen - 1.0;
      if (std::abs(difference) < 0.004)
        ++result.agreeing;
      else if (difference > 0.0)
        ++result.occluded;
      else
        ++result.impossible;
    }
  }
  return result;
}

}  // namespace

TEST_CASE("a synthetic sequence has the same bytes every time, on any number of threads", "[synthetic]") {
  for (const std::string& scene : synthetic_scenes()) {
    SyntheticOptions options = small_options(scene);
    options.threads = 1;
    const RenderedView one = SyntheticSequence(options).render(3, Side::right);
    options.threads = 5;
    const SyntheticSequence again(options);
    again.render(0, Side::left);  // creates texture tiles in another order
    const RenderedView five = again.render(3, Side::right);
    CHECK(one.image.pixels == five.image.pixels);
    CHECK(one.depth == five.depth);
    options.seed = 8;
    CHECK(one.image.pixels != SyntheticSequence(options).render(3, Side::right).image.pixels);
  }
}

TEST_CASE("the ellipse moves by 1 to 4 cm per frame in all six degrees of freedom", "[synthetic]") {
  SyntheticOptions options = small_options("room");
  options.frames = 1500;
  const SyntheticSequence sequence(options);
  CHECK(sequence.frames() == 1500);
  CHECK(sequence.stamp_ns(0) == 0);
  CHECK(sequence.stamp_ns(1499) == 74'950'000'000);

  Vector3d sway = Vector3d::Zero(), travel = Vector3d::Zero();
  for (int frame = 1; frame < options.frames; ++frame) {
    const Isometry3d now = sequence.world_from_left(frame), step = sequence.world_from_left(frame - 1).inverse() * now;
    const Eigen::AngleAxisd turn(step.linear());
    REQUIRE(step.translation().norm() >= 0.01);
    REQUIRE(step.translation().norm() <= 0.04);
    REQUIRE(turn.angle() <= 1.0 * M_PI / 180.0);
    REQUIRE(now.translation().norm() < 0.7);
    sway = sway.cwiseMax((turn.angle() * turn.axis()).cwiseAbs());
    travel = travel.cwiseMax(now.translation().cwiseAbs());
  }
  CHECK(sway.minCoeff() > 0.1 * M_PI / 180.0);  // all six degrees of freedom
  CHECK(travel.minCoeff() > 0.05);
}

TEST_CASE("the synthetic rig is rectified, with the requested baseline and focal length", "[synthetic]") {
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
  struct Case {
    const char *scene, *path;
    double least_visible;  // fraction of pixels; among pickets and leaves few share a plane with their neighbours
  };
  for (const Case& c : {Case{"room", "ellipse", 0.75}, Case{"facade", "ellipse", 0.2}, Case{"facade", "handheld", 0.2},
                        Case{"facade", "drive", 0.2}}) {
    SyntheticOptions options = small_options(c.scene);
    options.path = c.path;
    const SyntheticSequence sequence(options);
    const PinholeCamera& camera = sequence.rig().left;
    const RenderedView left = sequence.render(0, Side::left), right = sequence.render(0, Side::right),
                       later = sequence.render(3, Side::left);
    for (const auto& [view, pose] : {std::pair(&right, sequence.rig().right_from_left),
                                     std::pair(&later, sequence.world_from_left(3).inverse())}) {
      const Agreement result = compare(left, *view, camera, pose, std::string(c.scene) != "room");
      CAPTURE(c.scene, c.path, result.visible, result.agreeing, result.occluded, result.impossible);
      CHECK(result.visible > c.least_visible * camera.width * camera.height);
      CHECK(result.agreeing > 0.93 * result.visible);
      CHECK(result.impossible < 0.01 * result.visible);  // creases between two planes, where depth is interpolated
    }
  }
}

TEST_CASE("synthetic camera noise has the requested standard deviation and is independent", "[synthetic]") {
  SyntheticOptions options = small_options("room");
  options.supersampling = 1;
  options.noise = 0.0;
  const SyntheticSequence clean(options);
  options.noise = 3.0;
  const SyntheticSequence noisy(options);
  const auto noise = [&](int frame, Side side) {
    const std::vector<std::uint8_t> a = noisy.render(frame, side).image.pixels,
                                    b = clean.render(frame, side).image.pixels;
    Eigen::VectorXd difference(static_cast<Eigen::Index>(a.size()));
    for (std::size_t i = 0; i < a.size(); ++i)
      difference[static_cast<Eigen::Index>(i)] = static_cast<double>(a[i]) - b[i];
    return difference;
  };
  const Eigen::VectorXd first = noise(0, Side::left), right = noise(0, Side::right), second = noise(1, Side::left);
  const auto count = static_cast<double>(first.size());
  const double expected = std::sqrt(9.0 + 2.0 / 12.0);  // both images are rounded
  CHECK(std::sqrt(first.squaredNorm() / count) == Approx(expected).epsilon(0.025));
  CHECK(std::abs(first.mean()) < 0.1);
  for (const Eigen::VectorXd& other : {right, second, Eigen::VectorXd(first.tail(first.size() - 1))}) {
    const Eigen::Index n = std::min(first.size(), other.size());
    CHECK(std::abs(first.head(n).dot(other.head(n))) / count / (expected * expected) < 0.04);
  }
}

TEST_CASE("invalid synthetic options are refused", "[synthetic]") {
  const auto refuses = [](const std::function<void(SyntheticOptions&)>& change) {
    SyntheticOptions options = small_options("room");
    change(options);
    CHECK_THROWS_AS(SyntheticSequence(options), UsageError);
  };
  refuses([](SyntheticOptions& o) { o.scene = "kitchen"; });
  refuses([](SyntheticOptions& o) { o.path = "spiral"; });
  refuses([](SyntheticOptions& o) { o.frames = 0; });
  refuses([](SyntheticOptions& o) { o.width = 0; });
  refuses([](SyntheticOptions& o) { o.height = -3; });
  refuses([](SyntheticOptions& o) { o.focal = std::nan(""); });
  refuses([](SyntheticOptions& o) { o.baseline = 0.0; });
  refuses([](SyntheticOptions& o) { o.noise = -1.0; });
  refuses([](SyntheticOptions& o) { o.supersampling = 0; });
  refuses([](SyntheticOptions& o) { o.threads = -1; });
  refuses([](SyntheticOptions& o) { o.gain = 0; });
  refuses([](SyntheticOptions& o) { o.right_gain = -1; });
  refuses([](SyntheticOptions& o) { o.blur = -0.1; });
  refuses([](SyntheticOptions& o) { o.mover = 0.7; });
  refuses([](SyntheticOptions& o) { o.lens = "toy"; });
  refuses([](SyntheticOptions& o) { o.right_rotation = {0, 30, 0}; });
  const SyntheticSequence sequence(small_options("room"));
  CHECK_THROWS_AS(sequence.render(8, Side::left), UsageError);
  CHECK_THROWS_AS(sequence.render(-1, Side::left), UsageError);
}
