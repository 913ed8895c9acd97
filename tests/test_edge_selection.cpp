#include "device/edge_detection.hpp"
#include "edge_images.hpp"
#include "geometry/epipolar_geometry.hpp"
#include "reference/edge_detection.hpp"

using namespace quadedge;

namespace {

StereoRig rectified_rig(int width, int height) {
  StereoRig rig;
  rig.left = rig.right = {0.9 * width, 0.9 * width, 0.5 * width, 0.5 * height, width, height};
  rig.right_from_left = Eigen::Translation3d(-0.1, 0, 0) * Eigen::Isometry3d::Identity();
  return rig;
}

/// Converging, rolled, with different focal lengths.
StereoRig general_rig(int width, int height) {
  StereoRig rig = rectified_rig(width, height);
  rig.right.fx = rig.right.fy = 0.8 * width;
  rig.right_from_left =
      Eigen::Translation3d(-0.1, 0.02, 0.01) *
      (Eigen::AngleAxisd(0.05, Eigen::Vector3d(0.3, 0.8, 0.5).normalized()) * Eigen::Isometry3d::Identity());
  return rig;
}

/// Maxima as the device holds them, row by row, with their gradients unpacked.
struct DeviceMaxima {
  std::vector<std::vector<cl_float>> rows;  ///< 4 floats per maximum
  reference::GradientMaxima maxima;
};

DeviceMaxima read(const stages::EdgeMaxima& maxima, int width, int height) {
  DeviceMaxima result;
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  const auto winners = maxima.winners.read(4 * columns * rows);
  std::vector<cl_int> counts;
  std::vector<cl_uchar> flags;
  if (maxima.at_pixels) {
    flags = maxima.flags.read(columns * rows);
  } else {
    counts = maxima.counts.read(rows);
  }
  for (std::size_t row = 0; row < rows; ++row) {
    result.rows.emplace_back();
    const std::size_t most = maxima.at_pixels ? columns : static_cast<std::size_t>(counts[row]);
    for (std::size_t k = 0; k < most; ++k) {
      if (maxima.at_pixels && flags[row * columns + k] == 0) continue;
      const cl_float* winner = winners.data() + 4 * (row * columns + k);
      result.rows.back().insert(result.rows.back().end(), winner, winner + 4);
      const float code = winner[3];
      const bool steep = code >= 512.0F;
      const float ratio = (steep ? code - 512.0F : code) / 255.5F - 1.0F;
      result.maxima.x.push_back(winner[0]);
      result.maxima.y.push_back(winner[1]);
      result.maxima.gradient_x.push_back(steep ? 1.0F : ratio);
      result.maxima.gradient_y.push_back(steep ? ratio : 1.0F);
      result.maxima.row.push_back(static_cast<std::int32_t>(row));
    }
  }
  return result;
}

std::vector<std::vector<cl_float>> kept_rows(const DeviceMaxima& all, const std::vector<std::uint8_t>& kept) {
  std::vector<std::vector<cl_float>> rows(all.rows.size());
  std::size_t i = 0;
  for (std::size_t row = 0; row < all.rows.size(); ++row) {
    for (std::size_t k = 0; k < all.rows[row].size(); k += 4, ++i) {
      if (kept[i] == 0) continue;
      rows[row].insert(rows[row].end(), all.rows[row].begin() + static_cast<std::ptrdiff_t>(k),
                       all.rows[row].begin() + static_cast<std::ptrdiff_t>(k + 4));
    }
  }
  return rows;
}

std::size_t count_kept(const std::vector<std::uint8_t>& kept) {
  return static_cast<std::size_t>(std::count(kept.begin(), kept.end(), 1));
}

/// A curve of maxima a pixel apart in their longer coordinate, at `angle` to the x axis.
reference::GradientMaxima straight_curve(double angle, double x, double y, double length) {
  reference::GradientMaxima maxima;
  const double step = 1 / std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
  for (double s = 0; s < length; s += step) {
    maxima.x.push_back(static_cast<float>(x + s * std::cos(angle)));
    maxima.y.push_back(static_cast<float>(y + s * std::sin(angle)));
    maxima.gradient_x.push_back(static_cast<float>(-std::sin(angle)));
    maxima.gradient_y.push_back(static_cast<float>(std::cos(angle)));
    maxima.row.push_back(static_cast<std::int32_t>(std::lround(maxima.y.back())));
  }
  return maxima;
}

}  // namespace

