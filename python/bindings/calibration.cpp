/// \file calibration.cpp  Calibrations learned from recordings (include/quadedge/drive_calibration.hpp).

#include <filesystem>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/drive_calibration.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

DriveCalibration calibrate(const Dataset& dataset, int most_pairs) {
  if (most_pairs < 2) throw UsageError("most_pairs " + std::to_string(most_pairs) + ": expected 2 or more");
  const ReleasedGil released;
  DriveCalibrator calibrator(dataset.calibration.value_or(pinhole_calibration(dataset.rig)), dataset.rig, most_pairs);
  FramePrefetcher source(dataset);
  while (const auto pair = source.next()) calibrator.see(pair->view());
  return calibrator.finish();
}

}  // namespace

void bind_calibration(nb::module_& module) {
  nb::class_<LearnedNumber>(module, "LearnedNumber", "One number of a calibration, as a change of the given one.")
      .def_ro("name", &LearnedNumber::name)
      .def_ro("unit", &LearnedNumber::unit, "\"px\", \"rad\", \"baselines\", or empty for ratios and coefficients.")
      .def_ro("change", &LearnedNumber::change, "0: as given.")
      .def_ro("sigma", &LearnedNumber::sigma, "Standard deviation of the change.")
      .def_ro("prior", &LearnedNumber::prior, "Standard deviation before anything was learned.")
      .def_prop_ro("is_open", &LearnedNumber::is_open, "Whether the recording has not narrowed it down.")
      .def("__repr__", [](const LearnedNumber& self) { return "<LearnedNumber " + self.name + ">"; });

  using Self = DriveCalibration;
  nb::class_<Self>(module, "Calibration", "A calibration learned from a recording, and what speaks for it.")
      .def_prop_ro(
          "verdict", [](const Self& self) { return to_string(self.verdict); },
          "\"better\": it explains frames better that it was not learned from; \"as_good\" as the given one; or\n"
          "\"cannot_show\": too little motion or texture to tell, or each of them explains some parts better.")
      .def_prop_ro("text", &Self::text, "The judgement in a few sentences.")
      .def_ro("numbers", &Self::numbers, "What was learned, whatever the verdict: a list of LearnedNumber.")
      .def_prop_ro(
          "covariance", [](const Self& self) { return copy_of_matrix(self.covariance); }, kOwned,
          nb::sig("def covariance(self) -> numpy.typing.NDArray[numpy.float64]"),
          "(n, n) float64: covariance of ``numbers``, in their order and units.")
      .def_ro("frames", &Self::frames, "Frames seen.")
      .def_ro("pairs", &Self::pairs, "Pairs of frames that were learned from.")
      .def_ro("points", &Self::points, "Points in these.")
      .def_ro("contradiction", &Self::contradiction,
              "Chi squared of what was learned, by what the frames alone tell; ``numbers`` has the degrees of freedom.")
      .def_ro("unseen_given", &Self::unseen_given,
              "Median distances of points from where the (left, right) camera sees them, with the given calibration,\n"
              "in frames that were not learned from [px].")
      .def_ro("unseen_learned", &Self::unseen_learned, "The same with a calibration learned from other frames [px].")
      .def(
          "rig", [](const Self& self, double fov) { return make_rig(self.calibration, fov); }, "fov"_a = 0.0,
          "The rig to track with: the learned one if it is better, else the given one. fov: as in Rig.from_file().")
      .def(
          "write",
          [](const Self& self, const std::filesystem::path& path, const std::string& format) {
            write_calibration(path.string(), self.calibration, format);
          },
          "path"_a, "format"_a = "native",
          "Writes the calibration to use. format: \"native\", QuadEdge's own; \"kalibr\"; \"opencv\"; or \"ros\" with\n"
          "the path \"LEFT,RIGHT\". Rig.from_file() and the program read all of them.\n\n"
          "Raises UsageError if the format cannot hold the lenses.")
      .def("__repr__", [](const Self& self) { return std::string("<Calibration: ") + to_string(self.verdict) + ">"; });

  module.def(
      "calibrate", &calibrate, "dataset"_a, nb::kw_only(), "most_pairs"_a = 200,
      "Learns the calibration of the rig that made a recording, as `quadedge calibrate` does, but from all of its\n"
      "frames. Identical frames give identical results; no device is needed.\n\n"
      "most_pairs: pairs of frames to keep: of a longer recording so many to twice as many, evenly spread.\n\n"
      "Raises DataError for a frame that cannot be read.");
}

}  // namespace quadedge::python
