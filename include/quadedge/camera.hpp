#pragma once
/// \file camera.hpp  Pinhole cameras, lenses, the stereo rig, and undistortion tables.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace quadedge {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kDegree = kPi / 180.0;  ///< rad

enum class Side { left, right };

inline constexpr Side kSides[] = {Side::left, Side::right};

/// Index of a side in arrays of two: left 0, right 1.
constexpr int index_of(Side side) { return side == Side::left ? 0 : 1; }

/// An ideal pinhole camera. All values in pixels; pixel centres lie at integers, x to the right, y down.
struct PinholeCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  int width = 0, height = 0;

  /// 3 x 3 intrinsic matrix K.
  Eigen::Matrix3d matrix() const {
    Eigen::Matrix3d k;
    k << fx, 0, cx, 0, fy, cy, 0, 0, 1;
    return k;
  }
  /// Ray gamma = K^-1 (x, y, 1) of a pixel, with z = 1.
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const {
    return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
  }
  /// Pixel of a point in the camera frame. Requires z > 0.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const {
    return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
  }
};

/// Numbers whose copies share their memory until one of them is changed. Has no moved-from state.
class SharedFloats {
 public:
  SharedFloats(std::vector<float> values = {})  // NOLINT(google-explicit-constructor): as a vector is assigned
      : values_(std::make_shared<std::vector<float>>(std::move(values))) {}
  SharedFloats(const SharedFloats&) = default;
  SharedFloats& operator=(const SharedFloats&) = default;
  ~SharedFloats() = default;
  const std::vector<float>& values() const { return *values_; }
  float operator[](std::size_t i) const { return (*values_)[i]; }
  std::size_t size() const { return values_->size(); }
  bool empty() const { return values_->empty(); }
  /// The same, to be changed; copies keep what they have.
  std::vector<float>& change() {
    if (values_.use_count() > 1) values_ = std::make_shared<std::vector<float>>(*values_);
    return *values_;
  }

 private:
  std::shared_ptr<std::vector<float>> values_;
};

/// For every pixel of the pinhole image, the position in the recorded image with the same viewing direction [px, with
/// sub-pixel precision]. Positions outside the recorded image take the value of its border.
struct UndistortionTable {
  int width = 0, height = 0;                    ///< size of the pinhole image
  SharedFloats source_x, source_y;              ///< height x width each, row-major
  int recorded_width = 0, recorded_height = 0;  ///< size of the recorded image; 0: images of any size are accepted
  bool empty() const { return source_x.empty(); }
};

/// Pixels of a pinhole image without usable content: those without a counterpart in the recorded image and those masked
/// by the user (a car's bonnet).
struct PixelMask {
  int width = 0, height = 0;         ///< size of the pinhole image
  std::vector<std::uint8_t> hidden;  ///< height x width, row-major, 1 where a pixel is masked
  bool empty() const { return hidden.empty(); }
};

/// Two cameras in a fixed relative pose. Image sizes may differ, and the images need not be rectified.
struct StereoRig {
  PinholeCamera left, right;
  /// Gamma_right = right_from_left * Gamma_left, metres (paper Eq. 1). For a rectified rig: identity and (-baseline, 0,
  /// 0).
  Eigen::Isometry3d right_from_left = Eigen::Isometry3d::Identity();
  UndistortionTable left_undistortion, right_undistortion;  ///< empty if the recorded images are pinhole images
  PixelMask left_mask, right_mask;  ///< no edges within edges.margin of masked pixels; empty: none

  int max_value = 255;  ///< largest pixel value of the recorded images, see ImageView

  /// Largest disparity of the nearest objects [px], relative to a point at infinity; 0: unknown. Readers of data sets
  /// set it for the kind of scene that they hold.
  double max_disparity = 0;

  double baseline() const { return right_from_left.translation().norm(); }
  /// Disparity range with which the search starts if the configuration has neither stereo.max_disparity nor
  /// stereo.min_depth [px]: max_disparity, or if that is 0, the disparity of a point 0.5 m in front of the left camera.
  double disparity_range() const;
};

/// Checks that focal lengths, principal points and image sizes are those of a camera, that the baseline is finite and
/// positive, the rotation orthonormal, and max_disparity finite and not negative. \throws DataError that names `source`
/// (the calibration file) and the offending value.
void check_rig(const StereoRig& rig, const char* source);

/// Lens models, which map viewing rays to the image. doc/your-own-data.md gives the sources of the equations.
enum class LensModel {
  radial_tangential,  ///< OpenCV: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]; none: a pinhole
  equidistant,        ///< Kannala-Brandt, OpenCV's fisheye model: k1 k2 k3 k4 of the angle from the optical axis
  field_of_view,      ///< Devernay and Faugeras: w [rad]
  double_sphere,      ///< Usenko et al.: xi alpha
  extended_unified,   ///< Khomutenko et al., EUCM: alpha beta
  omnidirectional,    ///< Mei and Rives: xi, then the parameters of radial_tangential, on the plane behind the unit
                      ///< sphere
};

/// Name of a model in files and on the command line: radtan, equidistant, fov, double-sphere, eucm, omni.
const char* to_string(LensModel model);

/// A lens and the size of the images recorded with it.
struct Lens {
  LensModel model = LensModel::radial_tangential;
  /// Focal lengths and principal point of the model [px]; size of the recorded images, 0 x 0 if unknown.
  PinholeCamera camera;
  std::vector<double> parameters;  ///< of the model, in the order given there; angles in radians

  /// Whether the recorded images are pinhole images of `camera`.
  bool is_pinhole() const;
};

}  // namespace quadedge
