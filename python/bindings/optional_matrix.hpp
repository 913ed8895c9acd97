#pragma once
/// \file optional_matrix.hpp  Properties that are a matrix or None.

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>

#include "arrays.hpp"

namespace quadedge::python {

/// A matrix of the object `owner` as an array that keeps it alive; None if there is none.
template <class Matrix>
nb::object optional_matrix(const std::optional<Matrix>& matrix, nb::handle owner) {
  if (!matrix) return nb::none();
  constexpr std::size_t kSize = Matrix::RowsAtCompileTime;
  return nb::cast(ArrayView<double>(matrix->data(), {kSize, kSize}, owner, {1, static_cast<std::int64_t>(kSize)}));
}
inline nb::object optional_matrix(const std::optional<Eigen::Isometry3d>& pose, nb::handle owner) {
  if (!pose) return nb::none();
  return nb::cast(ArrayView<double>(pose->matrix().data(), {4, 4}, owner, {1, 4}));
}

/// A property of T that is an optional matrix. \param of a member, or a function of the object
template <class T, class Of>
void def_optional(nb::class_<T>& bound, const char* name, Of of, const char* help) {
  const std::string signature = std::string("def ") + name + "(self) -> numpy.typing.NDArray[numpy.float64] | None";
  bound.def_prop_ro(
      name, [of](nb::handle_t<T> self) { return optional_matrix(std::invoke(of, nb::cast<const T&>(self)), self); },
      nb::sig(signature.c_str()), help);
}

}  // namespace quadedge::python