TEST_CASE("edge selection: devices keep exactly the same maxima as the reference", "[edges][device][oclgrind]") {
  const int width = 61, height = 47;
  EdgesConfig config;
  config.margin = 2;
  config.budget = 75;
  for (const auto& [rig, most] :
       {std::pair(rectified_rig(width, height), 1000.0), std::pair(general_rig(width, height), 2.0)}) {
    config.max_spacing = most;
    const SelectionArguments left = selection_arguments(rig, Side::left), right = selection_arguments(rig, Side::right);
    for_each_variant("edge_detection", [&](opencl::Context& context, const Variants& variants) {
      stages::EdgeDetection in_left(context, width, height, config, variants),
          in_right(context, width, height, config, variants);
      stages::PaddedPlane plane(context, width, height, config.sigma);
      opencl::Buffer<cl_float> threshold;
      threshold.write(context, {2.0F});
      const auto find = [&](stages::EdgeDetection& detection, std::uint64_t seed) {
        opencl::Buffer<cl_uchar> pixels;
        pixels.write(context, textured_image(width, height, seed).pixels);
        plane.prepare(pixels);
        detection.find_maxima(plane, threshold);
        return read(detection.maxima(), width, height);
      };
      const std::vector<DeviceMaxima> all = {find(in_left, 1), find(in_right, 2)};
      const float spacing = reference::selection_spacing(left, all[0].maxima, right, all[1].maxima, config);
      REQUIRE(spacing > 0.6F);
      const auto kept_left = reference::kept_by_selection(left, all[0].maxima, spacing),
                 kept_right = reference::kept_by_selection(right, all[1].maxima, spacing);
      REQUIRE(count_kept(kept_left) < all[0].maxima.x.size() / 2);

      stages::EdgeSelection selection(context, config, in_left.maxima());
      selection.run(left, right, in_left.maxima(), in_right.maxima());
      selection.request();
      CHECK(read(in_left.maxima(), width, height).rows == kept_rows(all[0], kept_left));
      CHECK(read(in_right.maxima(), width, height).rows == kept_rows(all[1], kept_right));
      CHECK(selection.host_spacing() == static_cast<double>(spacing));
      // The next frame is selected independently.
      find(in_left, 1);
      find(in_right, 2);
      selection.run(left, right, in_left.maxima(), in_right.maxima());
      selection.request();
      CHECK(read(in_left.maxima(), width, height).rows == kept_rows(all[0], kept_left));
      CHECK(selection.host_spacing() == static_cast<double>(spacing));
    });
  }
}

TEST_CASE("edge selection: epipolar lines have the same numbers in both images, also beside the calibrated rows",
          "[edges]") {
  for (const auto& [rig, error] : {std::pair(general_rig(640, 480), RectificationError{}),
                                   {rectified_rig(640, 480), {0.8, 0.5, -0.3, 0.4, 1, -0.6}},
                                   {general_rig(640, 480), {0.8, 0.5, -0.3, 0.4, 1, -0.6}}}) {
    const auto number = [](const SelectionArguments& of, const Eigen::Vector2d& p) {
      const auto x = static_cast<float>(p.x()), y = static_cast<float>(p.y());
      const EpipolarRows& rows = of.rows;
      return static_cast<double>((rows.across_x * x + rows.across_y * y + rows.across_1) /
                                     (rows.forward_x * x + rows.forward_y * y + rows.forward_1) -
                                 (rows.bend_xx * x * x + rows.bend_xy * x * y + rows.bend_yy * y * y));
    };
    const SelectionArguments left = selection_arguments(rig, Side::left, error),
                             right = selection_arguments(rig, Side::right, error);
    StereoConfig config;
    config.max_disparity = 20;
    const EpipolarGeometry moved = corrected(make_epipolar_geometry(rig, config), error, rig);
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(20, 30), Eigen::Vector2d(330, 200), Eigen::Vector2d(600, 440)}) {
      const EpipolarLine line = epipolar_line(moved, static_cast<float>(p.x()), static_cast<float>(p.y()));
      CHECK(number(right, {line.x, line.y}) == Approx(number(left, p)).margin(error.largest() > 0 ? 0.1 : 0.01));
    }
  }
}

TEST_CASE("edge selection: dense textures have more than the budget, at most 1.75 times as many edges", "[edges]") {
  const SelectionArguments arguments = selection_arguments(rectified_rig(400, 400), Side::left);
  reference::GradientMaxima maxima;
  for (int x = 20; x < 380; x += 4) {
    const auto curve = straight_curve(90 * kDegree, x, 20.71, 360);
    maxima.x.insert(maxima.x.end(), curve.x.begin(), curve.x.end());
    maxima.y.insert(maxima.y.end(), curve.y.begin(), curve.y.end());
    maxima.gradient_x.insert(maxima.gradient_x.end(), curve.gradient_x.begin(), curve.gradient_x.end());
    maxima.gradient_y.insert(maxima.gradient_y.end(), curve.gradient_y.begin(), curve.gradient_y.end());
    maxima.row.insert(maxima.row.end(), curve.row.begin(), curve.row.end());
  }
  EdgesConfig config;
  config.budget = 4000;  // of 90 curves of 360 px: 8.1 px apart
  const auto spacing = [&](double most) {
    config.max_spacing = most;
    return static_cast<double>(reference::selection_spacing(arguments, maxima, arguments, maxima, config));
  };
  CHECK(spacing(1000) == Approx(90 * 360 / 4000.0).epsilon(0.02));
  CHECK(spacing(9) == spacing(1000));
  CHECK(spacing(6) == 6);
  CHECK(spacing(2) == Approx(spacing(1000) / 1.75).epsilon(0.01));
}

