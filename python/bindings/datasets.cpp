/// \file datasets.cpp  Recorded sequences (include/quadedge/dataset.hpp).

#include <filesystem>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/image.hpp"
#include "quadedge/stereo_source.hpp"

namespace quadedge::python {
namespace {

void bind_frames(nb::module_& module) {
  nb::class_<FrameFiles>(module, "FrameFiles", "The image files of one stereo frame.")
      .def_ro("stamp_ns", &FrameFiles::stamp_ns, "Time stamp [ns].")
      .def_ro("left", &FrameFiles::left, "Path of the left image.")
      .def_ro("right", &FrameFiles::right, "Path of the right image.");

  using Frame = FramePrefetcher::Frame;
  nb::class_<Frame>(module, "Frame", "A stereo frame: two images taken at the same time.")
      .def_ro("number", &Frame::number, "Position in the sequence, counted from 0.")
      .def_ro("stamp_ns", &Frame::stamp_ns, "Time stamp [ns].")
      .def_prop_ro(
          "left", [](nb::handle_t<Frame> self) { return pixels_of(nb::cast<const Frame&>(self).left, self); },
          nb::sig("def left(self) -> numpy.typing.NDArray"), "Left image: (height, width), uint8 or uint16.")
      .def_prop_ro(
          "right", [](nb::handle_t<Frame> self) { return pixels_of(nb::cast<const Frame&>(self).right, self); },
          nb::sig("def right(self) -> numpy.typing.NDArray"), "Right image: (height, width), uint8 or uint16.");

  nb::class_<FramePrefetcher>(module, "FrameIterator",
                              "Yields the frames of a Dataset in order, decoded ahead in another thread.")
      .def("__iter__", [](nb::handle self) { return nb::borrow(self); })
      .def("__next__", [](FramePrefetcher& self) {
        std::optional<Frame> frame;
        {
          const ReleasedGil released;
          frame = self.next();
        }
        if (!frame) throw nb::stop_iteration();
        return std::move(*frame);
      });
}

Dataset open_layout(const std::filesystem::path& path, const std::string& sequence, const std::string& format,
                    int first_frame, int last_frame, nb::handle calibration, double fov, nb::handle mask) {
  DatasetOptions options;
  options.format = format;
  options.sequence = sequence;
  options.first_frame = first_frame;
  options.last_frame = last_frame;
  options.calibration = files_of(calibration);
  options.fov = fov;
  options.mask = files_of(mask);
  const ReleasedGil released;
  return open_dataset(path.string(), options);
}

Dataset open_source(nb::handle left, nb::handle right, nb::handle video, const std::string& split,
                    nb::handle calibration, double fov, nb::handle mask, double fps, nb::handle times, int first_frame,
                    int last_frame) {
  StereoSource source;
  source.left = files_of(left);
  source.right = files_of(right);
  source.video = files_of(video);
  source.split = split;
  source.calibration = files_of(calibration);
  source.fov = fov;
  source.mask = files_of(mask);
  source.fps = fps;
  source.times = files_of(times);
  source.first_frame = first_frame;
  source.last_frame = last_frame;
  const ReleasedGil released;
  return open_stereo_source(source);
}

void bind_dataset(nb::module_& module) {
  nb::class_<Dataset>(module, "Dataset",
                      "A recorded sequence: calibration, frames and disparity range.\n\n"
                      "Iterating yields a Frame at a time, decoded ahead; a damaged image raises DataError.")
      .def_ro("format", &Dataset::format, "Layout, such as kitti, euroc or eth3d-slam; images or video.")
      .def_ro("path", &Dataset::path)
      .def_ro("name", &Dataset::name)
      .def_ro("rig", &Dataset::rig)
      .def_ro("frames", &Dataset::frames, "Image files of every frame, a list of FrameFiles.")
      .def_ro("truth", &Dataset::truth, "Ground-truth poses of the left camera; empty if there are none.")
      .def_ro("truth_file", &Dataset::truth_file, "File that the ground truth was read from.")
      .def_ro("disparity_file", &Dataset::disparity_truth,
              "Ground-truth disparities of the first left image; empty if there are none.")
      .def_ro("disparity_scale", &Dataset::disparity_truth_scale, "Pixels per unit stored in ``disparity_file``.")
      .def_ro("notes", &Dataset::notes, "Remarks on the data, such as assumed time stamps; a list of sentences.")
      .def("__len__", [](const Dataset& self) { return self.frames.size(); })
      .def(
          "__iter__", [](const Dataset& self) { return new FramePrefetcher(self); }, nb::rv_policy::take_ownership,
          nb::keep_alive<0, 1>())
      .def("__repr__", [](const Dataset& self) {
        return "<Dataset " + self.name + ": " + self.format + ", " + std::to_string(self.frames.size()) + " frames>";
      });

  module.def(
      "open_dataset", &open_layout, "path"_a, "sequence"_a = "", "format"_a = "auto", "first_frame"_a = 0,
      "last_frame"_a = -1, nb::kw_only(), "calibration"_a = nb::none(), "fov"_a = 0.0, "mask"_a = nb::none(),
      nb::sig(
          "def open_dataset(path: str | os.PathLike, sequence: str = '', format: str = 'auto', first_frame: int = 0, "
          "last_frame: int = -1, *, calibration: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike] | "
          "None = None, fov: float = 0, mask: str | os.PathLike | tuple[str | os.PathLike, str | os.PathLike] | None "
          "= None) -> Dataset"),
      "Opens a recording in a published layout: reads its calibration, list of frames and ground truth.\n\n"
      "sequence: name of the KITTI sequence, where ``path`` contains several.\n"
      "format: \"auto\" or one of ``dataset_formats()``.\n"
      "first_frame, last_frame: half-open range of frames; a last_frame of -1 means all.\n"
      "calibration, fov, mask: as in Rig.from_file(), instead of the calibration in the recording.\n\n"
      "Raises DataError that names the file, what was found and what was expected.");
  module.def(
      "open_stereo_source", &open_source, nb::kw_only(), "left"_a = nb::none(), "right"_a = nb::none(),
      "video"_a = nb::none(), "split"_a = "", "calibration"_a, "fov"_a = 0.0, "mask"_a = nb::none(), "fps"_a = 0.0,
      "times"_a = nb::none(), "first_frame"_a = 0, "last_frame"_a = -1,
      nb::sig(
          "def open_stereo_source(*, left: str | os.PathLike | None = None, right: str | os.PathLike | None = None, "
          "video: str | os.PathLike | None = None, split: str = '', calibration: str | os.PathLike | tuple[str | "
          "os.PathLike, str | os.PathLike], fov: float = 0, mask: str | os.PathLike | tuple[str | os.PathLike, str | "
          "os.PathLike] | None = None, fps: float = 0, times: str | os.PathLike | None = None, first_frame: int = 0, "
          "last_frame: int = -1) -> Dataset"),
      "Opens images or videos from your own cameras as a Dataset without ground truth.\n\n"
      "left, right: two folders of images (in natural order of their names), or two video files.\n"
      "video, split: instead, one video with both views in each picture, \"left-right\" or \"top-bottom\".\n"
      "calibration, fov, mask: as in Rig.from_file().\n"
      "fps: frames per second, for sources without time stamps. times: file of time stamps, one per line [s], or\n"
      "EuRoC's data.csv. first_frame, last_frame: half-open range of frames.\n\n"
      "Raises DataError that names the file, and UsageError for arguments that contradict one another.");
  module.def("dataset_formats", &dataset_formats, "Values of ``format=`` besides \"auto\".");
}

}  // namespace

void bind_datasets(nb::module_& module) {
  bind_frames(module);
  bind_dataset(module);
  module.def(
      "decode_grey_image",
      [](const nb::bytes& bytes, const std::string& name) {
        const std::string_view data(bytes.c_str(), bytes.size());
        return pixels_of([&] { return decode_grey_image(data, name); });
      },
      "data"_a, "name"_a = "the image",
      nb::sig("def decode_grey_image(data: bytes, name: str = 'the image') -> "
              "numpy.typing.NDArray"),
      "Decodes a PNG, JPEG, PGM or PPM in memory: (height, width), uint8 or uint16. Colour is converted to "
      "luminance.\n\n"
      "name: of the image, for messages. Raises DataError for data that is truncated or cannot be decoded.");
  module.def(
      "read_grey_image",
      [](const std::filesystem::path& path) { return pixels_of([&] { return read_grey_image(path.string()); }); },
      "path"_a, nb::sig("def read_grey_image(path: str | os.PathLike) -> numpy.typing.NDArray"),
      "Reads an image file as grey values at its full depth: (height, width), uint8 or uint16. Colour is converted to\n"
      "luminance.\n\n"
      "Raises DataError for a file that is missing, truncated or cannot be decoded.");
}

}  // namespace quadedge::python
