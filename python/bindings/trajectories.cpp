/// \file trajectories.cpp  Stamps, segments and poses as strided views of the rows of a trajectory.
#include <filesystem>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

using Segments = nb::ndarray<const std::int32_t, nb::ndim<1>, nb::device::cpu>;

Trajectory make_trajectory(const nb::ndarray<const std::int64_t, nb::ndim<1>, nb::device::cpu>& stamps_ns,
                           const nb::ndarray<const double, nb::ndim<3>, nb::device::cpu>& poses,
                           const std::optional<Segments>& segments) {
  if (poses.shape(0) != stamps_ns.shape(0) || poses.shape(1) != 4 || poses.shape(2) != 4) {
    throw DataError("poses: found " + std::to_string(poses.shape(0)) + " x " + std::to_string(poses.shape(1)) + " x " +
                    std::to_string(poses.shape(2)) + " numbers, expected " + std::to_string(stamps_ns.shape(0)) +
                    " x 4 x 4, one pose per stamp");
  }
  if (segments && segments->shape(0) != stamps_ns.shape(0)) {
    throw DataError("segments: found " + std::to_string(segments->shape(0)) + " numbers, expected " +
                    std::to_string(stamps_ns.shape(0)) + ", one per stamp");
  }
  Trajectory trajectory(poses.shape(0));
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const auto at = static_cast<std::int64_t>(i);
    trajectory[i].stamp_ns = stamps_ns.data()[at * stamps_ns.stride(0)];
    if (segments) trajectory[i].segment = segments->data()[at * segments->stride(0)];
    const double* pose = poses.data() + at * poses.stride(0);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        trajectory[i].world_from_left.matrix()(row, column) = pose[row * poses.stride(1) + column * poses.stride(2)];
      }
    }
  }
  check_trajectory(trajectory, "poses");
  return trajectory;
}

}  // namespace

void bind_trajectories(nb::module_& module) {
  nb::class_<Trajectory>(module, "Trajectory", "Poses of the left camera over time (world_from_left).")
      .def(
          "__init__",
          [](Trajectory* self, const nb::ndarray<const std::int64_t, nb::ndim<1>, nb::device::cpu>& stamps_ns,
             const nb::ndarray<const double, nb::ndim<3>, nb::device::cpu>& poses,
             const std::optional<Segments>& segments) {
            new (self) Trajectory(make_trajectory(stamps_ns, poses, segments));
          },
          "stamps_ns"_a, "poses"_a, "segments"_a = nb::none(),
          "stamps_ns: (N,) int64 [ns]. poses: (N, 4, 4) float64, world_from_left [m]. segments: (N,) int32, as in\n"
          "FrameResult; 0 unless given. Raises DataError for other shapes and for\n"
          "matrices that are not rigid transforms.")
      .def_static(
          "from_file", [](const std::filesystem::path& path) { return read_trajectory(path.string()); }, "path"_a,
          "Reads TUM (8 columns), KITTI (12; stamps are row numbers) or EuRoC's CSV (a data.csv: beside cam0).\n\n"
          "Raises DataError that names file, line, what was found and what was expected.")
      .def(
          "write_tum",
          [](const Trajectory& self, const std::filesystem::path& path) { write_tum(path.string(), self); }, "path"_a,
          "Writes a TUM file: ``timestamp tx ty tz qx qy qz qw`` per pose [s, m], and a comment ``# segment N`` "
          "before\n"
          "each segment after the first, byte for byte as ``quadedge run``.")
      .def(
          "write_kitti",
          [](const Trajectory& self, const std::filesystem::path& path) { write_kitti(path.string(), self); }, "path"_a,
          "Writes a KITTI file: a 3 x 4 matrix per pose, row by row [m].")
      .def("split", &split_segments,
           "A list with a Trajectory per segment: no measurement connects the poses of one with those of another.")
      .def("__len__", [](const Trajectory& self) { return self.size(); })
      .def_prop_ro(
          "stamps_ns", [](const Trajectory& self) { return view_of(self, &StampedPose::stamp_ns); }, kView,
          "(N,) int64: time stamps [ns].")
      .def_prop_ro(
          "segments", [](const Trajectory& self) { return view_of(self, &StampedPose::segment); }, kView,
          "(N,) int32: number of each pose's segment, as in FrameResult.")
      .def_prop_ro(
          "poses",
          [](const Trajectory& self) {
            static_assert(sizeof(StampedPose) % sizeof(double) == 0);
            const void* first = self.empty() ? nullptr : self.front().world_from_left.data();
            return ArrayView<double>(first, {self.size(), 4, 4}, {}, {sizeof(StampedPose) / sizeof(double), 1, 4});
          },
          kView, "(N, 4, 4) float64, world_from_left [m].")
      .def("__repr__",
           [](const Trajectory& self) { return "<Trajectory of " + std::to_string(self.size()) + " poses>"; });
}

}  // namespace quadedge::python
