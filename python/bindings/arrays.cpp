#include "arrays.hpp"

#include <cmath>

#include "quadedge/error.hpp"

namespace quadedge::python {

nb::ndarray<nb::numpy, float> pairs_of(const std::vector<float>& x, const std::vector<float>& y) {
  auto* pairs = new std::vector<float>(2 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    (*pairs)[2 * i] = x[i];
    (*pairs)[2 * i + 1] = y[i];
  }
  const nb::capsule owner(pairs, [](void* pointer) noexcept { delete static_cast<std::vector<float>*>(pointer); });
  return nb::ndarray<nb::numpy, float>(pairs->data(), {x.size(), 2}, owner);
}

Eigen::Isometry3d transform_from(const nb::object& object, const std::string& name) {
  nb::ndarray<const double, nb::ndim<2>, nb::device::cpu> array;
  if (!nb::try_cast(object, array)) throw nb::type_error((name + ": expected a 4 x 4 array of numbers").c_str());
  if (array.shape(0) != 4 || array.shape(1) != 4) {
    throw DataError(name + ": found " + std::to_string(array.shape(0)) + " x " + std::to_string(array.shape(1)) +
                    " numbers, expected 4 x 4");
  }
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix(row, column) = array.data()[row * array.stride(0) + column * array.stride(1)];
    }
  }
  constexpr double kTolerance = 1e-6;
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  const double deviation = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(deviation < kTolerance) || !(rotation.determinant() > 0) || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw DataError(name +
                    ": found a matrix that is not a rigid transform (its rotation deviates from orthonormality by " +
                    std::to_string(deviation) + "), expected a rotation and a translation above the row 0 0 0 1");
  }
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = rotation;
  transform.translation() = matrix.topRightCorner<3, 1>();
  return transform;
}

}  // namespace quadedge::python
