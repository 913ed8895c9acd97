#pragma once
/// \file recorded_images.hpp  Checks that a pair of images matches a rig.

#include <string>

#include "common/image_check.hpp"
#include "quadedge/camera.hpp"

namespace quadedge {

/// Image sizes that a rig expects: those of its cameras, or those that its undistortion tables specify.
class RecordedImages {
 public:
  explicit RecordedImages(const StereoRig& rig)
      : left_(size_of(rig.left, rig.left_undistortion)),
        right_(size_of(rig.right, rig.right_undistortion)),
        max_value_(rig.max_value) {}

  /// \throws DataError for an empty image, a stride smaller than a row, or a size or bit depth that differs from the
  /// rig's.
  void check(const ImageView& left, const ImageView& right) const {
    check(left, left_, "the left image");
    check(right, right_, "the right image");
  }

 private:
  struct Size {
    int width, height;  ///< 0: any
  };

  static Size size_of(const PinholeCamera& camera, const UndistortionTable& table) {
    return table.empty() ? Size{camera.width, camera.height} : Size{table.recorded_width, table.recorded_height};
  }
  void check(const ImageView& image, const Size& size, const std::string& name) const {
    check_pixels(image, name);
    if (image.max_value != max_value_)
      throw DataError(name + " has pixel values up to " + std::to_string(image.max_value) +
                      ", the rig expects values up to " + std::to_string(max_value_));
    if (size.width > 0 && (image.width != size.width || image.height != size.height))
      throw DataError(name + " has " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                      " pixels, the calibration expects " + std::to_string(size.width) + "x" +
                      std::to_string(size.height));
  }

  Size left_, right_;
  int max_value_;
};

}  // namespace quadedge
