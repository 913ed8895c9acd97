#pragma once
/// \file arrays.hpp  numpy arrays that look at the memory of C++ objects.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <nanobind/ndarray.h>
#include <vector>

#include "bindings.hpp"

namespace quadedge::python {

/// A read-only array over memory of an object that properties with `kView` keep alive.
template <class T>
using ArrayView = nb::ndarray<nb::numpy, const T>;

/// For properties that return an ArrayView of their object's memory.
constexpr auto kView = nb::rv_policy::reference_internal;
/// For properties that return an array with an owner of its own.
constexpr auto kOwned = nb::rv_policy::automatic;

/// (N,) over a vector.
template <class T>
ArrayView<T> view_of(const std::vector<T>& values) {
  return ArrayView<T>(values.data(), {values.size()});
}

/// (rows, columns) over a matrix of fixed or dynamic size; numpy sees Eigen's order of columns as strides.
template <class Matrix>
ArrayView<double> view_of_matrix(const Matrix& matrix) {
  return ArrayView<double>(matrix.data(),
                           {static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols())}, {},
                           {1, static_cast<std::int64_t>(matrix.outerStride())});
}

/// (columns, rows): a row per column of the matrix.
template <class Matrix>
ArrayView<double> view_of_columns(const Matrix& matrix) {
  return ArrayView<double>(matrix.data(),
                           {static_cast<std::size_t>(matrix.cols()), static_cast<std::size_t>(matrix.rows())}, {},
                           {static_cast<std::int64_t>(matrix.outerStride()), 1});
}

/// An array that owns a copy, row-major.
template <class Matrix>
nb::ndarray<nb::numpy, double> copy_of_matrix(const Matrix& matrix) {
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  auto* rows = new Rows(matrix);
  const nb::capsule owner(rows, [](void* pointer) noexcept { delete static_cast<Rows*>(pointer); });
  return nb::ndarray<nb::numpy, double>(
      rows->data(), {static_cast<std::size_t>(rows->rows()), static_cast<std::size_t>(rows->cols())}, owner);
}

/// Pairs (x, y) as an (N, 2) array that owns them.
nb::ndarray<nb::numpy, float> pairs_of(const std::vector<float>& x, const std::vector<float>& y);

/// A rigid transform from a 4 x 4 array. \throws DataError, which calls it `name`, for another shape, another last row
/// than 0 0 0 1, or a rotation that is none.
Eigen::Isometry3d transform_from(const nb::object& object, const std::string& name);

}  // namespace quadedge::python
