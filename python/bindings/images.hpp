#pragma once
/// \file images.hpp  Grey images from and to numpy.

#include <nanobind/ndarray.h>
#include <string>
#include <vector>

#include "bindings.hpp"
#include "quadedge/image.hpp"

namespace quadedge::python {

/// An image that Python hands in: a height x width array of uint8 or uint16. Rows may be any number of bytes apart;
/// what else is strided is copied. Keeps the array alive, and must be destroyed with the GIL held.
class ImageArgument {
 public:
  /// `name`: "the left image". `max_value`: value of a saturated pixel of 16 bits. \throws TypeError for what is no
  /// array or has other pixels, DataError for another shape and pixels that run backwards.
  ImageArgument(nb::handle object, const std::string& name, int max_value);
  ImageArgument(const ImageArgument&) = delete;
  ImageArgument& operator=(const ImageArgument&) = delete;
  /// Its checks are left to the library: an empty image, a stride below a row's bytes.
  const ImageView& view() const { return view_; }

 private:
  nb::ndarray<nb::ro, nb::device::cpu> array_;
  std::vector<std::uint8_t> copy_;
  ImageView view_;
};

/// The pixels of an image as an array, a view for properties with `kView`.
nb::object pixels_of(const Image& image, nb::handle owner);

}  // namespace quadedge::python
