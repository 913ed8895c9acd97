#pragma once
/// \file lens.hpp  Lenses as calibrations describe them: models, parameters, size of the recorded images.

#include <string>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// How a lens maps the rays of its camera to the image. doc/your-own-data.md has the equations' sources.
enum class LensModel {
  radial_tangential,  ///< OpenCV's: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]; none: a pinhole camera
  equidistant,        ///< Kannala-Brandt, OpenCV's fisheye: k1 k2 k3 k4 of the angle from the optical axis
  field_of_view,      ///< Devernay and Faugeras: w [rad]
  double_sphere,      ///< Usenko et al.: xi alpha
  omnidirectional,    ///< Mei and Rives: xi, then as radial_tangential, on the plane behind the unit sphere
};

/// Name of a model in files and on the command line: radtan, equidistant, fov, double-sphere, omni.
const char* to_string(LensModel model);

/// A lens and the images that are recorded through it.
struct Lens {
  LensModel model = LensModel::radial_tangential;
  /// Focal lengths and principal point of the model [px]; size of the recorded images, 0 x 0 where nobody said yet.
  PinholeCamera camera;
  std::vector<double> parameters;  ///< of the model, in the order above; angles in radians

  /// Are the recorded images those of the pinhole camera `camera`?
  bool is_pinhole() const;
};

}  // namespace quadedge
