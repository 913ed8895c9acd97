/// \file datasets.cpp  Recorded sequences (include/quadedge/dataset.hpp).

#include <filesystem>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "images.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/decode_image.hpp"
#include "trajectories.hpp"

namespace quadedge::python {
namespace {

void bind_frames(nb::module_& module) {
  nb::class_<FrameFiles>(module, "FrameFiles", "Files of one stereo frame.")
      .def_ro("stamp_ns", &FrameFiles::stamp_ns)
      .def_ro("left", &FrameFiles::left)
      .def_ro("right", &FrameFiles::right);

  using Frame = FramePrefetcher::Frame;
  nb::class_<Frame>(module, "Frame", "The two images of one time.")
      .def_ro("number", &Frame::number, "Place in the sequence, from 0.")
      .def_ro("stamp_ns", &Frame::stamp_ns)
      .def_prop_ro(
          "left", [](nb::handle_t<Frame> self) { return pixels_of(nb::cast<const Frame&>(self).left, self); },
          nb::sig("def left(self) -> numpy.typing.NDArray"), "(height, width), uint8 or uint16.")
      .def_prop_ro(
          "right", [](nb::handle_t<Frame> self) { return pixels_of(nb::cast<const Frame&>(self).right, self); },
          nb::sig("def right(self) -> numpy.typing.NDArray"), "(height, width), uint8 or uint16.");

  nb::class_<FramePrefetcher>(module, "FrameIterator", "Frames of a Dataset in order, read ahead on another thread.")
      .def("__iter__", [](nb::handle self) { return nb::borrow(self); })
      .def("__next__", [](FramePrefetcher& self) {
        std::optional<Frame> frame;
        {
          const nb::gil_scoped_release released;
          frame = self.next();
        }
        if (!frame) throw nb::stop_iteration();
        return std::move(*frame);
      });
}

void bind_dataset(nb::module_& module) {
  nb::class_<Dataset>(module, "Dataset",
                      "A recorded sequence or pair: calibration, frames, and how far disparities reach.\n\n"
                      "Iterating yields a Frame per frame, decoded ahead; a damaged image raises DataError there.")
      .def_ro("format", &Dataset::format, "Layout: kitti, euroc, eth3d-slam ...")
      .def_ro("path", &Dataset::path)
      .def_ro("name", &Dataset::name)
      .def_ro("rig", &Dataset::rig)
      .def_ro("frames", &Dataset::frames, "A FrameFiles per frame.")
      .def_ro("max_disparity", &Dataset::max_disparity, "Largest disparity that this kind of data holds [px].")
      .def_ro("truth", &Dataset::truth, "Ground truth of the left camera's poses; empty when there is none.")
      .def_ro("truth_file", &Dataset::truth_file)
      .def_ro("notes", &Dataset::notes, "What a user should know of this data.")
      .def("__len__", [](const Dataset& self) { return self.frames.size(); })
      .def(
          "__iter__", [](const Dataset& self) { return new FramePrefetcher(self); }, nb::rv_policy::take_ownership,
          nb::keep_alive<0, 1>())
      .def("__repr__", [](const Dataset& self) {
        return "<Dataset " + self.name + ": " + self.format + ", " + std::to_string(self.frames.size()) + " frames>";
      });

  module.def(
      "open_dataset",
      [](const std::filesystem::path& path, const std::string& sequence, const std::string& format, int first_frame,
         int last_frame) {
        DatasetOptions options;
        options.format = format;
        options.sequence = sequence;
        options.first_frame = first_frame;
        options.last_frame = last_frame;
        const nb::gil_scoped_release released;
        return open_dataset(path.string(), options);
      },
      "path"_a, "sequence"_a = "", "format"_a = "auto", "first_frame"_a = 0, "last_frame"_a = -1,
      "Recognises the layout of a recording and reads calibration, list of frames and ground truth.\n\n"
      "sequence: KITTI: which one, when ``path`` holds several. format: \"auto\" or one of ``dataset_formats()``.\n"
      "first_frame, last_frame: half-open range; -1: to the end.\n\n"
      "Raises DataError naming the file, what was found and what was expected.");
  module.def("dataset_formats", &dataset_formats, "What ``format=`` takes besides \"auto\".");
}

}  // namespace

void bind_datasets(nb::module_& module) {
  bind_frames(module);
  bind_dataset(module);
  module.def(
      "decode_grey_image",
      [](const nb::bytes& bytes, const std::string& name) {
        auto* image = new Image;
        const nb::capsule owner(image, [](void* pointer) noexcept { delete static_cast<Image*>(pointer); });
        {
          const nb::gil_scoped_release released;
          *image = decode_grey_image({bytes.c_str(), bytes.size()}, name);
        }
        return pixels_of(*image, owner);
      },
      "data"_a, "name"_a = "the image",
      nb::sig("def decode_grey_image(data: bytes, name: str = 'the image') -> "
              "numpy.typing.NDArray"),
      "The same of a PNG, JPEG, PGM or PPM in memory, which complaints call ``name``.");
  module.def(
      "read_grey_image",
      [](const std::filesystem::path& path) {
        auto* image = new Image;
        const nb::capsule owner(image, [](void* pointer) noexcept { delete static_cast<Image*>(pointer); });
        {
          const nb::gil_scoped_release released;
          *image = read_grey_image(path.string());
        }
        return pixels_of(*image, owner);
      },
      "path"_a, nb::sig("def read_grey_image(path: str | os.PathLike) -> numpy.typing.NDArray"),
      "One grey image at its full depth, (height, width), uint8 or uint16; colour becomes luminance.\n\n"
      "Raises DataError for a missing, truncated or undecodable file.");
}

}  // namespace quadedge::python
