/// \file lenses.cpp  Tables of named lenses and rigs; the rays of pixel centres and corners, inverted once.
#include "scenes/lenses.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

#include "geometry/calibration.hpp"
#include "geometry/lens_mapping.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/synthetic.hpp"

namespace quadedge {
namespace {

const double kWidest = std::tan(80 * kDegree);  // tangent of the widest ray that pixels are inverted for

struct NamedLens {
  const char* name;
  LensModel model;
  double focal;  ///< factor for the pinhole camera's focal length
  std::vector<double> parameters;
};

/// The wide-angle lenses have a field of view of 150 to 170 degrees at the default image width.
const std::vector<NamedLens>& lenses() {
  static const std::vector<NamedLens> all = {
      {"pinhole", LensModel::radial_tangential, 1, {}},
      {"radtan", LensModel::radial_tangential, 1, {-0.28, 0.074, 2e-4, 2e-5}},
      {"equidistant", LensModel::equidistant, 0.6, {0.0035, 0.0007, -0.0021, 0.0002}},
      {"fov", LensModel::field_of_view, 0.6, {0.92}},
      {"double-sphere", LensModel::double_sphere, 0.5, {-0.2, 0.58}},
      {"omni", LensModel::omnidirectional, 1.3, {1.2, -0.1, 0.05, 1e-4, -1e-4}},
  };
  return all;
}

}  // namespace

const std::vector<std::string>& synthetic_lenses() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedLens& lens : lenses()) list.emplace_back(lens.name);
    return list;
  }();
  return names;
}

const std::vector<std::string>& synthetic_rigs() {
  static const std::vector<std::string> names = {"rectified", "eth3d-slam"};
  return names;
}

namespace synthetic {

Lens make_lens(const std::string& name, double focal) {
  const auto& all = lenses();
  const auto found = std::find_if(all.begin(), all.end(), [&](const NamedLens& lens) { return name == lens.name; });
  Lens lens;
  lens.model = found->model;
  lens.parameters = found->parameters;
  lens.camera.fx = lens.camera.fy = found->focal * focal;
  return lens;
}

StereoCalibration eth3d_slam_rig() {
  StereoCalibration calibration;
  calibration.left.camera = {726.043884, 726.043884, 385.732483, 262.196411, 742, 464};
  calibration.right.camera = {726.287415, 726.287415, 354.649689, 186.465668, 739, 458};
  Eigen::Matrix3d camera1_from_camera2;
  camera1_from_camera2 << 0.99992036819458, 0.012368063442409, -0.0024963859468699,  //
      -0.012378259561956, 0.99991494417191, -0.0041112052276731,                     //
      0.0024453257210553, 0.0041417786851525, 0.99998843669891;
  calibration.right_from_left.linear() = camera1_from_camera2;
  calibration.right_from_left.translation() << -0.089831538498402, -0.0001915143802762, 0.00019389642693568;
  calibration.right_from_left = rounded_transform(calibration.right_from_left);
  return calibration;
}

PixelRays::PixelRays(const Lens& lens) : camera_(lens.camera), pinhole_(lens.camera) {
  if (lens.is_pinhole()) return;
  const LensMapping mapping(lens);
  table_.resize(index(0, camera_.height + 1));
  const auto look = [&](double x, double y, Eigen::Vector2d& at) {
    const auto ray = mapping.ray({x, y});
    if (!ray || ray->z() <= 0 || ray->head<2>().norm() > kWidest * ray->z()) return false;
    at = ray->hnormalized();
    return true;
  };
  std::vector<char> corner_seen(table_.size());
  tbb::parallel_for(0, camera_.height + 1, [&](int y) {
    for (int x = 0; x <= camera_.width; ++x) {
      Pixel& pixel = table_[index(x, y)];
      pixel.seen = look(x, y, pixel.centre);
      corner_seen[index(x, y)] = look(x - 0.5, y - 0.5, pixel.corner) ? 1 : 0;
    }
  });
  for (int y = 0; y < camera_.height; ++y) {
    for (int x = 0; x < camera_.width; ++x) {
      bool& seen = table_[index(x, y)].seen;
      for (const std::size_t corner : {index(x, y), index(x + 1, y), index(x, y + 1), index(x + 1, y + 1)})
        seen = seen && corner_seen[corner] != 0;
    }
  }
  // Large enough for every visible ray.
  pinhole_.width = pinhole_.height = 2 * static_cast<int>(std::ceil(kWidest * camera_.fx)) + 1;
  pinhole_.fy = pinhole_.fx;
  pinhole_.cx = pinhole_.cy = 0.5 * (pinhole_.width - 1);
}

Eigen::Vector3d PixelRays::centre(int x, int y) const {
  if (table_.empty()) return camera_.ray(Eigen::Vector2d(x, y));
  return table_[index(x, y)].centre.homogeneous();
}

Eigen::Vector3d PixelRays::corner(int x, int y) const {
  if (table_.empty()) return camera_.ray({x - 0.5, y - 0.5});
  return table_[index(x, y)].corner.homogeneous();
}

Eigen::Matrix2d PixelRays::spread(int x, int y) const {
  const auto at = [&](int column, int row) -> const Eigen::Vector2d& { return table_[index(column, row)].corner; };
  Eigen::Matrix2d sides;
  sides << 0.5 * (at(x + 1, y) - at(x, y) + at(x + 1, y + 1) - at(x, y + 1)),
      0.5 * (at(x, y + 1) - at(x, y) + at(x + 1, y + 1) - at(x + 1, y));
  return sides;
}

Eigen::Vector3d PixelRays::within(int x, int y, const Eigen::Vector2d& offset) const {
  if (table_.empty()) return camera_.ray(Eigen::Vector2d(x, y) + offset);
  return (table_[index(x, y)].centre + spread(x, y) * offset).homogeneous();
}

void PixelRays::within(int x, int y, const Eigen::Vector2d* offsets, RayBundle& rays) const {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const Eigen::Vector3d ray = within(x, y, offsets[i]);
    rays.x[i] = ray.x();
    rays.y[i] = ray.y();
  }
}

double PixelRays::focal_length(int x, int y) const {
  return table_.empty() ? camera_.fx : 1 / std::sqrt(std::abs(spread(x, y).determinant()));
}

PixelBox PixelRays::footprint(const PixelBox& pixels) const {
  if (table_.empty()) return pixels;
  Eigen::Array2d low(1e9, 1e9), high = -low;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      if (!is_visible(x, y)) continue;
      for (const Eigen::Vector3d& ray : {corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)}) {
        const Eigen::Array2d position = pinhole_.project(ray).array();
        low = low.min(position);
        high = high.max(position);
      }
    }
  }
  if (low.x() > high.x()) return {};
  // Pixels extend around their centres, and sides may bulge by a fraction of a pixel.
  return {static_cast<int>(std::floor(low.x())) - 1, static_cast<int>(std::floor(low.y())) - 1,
          static_cast<int>(std::ceil(high.x())) + 2, static_cast<int>(std::ceil(high.y())) + 2};
}

}  // namespace synthetic
}  // namespace quadedge