TEST_CASE("edge selection: a straight curve keeps one maximum per line, evenly spaced at every angle", "[edges]") {
  SelectionArguments arguments = selection_arguments(rectified_rig(400, 400), Side::left);
  const float spacing = 3;
  for (double degrees = 6; degrees < 174; degrees += 3.7) {
    const double angle = degrees * kDegree, length = 240;
    INFO(degrees << " degrees");
    const auto curve = straight_curve(angle, degrees < 90 ? 30.13 : 350.13, 20.71, length);
    const auto kept = reference::kept_by_selection(arguments, curve, spacing);
    std::vector<double> at;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] != 0) at.push_back(std::hypot(curve.x[i] - curve.x[0], curve.y[i] - curve.y[0]));
    REQUIRE(at.size() > 2);
    // Between 0.7 and 1.4 spacings apart, up to a pixel on either side.
    for (std::size_t k = 1; k < at.size(); ++k) {
      CHECK(at[k] - at[k - 1] > 0.7 * 3 - 1.42);
      CHECK(at[k] - at[k - 1] < 1.42 * 3 + 1.42);
    }
  }
  // Edges along the epipolar lines cannot be matched, so none are kept.
  CHECK(count_kept(reference::kept_by_selection(arguments, straight_curve(2 * kDegree, 30, 200, 240), spacing)) == 0);
}

TEST_CASE("edge selection: the counterpart of a kept edge is kept too", "[edges]") {
  const StereoRig rig = general_rig(400, 300);
  const SelectionArguments left = selection_arguments(rig, Side::left), right = selection_arguments(rig, Side::right);
  int chosen = 0, with_counterpart = 0;
  // Curves on slanted planes, so that directions differ between the images.
  for (double degrees = 20; degrees < 160; degrees += 7) {
    const auto project = [&](double s, bool in_right) -> Eigen::Vector2d {
      const Eigen::Vector3d point(-0.6 + s * std::cos(degrees * kDegree), -0.5 + s * std::sin(degrees * kDegree),
                                  2.5 + 0.4 * s);
      return in_right ? rig.right.project(rig.right_from_left * point) : rig.left.project(point);
    };
    const auto curve = [&](bool in_right) {
      reference::GradientMaxima maxima;
      Eigen::Vector2d last = project(0, in_right);
      for (double s = 0; s < 1.2; s += 1e-4) {
        const Eigen::Vector2d here = project(s, in_right), tangent = project(s + 1e-4, in_right) - here;
        if ((here - last).lpNorm<Eigen::Infinity>() < 1) continue;
        last = here;
        maxima.x.push_back(static_cast<float>(here.x()));
        maxima.y.push_back(static_cast<float>(here.y()));
        maxima.gradient_x.push_back(static_cast<float>(-tangent.y()));
        maxima.gradient_y.push_back(static_cast<float>(tangent.x()));
        maxima.row.push_back(0);
      }
      return maxima;
    };
    const auto in_left = curve(false), in_right = curve(true);
    const auto kept = reference::kept_by_selection(left, in_left, 4),
               found = reference::kept_by_selection(right, in_right, 4);
    const auto number = [](const EpipolarRows& rows, float x, float y) {
      return (rows.across_x * x + rows.across_y * y + rows.across_1) /
             (rows.forward_x * x + rows.forward_y * y + rows.forward_1);
    };
    for (std::size_t i = 0; i < kept.size(); ++i) {
      if (kept[i] == 0) continue;
      ++chosen;
      const float row = number(left.rows, in_left.x[i], in_left.y[i]);
      // Both lie within half a pixel of the same line.
      for (std::size_t k = 0; k < found.size(); ++k) {
        if (found[k] == 0 || std::abs(number(right.rows, in_right.x[k], in_right.y[k]) - row) > 1.0F) continue;
        ++with_counterpart;
        break;
      }
    }
  }
  REQUIRE(chosen > 300);
  CHECK(with_counterpart > 0.97 * chosen);
}
