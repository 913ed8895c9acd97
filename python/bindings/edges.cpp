/// \file edges.cpp  Edges, StereoEdges and Quads for Python; detect_edges() and match() for single images.
#include "edges.hpp"

#include <nanobind/stl/string.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/match_stereo.hpp"
#include "quadedge/odometry.hpp"

namespace quadedge::python {
namespace {

void bind_edge_set(nb::module_& module) {
  nb::class_<EdgeSet>(module, "Edges", "Third-order edges of one image in scan order. All arrays are (N,) float32.")
      .def("__len__", &EdgeSet::size)
      .def_prop_ro("x", view_of<EdgeSet>(&EdgeSet::x), kView, "Position, to the right [px].")
      .def_prop_ro("y", view_of<EdgeSet>(&EdgeSet::y), kView, "Position, downwards [px].")
      .def_prop_ro("direction", view_of<EdgeSet>(&EdgeSet::direction), kView,
                   "Direction of the tangent [rad], in (-pi, pi]; the bright side lies towards (-sin, cos).")
      .def_prop_ro("strength", view_of<EdgeSet>(&EdgeSet::strength), kView,
                   "Gradient magnitude at the edge [grey levels per px].")
      .def("__repr__", [](const EdgeSet& self) { return "<" + std::to_string(self.size()) + " Edges>"; });
}

void bind_stereo_edges(nb::module_& module) {
  using Self = StereoEdgesInSpace;
  nb::class_<Self>(
      module, "StereoEdges",
      "N edges matched between the left and right image, in scan order of the left image. Image positions\n"
      "refer to the pinhole images of ``Odometry.rig``.")
      .def("__len__", &Self::size)
      .def_prop_ro(
          "xyz", [](const Self& self) { return view_of_columns(self.points.position); }, kView,
          "(N, 3) float64: position in the left camera frame (x right, y down, z forward) [m]; NaN without a depth.")
      .def_prop_ro(
          "direction", [](const Self& self) { return view_of_columns(self.points.tangent); }, kView,
          "(N, 3) float64: unit tangent in the left camera frame; NaN where ``xyz`` is.")
      .def_prop_ro("left", pairs_of<Self>(&Self::left_x, &Self::left_y), kOwned,
                   "(N, 2) float32: detected position in the left image [px]; a copy.")
      .def_prop_ro("right", pairs_of<Self>(&Self::right_x, &Self::right_y), kOwned,
                   "(N, 2) float32: refined position in the right image [px]; a copy.")
      .def_prop_ro("left_index", view_of<Self>(&Self::left_index), kView, "(N,) int32: index of the left edge.")
      .def_prop_ro("right_index", view_of<Self>(&Self::right_index), kView,
                   "(N,) int32: index of the right edge; neighbours may share it.")
      .def_prop_ro("left_direction", view_of<Self>(&Self::left_direction), kView,
                   "(N,) float32: direction of the tangent in the left image [rad].")
      .def_prop_ro("right_direction", view_of<Self>(&Self::right_direction), kView,
                   "(N,) float32: direction of the tangent in the right image [rad].")
      .def_prop_ro("ncc", view_of<Self>(&Self::ncc), kView,
                   "(N,) float32: normalised cross-correlation of the patches, at most 1.")
      .def("__repr__", [](const Self& self) { return "<" + std::to_string(self.size()) + " StereoEdges>"; });
}

void bind_quads(nb::module_& module) {
  nb::class_<Quads>(module, "Quads", "M matches between the stereo edges of two frames.")
      .def("__len__", &Quads::size)
      .def_prop_ro("previous", view_of<Quads>(&Quads::previous), kView,
                   "(M,) int32: indices into the stereo edges of the earlier frame.")
      .def_prop_ro("current", view_of<Quads>(&Quads::current), kView,
                   "(M,) int32: indices into the stereo edges of this frame.")
      .def_prop_ro("left", pairs_of<Quads>(&Quads::left_x, &Quads::left_y), kOwned,
                   "(M, 2) float32: position in the left image [px]; a copy.")
      .def_prop_ro("right", pairs_of<Quads>(&Quads::right_x, &Quads::right_y), kOwned,
                   "(M, 2) float32: position in the right image [px]; a copy.")
      .def_prop_ro("competing_clusters", view_of<Quads>(&Quads::competing_clusters), kView,
                   "(M,) int32: further clusters of the earlier edge's candidates; 0: unambiguous.")
      .def_prop_ro(
          "inlier", [](const Quads& self) { return ArrayView<bool>(self.inlier.data(), {self.inlier.size()}); }, kView,
          "(M,) bool: True if the quad agrees with the estimated motion.")
      .def_prop_ro("ncc", view_of<Quads>(&Quads::ncc), kView,
                   "(M,) float32: normalised cross-correlation of the patches, at most 1.")
      .def("__repr__", [](const Quads& self) { return "<" + std::to_string(self.size()) + " Quads>"; });
}

EdgeSet detect(nb::handle image, nb::handle device, const std::string& preset, nb::handle config, int max_value) {
  const ImageArgument argument(image, "the image", max_value);
  const Config constants = make_config(preset, config);
  return DeviceArgument(device).run([&](Device& chosen) { return detect_edges(argument.view(), chosen, constants); });
}

StereoEdgesInSpace match(nb::handle left, nb::handle right, nb::handle source, nb::handle device,
                         const std::string& preset, nb::handle config) {
  const StereoRig rig = rig_of(source);
  const Config constants = make_config(preset, config);
  const int max_value = max_value_of(rig);
  const ImageArgument left_image(left, "the left image", max_value), right_image(right, "the right image", max_value);
  return DeviceArgument(device).run([&](Device& chosen) {
    StereoOdometry odometry(rig, chosen, constants);
    odometry.track({0, left_image.view(), right_image.view()});
    StereoEdgesInSpace found{odometry.details().stereo, {}};
    found.points = edge_points(found, odometry.rig());
    return found;
  });
}

}  // namespace

void bind_edges(nb::module_& module) {
  bind_edge_set(module);
  bind_stereo_edges(module);
  bind_quads(module);
  module.def("detect_edges", &detect, "image"_a.none(), nb::arg("device").none() = "auto", "preset"_a = "default",
             "config"_a = nb::none(), "max_value"_a = kMaxValue16,
             nb::sig("def detect_edges(image: numpy.typing.NDArray, device: str | int | Device = 'auto', preset: str = "
                     "'default', config: dict | str | os.PathLike | None = None, max_value: int = 65535) -> Edges"),
             "Detects the third-order edges of one pinhole image.\n\n"
             "image: grey image, (height, width) or (height, width, 1), uint8 or uint16.\n"
             "max_value: value of a saturated pixel of a uint16 image.\n"
             "device, preset, config: as in Odometry; device may also be a Device.\n\n"
             "Raises TypeError for anything but an array of uint8 or uint16, DataError for an array of another shape,\n"
             "DeviceError, and UsageError for an invalid configuration.");
  module.def("match", &match, "left"_a.none(), "right"_a.none(), "rig"_a.none(), nb::arg("device").none() = "auto",
             "preset"_a = "default", "config"_a = nb::none(),
             nb::sig("def match(left: numpy.typing.NDArray, right: numpy.typing.NDArray, rig: Rig | Dataset | "
                     "Synthetic, device: str | int | Device = 'auto', preset: str = 'default', config: dict | str | "
                     "os.PathLike | None = None) -> StereoEdges"),
             "Matches the edges of one stereo pair and triangulates them.\n\n"
             "left, right: as in Odometry.track(). rig, device, preset, config: as in Odometry; device may also be a\n"
             "Device. Raises the same errors.");
}

}  // namespace quadedge::python
