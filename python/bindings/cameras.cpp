/// \file cameras.cpp  Camera and Rig for Python; a rig from calibration files, or of a dataset.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <utility>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

void bind_camera(nb::module_& module) {
  nb::class_<PinholeCamera>(module, "PinholeCamera",
                            "An ideal pinhole camera: x right, y down, z forward. Image positions are in pixels;\n"
                            "the centre of the top-left pixel is (0, 0).")
      .def(
          "__init__",
          [](PinholeCamera* self, double fx, double fy, double cx, double cy, int width, int height) {
            new (self) PinholeCamera{fx, fy, cx, cy, width, height};
          },
          "fx"_a, "fy"_a, "cx"_a, "cy"_a, "width"_a, "height"_a, "All in pixels.")
      .def_rw("fx", &PinholeCamera::fx, "Focal length along x [px].")
      .def_rw("fy", &PinholeCamera::fy, "Focal length along y [px].")
      .def_rw("cx", &PinholeCamera::cx, "Principal point, x [px].")
      .def_rw("cy", &PinholeCamera::cy, "Principal point, y [px].")
      .def_rw("width", &PinholeCamera::width, "Image width [px].")
      .def_rw("height", &PinholeCamera::height, "Image height [px].")
      .def_prop_ro(
          "matrix", [](const PinholeCamera& self) { return copy_of_matrix(self.matrix()); }, kOwned,
          "(3, 3) float64: intrinsic matrix K.")
      .def("__repr__", [](const PinholeCamera& self) {
        return "<PinholeCamera " + std::to_string(self.width) + "x" + std::to_string(self.height) + ", fx " +
               std::to_string(self.fx) + " px>";
      });
}

StereoRig rig_from_file(nb::handle files, double fov, nb::handle mask, const std::optional<std::pair<int, int>>& size,
                        int max_value, bool rectified) {
  StereoCalibration calibration = read_calibration(files_of(files), rectified);
  for (const StereoCalibration& other : std::exchange(calibration.other_sizes, {})) {
    const PinholeCamera& camera = other.left.camera;
    if (size && camera.width == size->first && camera.height == size->second) calibration = other;
  }
  for (PinholeCamera* camera : {&calibration.left.camera, &calibration.right.camera}) {
    if (!size || camera->width > 0) continue;
    camera->width = size->first;
    camera->height = size->second;
  }
  const PinholeCamera& left = calibration.left.camera;
  if (size && (left.width != size->first || left.height != size->second))
    throw DataError("size: found " + std::to_string(size->first) + " x " + std::to_string(size->second) +
                    " pixels, expected " + std::to_string(left.width) + " x " + std::to_string(left.height) + ", as " +
                    calibration.files + " says");
  StereoRig rig = make_rig(calibration, fov);
  if (!mask.is_none()) mask_rig(rig, files_of(mask));
  rig.max_value = max_value;
  return rig;
}

