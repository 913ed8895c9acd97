/// \file lens_words.cpp  Lenses in the notation of Kalibr and EuRoC: a camera model, a distortion model, and their
/// parameters.

#include <cmath>

#include "data/calibrations/forms.hpp"
#include "data/text.hpp"
#include "quadedge/camera.hpp"

namespace quadedge::data {
namespace {

/// Number of values in `intrinsics` before fx fy cx cy.
std::size_t leading_numbers(const std::string& camera_model, const YamlMap& camera) {
  if (camera_model == "pinhole") return 0;
  if (camera_model == "omni") return 1;  // xi
  if (camera_model == "ds") return 2;    // xi alpha
  if (camera_model == "eucm") return 2;  // alpha beta
  camera.complain("camera_model", in_quotes(camera_model), "pinhole, omni, ds or eucm");
}

LensModel distortion_of(const std::string& word, const YamlMap& camera) {
  if (word == "radtan" || word == "radial-tangential" || word == "none") return LensModel::radial_tangential;
  if (word == "equidistant") return LensModel::equidistant;
  if (word == "fov") return LensModel::field_of_view;
  camera.complain("distortion_model", in_quotes(word), "radtan (radial-tangential), equidistant, fov or none");
}

}  // namespace

StatedLens read_named_lens(const YamlMap& camera, const std::string& coefficients) {
  const std::string model = camera.word("camera_model");
  const std::size_t leading = leading_numbers(model, camera);
  // Kalibr writes no distortion model behind ds and eucm in some versions.
  const std::string word = leading == 2 && !camera.has("distortion_model") ? "none" : camera.word("distortion_model");
  StatedLens stated(camera.file(), camera.name("intrinsics"), camera.name(coefficients));
  Lens& lens = stated.lens;
  lens.model = distortion_of(word, camera);
  const auto intrinsics = camera.numbers("intrinsics", leading + 4);
  const ImageSize size = camera.size("resolution");
  const double* k = intrinsics.data() + leading;
  lens.camera = {k[0], k[1], k[2], k[3], size.width, size.height};
  if (word != "none") lens.parameters = camera.numbers(coefficients);
  const bool radial = lens.model == LensModel::radial_tangential;
  if (model == "omni") {
    if (!radial) camera.complain("distortion_model", in_quotes(word), "radtan or none behind camera_model omni");
    lens.model = LensModel::omnidirectional;
    lens.parameters.insert(lens.parameters.begin(), intrinsics[0]);
  } else if (model == "ds" || model == "eucm") {
    if (word != "none") camera.complain("distortion_model", in_quotes(word), "none behind camera_model " + model);
    lens.model = model == "ds" ? LensModel::double_sphere : LensModel::extended_unified;
    lens.parameters = {intrinsics[0], intrinsics[1]};
  }
  return stated;
}

}  // namespace quadedge::data
