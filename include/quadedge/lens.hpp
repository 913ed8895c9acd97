#pragma once
/// \file lens.hpp  Lenses as described by calibrations: model, parameters, size of the recorded images.

#include <string>
#include <vector>

#include "quadedge/camera.hpp"

namespace quadedge {

/// Lens models, which map viewing rays to the image. doc/your-own-data.md gives the sources of the equations.
enum class LensModel {
  radial_tangential,  ///< OpenCV: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]]; no parameters: a pinhole
                      ///< camera
  equidistant,        ///< Kannala-Brandt, OpenCV's fisheye model: k1 k2 k3 k4 of the angle from the optical axis
  field_of_view,      ///< Devernay and Faugeras: w [rad]
  double_sphere,      ///< Usenko et al.: xi alpha
  omnidirectional,    ///< Mei and Rives: xi, then the parameters of radial_tangential, on the plane behind the unit
                      ///< sphere
};

/// Name of a model in files and on the command line: radtan, equidistant, fov, double-sphere, omni.
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