// LONG: a line per member.
void bind_rig(nb::module_& module) {
  nb::class_<StereoRig>(module, "Rig",
                        "Two rigidly mounted cameras. The images need neither be rectified nor be of equal size.")
      .def(
          "__init__",
          [](StereoRig* self, const PinholeCamera& left, const PinholeCamera& right, const nb::object& right_from_left,
             int max_value) {
            StereoRig made;
            made.left = left;
            made.right = right;
            made.right_from_left = transform_from(right_from_left, "right_from_left");
            made.max_value = max_value;
            check_rig(made, "stereo rig");
            new (self) StereoRig(std::move(made));
          },
          nb::sig("def __init__(self, left: PinholeCamera, right: PinholeCamera, right_from_left: "
                  "numpy.typing.ArrayLike, max_value: int = 255) -> None"),
          "left"_a, "right"_a, "right_from_left"_a, "max_value"_a = kMaxValue8,
          "right_from_left: (4, 4), maps points from the left to the right camera frame [m]; for a rectified rig the\n"
          "identity with -baseline as the x translation.\n"
          "max_value: value of a saturated pixel: 255 for uint8 images, for example 4095 or 65535 for uint16.\n\n"
          "Raises DataError for a focal length, image size or baseline that is not positive and finite, and for a\n"
          "right_from_left that is not a rigid transform.")
      .def_static(
          "from_file", &rig_from_file, "files"_a, nb::kw_only(), "fov"_a = 0.0, "mask"_a = nb::none(),
          "size"_a = nb::none(), "max_value"_a = kMaxValue8, "rectified"_a = false,
          nb::sig(
              "def from_file(files: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike], *, fov: float = "
              "0, mask: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike] | None = None, size: "
              "tuple[int, int] | None = None, max_value: int = 255, rectified: bool = False) -> Rig"),
          "Reads a calibration in any of the formats in doc/your-own-data.md, recognised by content.\n\n"
          "files: one file, or a pair (left, right).\n"
          "fov: horizontal field of view of the pinhole images that distorted images are converted to [degrees]; 0 "
          "keeps\n"
          "the scale at the optical axis.\n"
          "mask: image file of the size of the recorded images, black where no edges are detected, or a pair.\n"
          "size: (width, height) of the recorded images [px], where the file does not specify it or has several.\n"
          "max_value: value of a saturated pixel, as in the constructor.\n"
          "rectified: the images are rectified, and the files' projection matrices P describe them.\n\n"
          "Raises DataError that names the file, the entry, what was found and what was expected.")
      .def_ro("left", &StereoRig::left, "Left pinhole camera.")
      .def_ro("right", &StereoRig::right, "Right pinhole camera.")
      .def_prop_ro(
          "right_from_left", [](const StereoRig& self) { return view_of_matrix(self.right_from_left.matrix()); }, kView,
          "(4, 4) float64: maps points from the left to the right camera frame [m].")
      .def_prop_ro("baseline", &StereoRig::baseline, "Distance between the cameras [m].")
      .def_prop_ro(
          "is_pinhole",
          [](const StereoRig& self) { return self.left_undistortion.empty() && self.right_undistortion.empty(); },
          "True if the recorded images are pinhole images, False if the odometry undistorts them.")
      .def_ro("max_value", &StereoRig::max_value, "Value of a saturated pixel.")
      .def_prop_ro("disparity_range", &StereoRig::disparity_range,
                   "Largest disparity expected [px]: from the data set's reader, or that of a point 0.5 m away.\n"
                   "Without stereo.max_disparity and stereo.min_depth the search starts with it.")
      .def("__repr__", [](const StereoRig& self) {
        return "<Rig " + std::to_string(self.left.width) + "x" + std::to_string(self.left.height) + ", baseline " +
               std::to_string(self.baseline()) + " m>";
      });
}

}  // namespace

std::string files_of(nb::handle files) {
  if (files.is_none()) return {};
  const nb::object fspath = nb::module_::import_("os").attr("fspath");
  if (!nb::isinstance<nb::list>(files) && !nb::isinstance<nb::tuple>(files))
    return nb::cast<std::string>(nb::str(fspath(files)));
  std::string both;
  for (const auto& file : files) both += (both.empty() ? "" : ",") + nb::cast<std::string>(nb::str(fspath(file)));
  return both;
}

StereoRig rig_of(nb::handle source) {
  if (const StereoRig* rig = nullptr; nb::try_cast(source, rig) && rig != nullptr) {
    return *rig;
  }
  if (const Dataset* dataset = nullptr; nb::try_cast(source, dataset) && dataset != nullptr) {
    return dataset->rig;
  }
  if (const RenderedSequence* sequence = nullptr; nb::try_cast(source, sequence) && sequence != nullptr) {
    return sequence->rig();
  }
  const std::string found = source.is_none() ? "None" : nb::cast<std::string>(nb::str(source.type().attr("__name__")));
  throw nb::type_error(("found " + found + ", expected a Rig, a Dataset or a Synthetic").c_str());
}

void bind_cameras(nb::module_& module) {
  bind_camera(module);
  bind_rig(module);
}

}  // namespace quadedge::python
