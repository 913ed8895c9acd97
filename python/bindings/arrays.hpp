#pragma once
/// \file arrays.hpp  numpy arrays over the memory of C++ objects, images as arguments, and conversions.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <nanobind/ndarray.h>
#include <optional>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

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

/// For a property of Self that is a vector of it: (N,) over its memory. `Of`: Self, or a base of it.
template <class Self, class T, class Of>
auto view_of(std::vector<T> Of::*values) {
  return [values](const Self& self) { return view_of(self.*values); };
}

/// (N,) over one member of every row of a vector.
template <class Row, class Allocator, class T>
ArrayView<T> view_of(const std::vector<Row, Allocator>& rows, T Row::*member) {
  static_assert(sizeof(Row) % sizeof(T) == 0);
  const void* first = rows.empty() ? nullptr : &(rows.front().*member);
  return ArrayView<T>(first, {rows.size()}, {}, {sizeof(Row) / sizeof(T)});
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

/// For a property of Self that pairs two vectors of it. `Of`: Self, or a base of it.
template <class Self, class Of>
auto pairs_of(std::vector<float> Of::*x, std::vector<float> Of::*y) {
  return [x, y](const Self& self) { return pairs_of(self.*x, self.*y); };
}

/// A rigid transform from a 4 x 4 array. \param name  for messages. \throws DataError for another shape, a last row
/// other than 0 0 0 1, and a matrix that is not orthonormal.
Eigen::Isometry3d transform_from(const nb::object& object, const std::string& name);

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

constexpr int kMaxValue16 = 65535;

/// Value of a saturated pixel of 16-bit images of a rig.
inline int max_value_of(const StereoRig& rig) { return rig.max_value > kMaxValue8 ? rig.max_value : kMaxValue16; }

/// An image argument: an array of uint8 or uint16, height x width or height x width x 1. Rows may be padded; an array
/// that is strided along its rows is copied. Keeps the array alive, and must be destroyed with the GIL held.
class ImageArgument {
 public:
  /// \param name   for messages: "the left image"
  /// \param max_value  value of a saturated pixel of a uint16 image
  /// \throws TypeError for anything but an array of uint8 or uint16, DataError for other shapes (colour) and for
  ///     negative strides along a row.
  ImageArgument(nb::handle object, const std::string& name, int max_value);
  /// A mask of uint8, height x width, or None, which is empty. Not copied, unless its rows are strided.
  static ImageArgument mask(nb::handle object, const std::string& name);
  ImageArgument(const ImageArgument&) = delete;
  ImageArgument& operator=(const ImageArgument&) = delete;
  /// Empty images and strides shorter than a row are left to the library to refuse.
  const ImageView& view() const { return view_; }

 private:
  ImageArgument() = default;
  nb::ndarray<nb::ro, nb::device::cpu> array_;
  std::vector<std::uint8_t> copy_;
  ImageView view_;
};

/// The pixels of an image as a read-only array, (height, width), that keeps `owner` alive.
nb::object pixels_of(const Image& image, nb::handle owner);

/// The pixels of the image that `make()` returns; it runs without the GIL.
template <class Make>
nb::object pixels_of(const Make& make) {
  auto* image = new Image;
  const nb::capsule owner(image, [](void* pointer) noexcept { delete static_cast<Image*>(pointer); });
  {
    const ReleasedGil released;
    *image = make();
  }
  return pixels_of(*image, owner);
}

}  // namespace quadedge::python
