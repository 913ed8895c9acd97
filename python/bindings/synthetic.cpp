/// \file synthetic.cpp  The built-in rendered sequences (include/quadedge/synthetic.hpp).

#include <nanobind/stl/string.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/dataset.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

int checked(const RenderedSequence& self, int frame) {
  if (frame < 0) frame += self.frames();
  if (frame < 0 || frame >= self.frames()) throw nb::index_error("no such frame");
  return frame;
}

FramePrefetcher::Frame render(const RenderedSequence& self, int frame) {
  frame = checked(self, frame);
  const ReleasedGil released;
  return self.pair(frame);
}

nb::object depth(const RenderedSequence& self, int frame, const std::string& side) {
  frame = checked(self, frame);
  if (side != "left" && side != "right") throw UsageError("side is '" + side + "'; allowed: left, right");
  auto* view = new RenderedView;
  const nb::capsule owner(view, [](void* pointer) noexcept { delete static_cast<RenderedView*>(pointer); });
  {
    const ReleasedGil released;
    *view = self.render(frame, side == "left" ? Side::left : Side::right);
  }
  return nb::cast(ArrayView<float>(
      view->depth.data(), {static_cast<std::size_t>(view->image.height), static_cast<std::size_t>(view->image.width)},
      owner));
}

Trajectory truth(const RenderedSequence& self) {
  Trajectory poses;
  for (int i = 0; i < self.frames(); ++i) poses.push_back({self.stamp_ns(i), self.world_from_left(i)});
  return poses;
}

}  // namespace

void bind_synthetic(nb::module_& module) {
  nb::class_<RenderedSequence>(module, "Synthetic",
                               "A rendered sequence with exact poses and depths; created by ``synthetic()``.\n\n"
                               "Indexing and iterating render Frames. The same options give the same bytes.")
      .def_prop_ro("name", &RenderedSequence::name)
      .def_prop_ro("rig", &RenderedSequence::rig, kView)
      .def_prop_ro("truth", &truth, "Exact poses of the left camera, a Trajectory.")
      .def("__len__", &RenderedSequence::frames)
      .def("__getitem__", &render, "frame"_a)
      .def("depth", &depth, "frame"_a, "side"_a = "left",
           nb::sig("def depth(self, frame: int, side: str = 'left') -> numpy.typing.NDArray"),
           "(height, width) float32: depth (z coordinate) at the centre of each pixel [m], in the camera frame of "
           "``side``,\n"
           "\"left\" or \"right\". Raises IndexError for a frame that does not exist.")
      .def("__repr__", [](const RenderedSequence& self) {
        return "<Synthetic " + self.name() + ": " + std::to_string(self.frames()) + " frames>";
      });

  const SyntheticOptions defaults;
  module.def(
      "synthetic",
      [](const std::string& scene, const std::string& path, int frames, int width, int height, double noise,
         double blur, double mover, int bits, std::uint64_t seed) {
        SyntheticOptions options;
        options.focal *= static_cast<double>(width) / options.width;  // keeps the field of view
        options.scene = scene;
        options.path = path;
        options.frames = frames;
        options.width = width;
        options.height = height;
        options.noise = noise;
        options.blur = blur;
        options.mover = mover;
        options.bits = bits;
        options.seed = seed;
        return new RenderedSequence(options);
      },
      nb::rv_policy::take_ownership, "scene"_a = defaults.scene, "path"_a = defaults.path, "frames"_a = defaults.frames,
      "width"_a = defaults.width, "height"_a = defaults.height, "noise"_a = defaults.noise, "blur"_a = defaults.blur,
      "mover"_a = defaults.mover, "bits"_a = defaults.bits, "seed"_a = defaults.seed,
      "Creates a rendered sequence with exact poses and depths.\n\n"
      "scene: \"room\", \"cables\", \"facade\" or \"yard\".\n"
      "path: \"ellipse\", \"handheld\", \"drive\" or \"loop\".\n"
      "width, height: image size [px]. noise: standard deviation of the image noise [grey levels].\n"
      "blur: motion blur, averaged over the path [px]. mover: share of the left image covered by an independently\n"
      "moving board, 0 to 0.6. bits: bits per pixel, 8, 12 or 16.\n\n"
      "Raises UsageError that names the option, its value and the allowed values.");
}

}  // namespace quadedge::python
