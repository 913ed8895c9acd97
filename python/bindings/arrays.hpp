#pragma once
/// \file arrays.hpp  numpy arrays over the memory of C++ objects, and conversions.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nanobind/ndarray.h>
#include <vector>

#include "bindings.hpp"

namespace quadedge::python {

/// A read-only array over the memory of an object, which properties with `kView` keep alive.
template <class T>
using ArrayView = nb::ndarray<nb::numpy, const T>;

/// For properties that return an ArrayView of their object's memory.
constexpr auto kView = nb::rv_policy::reference_internal;
/// For properties that return an array that owns its memory.
constexpr auto kOwned = nb::rv_policy::automatic;

/// (N,) over a vector.
template <class T>
ArrayView<T> view_of(const std::vector<T>& values) {
  return ArrayView<T>(values.data(), {values.size()});
}

/// (rows, columns) over a matrix of fixed or dynamic size; strides express Eigen's column-major order.
template <class Matrix>
ArrayView<double> view_of_matrix(const Matrix& matrix) {
  return ArrayView<double>(matrix.data(),
                           {static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())}, {},
                           {1, static_cast<std::int64_t>(matrix.outerStride())});
}

/// (columns, rows) over a matrix: one row per column.
template <class Matrix>
ArrayView<double> view_of_columns(const Matrix& matrix) {
  return ArrayView<double>(matrix.data(),
                           {static_cast<std::size_t>(matrix.cols()), static_cast<std::size_t>(matrix.rows())}, {},
                           {static_cast<std::int64_t>(matrix.outerStride()), 1});
}

/// A row-major copy.
template <class Matrix>
nb::ndarray<nb::numpy, double> copy_of_matrix(const Matrix& matrix) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  auto* rows = new Rows(matrix);
  const nb::capsule owner(rows, [](void* pointer) noexcept { delete static_cast<Rows*>(pointer); });
  return nb::ndarray<nb::numpy, double>(
      rows->data(), {static_cast<std::size_t>(rows->rows()), static_cast<std::size_t>(rows->cols())}, owner);
}

/// Pairs (x, y) as an (N, 2) array that owns its memory.
nb::ndarray<nb::numpy, float> pairs_of(const std::vector<float>& x, const std::vector<float>& y);

/// A rigid transform from a 4 x 4 array. \param name  for messages. \throws DataError for another shape, a last row
/// other than 0 0 0 1, and a matrix that is not orthonormal.
Eigen::Isometry3d transform_from(const nb::object& object, const std::string& name);

}  // namespace quadedge::python
