#pragma once
/// \file images.hpp  Conversion of grey images between numpy and the library.

#include <nanobind/ndarray.h>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/image.hpp"

namespace quadedge::python {

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
  ImageArgument(const ImageArgument&) = delete;
  ImageArgument& operator=(const ImageArgument&) = delete;
  /// Empty images and strides shorter than a row are left to the library to refuse.
  const ImageView& view() const { return view_; }

 private:
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
    const nb::gil_scoped_release released;
    *image = make();
  }
  return pixels_of(*image, owner);
}

}  // namespace quadedge::python
