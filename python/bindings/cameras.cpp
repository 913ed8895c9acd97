#include "cameras.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "quadedge/calibration.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"
#include "synthetic.hpp"

namespace quadedge::python {
namespace {

void bind_camera(nb::module_& module) {
  nb::class_<PinholeCamera>(module, "PinholeCamera",
                            "An ideal pinhole camera. Pixel centres at integers, x right, y down; all in pixels.")
      .def(
          "__init__",
          [](PinholeCamera* self, double fx, double fy, double cx, double cy, int width, int height) {
            new (self) PinholeCamera{fx, fy, cx, cy, width, height};
          },
          "fx"_a, "fy"_a, "cx"_a, "cy"_a, "width"_a, "height"_a)
      .def_rw("fx", &PinholeCamera::fx, "Focal length along x [px].")
      .def_rw("fy", &PinholeCamera::fy, "Focal length along y [px].")
      .def_rw("cx", &PinholeCamera::cx, "Principal point, x [px].")
      .def_rw("cy", &PinholeCamera::cy, "Principal point, y [px].")
      .def_rw("width", &PinholeCamera::width, "Of the images [px].")
      .def_rw("height", &PinholeCamera::height, "Of the images [px].")
      .def_prop_ro(
          "matrix", [](const PinholeCamera& camera) { return copy_of_matrix(camera.matrix()); }, kOwned,
          "Intrinsic matrix K, (3, 3).")
      .def("__repr__", [](const PinholeCamera& camera) {
        return "<PinholeCamera " + std::to_string(camera.width) + "x" + std::to_string(camera.height) + ", fx " +
               std::to_string(camera.fx) + " px>";
      });
}

/// A path, or two as the library takes them. \throws TypeError.
std::string files_of(nb::handle files) {
  const nb::object fspath = nb::module_::import_("os").attr("fspath");
  if (!nb::isinstance<nb::list>(files) && !nb::isinstance<nb::tuple>(files))
    return nb::cast<std::string>(nb::str(fspath(files)));
  std::string both;
  for (const auto& file : files) both += (both.empty() ? "" : ",") + nb::cast<std::string>(nb::str(fspath(file)));
  return both;
}

StereoRig rig_from_file(nb::handle files, double fov, nb::handle mask, const std::optional<std::pair<int, int>>& size,
                        int max_value) {
  StereoCalibration calibration = read_calibration(files_of(files));
  for (PinholeCamera* camera : {&calibration.left.camera, &calibration.right.camera}) {
    if (!size || camera->width > 0) continue;
    camera->width = size->first;
    camera->height = size->second;
  }
  StereoRig rig = make_rig(calibration, fov);
  if (!mask.is_none()) mask_rig(rig, files_of(mask));
  rig.max_value = max_value;
  return rig;
}

void bind_rig(nb::module_& module) {
  nb::class_<StereoRig>(module, "Rig",
                        "Two cameras fixed to one another. Images of different sizes are allowed, nothing needs to be\n"
                        "rectified.")
      .def(
          "__init__",
          [](StereoRig* self, const PinholeCamera& left, const PinholeCamera& right, const nb::object& right_from_left,
             int max_value) {
            StereoRig rig;
            rig.left = left;
            rig.right = right;
            rig.right_from_left = transform_from(right_from_left, "right_from_left");
            rig.max_value = max_value;
            check_rig(rig, "stereo rig");
            new (self) StereoRig(std::move(rig));
          },
          nb::sig("def __init__(self, left: PinholeCamera, right: PinholeCamera, right_from_left: "
                  "numpy.typing.ArrayLike, max_value: int = 255) -> None"),
          "left"_a, "right"_a, "right_from_left"_a, "max_value"_a = kMaxValue8,
          "right_from_left: (4, 4), a point in the right camera's frame from one in the left camera's [m]; of a\n"
          "rectified rig the identity with -baseline in its first row.\n"
          "max_value: value of a saturated pixel: 255, or 4095, 65535 ... for images of uint16.\n\n"
          "Raises DataError for a focal length, size or baseline that no camera has.")
      .def_static(
          "from_file", &rig_from_file, "files"_a, nb::kw_only(), "fov"_a = 0.0, "mask"_a = nb::none(),
          "size"_a = nb::none(), "max_value"_a = kMaxValue8,
          nb::sig(
              "def from_file(files: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike], *, fov: float = "
              "0, mask: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike] | None = None, size: "
              "tuple[int, int] | None = None, max_value: int = 255) -> Rig"),
          "Reads a calibration: Kalibr, OpenCV, ROS (camera_info), EuRoC or the native format, told by the content.\n\n"
          "files: one file, or a pair, left and right. fov: horizontal field of view of the pinhole images that "
          "distorted\n"
          "ones are turned into [degrees]; 0: the scale at the optical axis is kept. mask: image file as large as the\n"
          "recorded images, black where no edges are looked for, or a pair. size: (width, height) of the recorded "
          "images\n"
          "where the file leaves it open. max_value: see above.\n\n"
          "Raises DataError that names file, entry, what was found and what was expected.")
      .def_ro("left", &StereoRig::left)
      .def_ro("right", &StereoRig::right)
      .def_prop_ro(
          "right_from_left", [](const StereoRig& rig) { return view_of_matrix(rig.right_from_left.matrix()); }, kView,
          "(4, 4), a point in the right camera's frame from one in the left camera's [m].")
      .def_prop_ro("baseline", &StereoRig::baseline, "Distance of the cameras [m].")
      .def_ro("max_value", &StereoRig::max_value, "Value of a saturated pixel.")
      .def("__repr__", [](const StereoRig& rig) {
        return "<Rig " + std::to_string(rig.left.width) + "x" + std::to_string(rig.left.height) + ", baseline " +
               std::to_string(rig.baseline()) + " m>";
      });
}

}  // namespace

Cameras cameras_of(nb::handle source) {
  if (const StereoRig* rig = nullptr; nb::try_cast(source, rig) && rig != nullptr) {
    return {*rig, default_max_disparity(*rig)};
  }
  if (const Dataset* dataset = nullptr; nb::try_cast(source, dataset) && dataset != nullptr) {
    return {dataset->rig, dataset->max_disparity};
  }
  if (const RenderedSequence* sequence = nullptr; nb::try_cast(source, sequence) && sequence != nullptr) {
    return {sequence->rig(), sequence->max_disparity()};
  }
  const std::string found = source.is_none() ? "None" : nb::cast<std::string>(nb::str(source.type().attr("__name__")));
  throw nb::type_error(("found " + found + ", expected a Rig, a Dataset or a Synthetic").c_str());
}

void complete(Config& config, const Cameras& cameras) {
  if (config.stereo.max_disparity == 0 && config.stereo.min_depth == 0)
    config.stereo.max_disparity = cameras.max_disparity;
}

void bind_cameras(nb::module_& module) {
  bind_camera(module);
  bind_rig(module);
}

}  // namespace quadedge::python
