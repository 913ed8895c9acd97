/// \file arrays.cpp  Uses numpy's memory as it is where the strides allow it, otherwise copies; names what is wrong.
#include "arrays.hpp"

#include <cmath>
#include <cstring>
#include <nanobind/stl/string.h>

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
  if (!(deviation < kTolerance) || !matrix.allFinite() || !(rotation.determinant() > 0) ||
      matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    throw DataError(name +
                    ": found a matrix that is not a rigid transform (its rotation deviates from orthonormality by " +
                    nb::cast<std::string>(nb::str(nb::float_(deviation))) +
                    "), expected a rotation and a translation above the row 0 0 0 1");
  }
  Eigen::Isometry3d transform(rotation);
  transform.translation() = matrix.topRightCorner<3, 1>();
  return transform;
}

namespace {

constexpr const char* kExpectedMask = "expected a numpy array of uint8, height x width, 0 where nothing is tracked";
constexpr const char* kExpected = "expected a numpy array of uint8 or uint16, height x width";

[[noreturn]] void refuse_type(const std::string& name, const std::string& found) {
  throw nb::type_error((name + " is " + found + ", " + kExpected).c_str());
}

std::string type_of(nb::handle object) {
  return object.is_none() ? "None" : nb::cast<std::string>(nb::str(object.type().attr("__name__")));
}

[[noreturn]] void refuse_shape(const std::string& name, const nb::ndarray<nb::ro, nb::device::cpu>& array) {
  std::string message = name + " has ";
  for (std::size_t i = 0; i < array.ndim(); ++i) message += (i > 0 ? " x " : "") + std::to_string(array.shape(i));
  message += " values, expected height x width: one grey channel";
  const bool is_colour = array.ndim() == 3 && (array.shape(2) == 3 || array.shape(2) == 4);
  if (is_colour) message += ". Convert colour first, for example with cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)";
  throw DataError(message);
}

}  // namespace

ImageArgument::ImageArgument(nb::handle object, const std::string& name, int max_value) {
  if (!nb::ndarray_check(object)) refuse_type(name, type_of(object));
  const bool is_array = nb::try_cast(object, array_);
  const bool words = is_array && array_.dtype() == nb::dtype<std::uint16_t>();
  if (!is_array || (!words && array_.dtype() != nb::dtype<std::uint8_t>())) {
    const nb::object pixels = object.attr("dtype");
    refuse_type(name, "an array of " + nb::cast<std::string>(nb::str(nb::handle(pixels))));
  }
  if (array_.ndim() != 2 && !(array_.ndim() == 3 && array_.shape(2) == 1)) refuse_shape(name, array_);
  const auto height = static_cast<int>(array_.shape(0)), width = static_cast<int>(array_.shape(1));
  const std::ptrdiff_t bytes = words ? 2 : 1;
  const auto* pixels = static_cast<const std::uint8_t*>(array_.data());
  std::ptrdiff_t row = bytes * array_.stride(0);
  const std::ptrdiff_t step = bytes * array_.stride(1);
  if (height == 1) row = bytes * width;  // numpy leaves the stride of a dimension of length 1 undefined
  if (width > 1 && height > 0 && step < bytes) {
    throw DataError(name + " has a stride of " + std::to_string(step) +
                    " bytes from pixel to pixel, expected at least the " + std::to_string(bytes) + " of a pixel");
  }
  if (width > 1 && step != bytes && row >= 0) {
    copy_.resize(static_cast<std::size_t>(bytes * width * height));
    std::uint8_t* copied = copy_.data();
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x, copied += bytes) std::memcpy(copied, pixels + y * row + x * step, bytes);
    }
    pixels = copy_.data();
    row = bytes * width;
  }
  view_ = {pixels, width, height, row, words ? max_value : kMaxValue8};
}

ImageArgument ImageArgument::mask(nb::handle object, const std::string& name) {
  if (object.is_none()) return {};
  if (!nb::ndarray_check(object))
    throw nb::type_error((name + " is " + type_of(object) + ", " + kExpectedMask).c_str());
  const std::string type = nb::cast<std::string>(nb::str(nb::handle(nb::object(object.attr("dtype")))));
  if (type != "uint8" && type != "torch.uint8")
    throw nb::type_error((name + " is an array of " + type + ", " + kExpectedMask).c_str());
  return ImageArgument(object, name, kMaxValue8);
}

nb::object pixels_of(const Image& image, nb::handle owner) {
  const std::size_t shape[] = {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width)};
  if (image.max_value > kMaxValue8) {
    return nb::cast(nb::ndarray<nb::numpy, const std::uint16_t>(image.pixels.data(), 2, shape, owner));
  }
  return nb::cast(nb::ndarray<nb::numpy, const std::uint8_t>(image.pixels.data(), 2, shape, owner));
}

}  // namespace quadedge::python
