/// \file maps.cpp  Saved maps, and frames located in them (include/quadedge/localiser.hpp).

#include <filesystem>
#include <memory>
#include <mutex>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arguments.hpp"
#include "arrays.hpp"
#include "quadedge/error.hpp"
#include "quadedge/localiser.hpp"

namespace quadedge::python {
namespace {

/// A saved map with a device that locates frames in it. Calls from several threads are serialised.
class LoadedMap {
 public:
  LoadedMap(const std::filesystem::path& path, nb::handle rig, const std::string& device, const Config& config,
            bool follow)
      : LoadedMap(read(path), rig, device, config, follow) {}

  Localisation localise(nb::handle left, nb::handle right, std::int64_t stamp_ns, nb::handle left_mask,
                        nb::handle right_mask) {
    const ImageArgument left_image(left, "the left image", max_value_of(rig_));
    const ImageArgument right_image(right, "the right image", max_value_of(rig_));
    const ImageArgument hides_left = ImageArgument::mask(left_mask, "left_mask");
    const ImageArgument hides_right = ImageArgument::mask(right_mask, "right_mask");
    const ReleasedGil released;
    const std::lock_guard<std::mutex> alone(in_use_);
    return localiser_->locate({stamp_ns, left_image.view(), right_image.view(), hides_left.view(), hides_right.view()});
  }
  const StereoRig& rig() const { return rig_; }
  const StereoRig& map_rig() const { return map_.rig(); }
  std::size_t key_rigs() const { return map_.key_rigs(); }

 private:
  LoadedMap(SavedMap map, nb::handle rig, const std::string& device, const Config& config, bool follow)
      : map_(std::move(map)), rig_(rig.is_none() ? map_.rig() : rig_of(rig)) {
    if (rig.is_none() && map_.is_undistorted())
      throw UsageError("the images of the map had lens distortion: expected rig=, the cameras of the frames to locate");
    const ReleasedGil released;
    device_ = std::make_unique<Device>(device);
    localiser_ = std::make_unique<Localiser>(map_, rig_, *device_, config, follow);
  }
  static SavedMap read(const std::filesystem::path& path) {
    const ReleasedGil released;
    return read_map(path.string());
  }

  SavedMap map_;
  StereoRig rig_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Localiser> localiser_;
  std::mutex in_use_;
};

void bind_localisation(nb::module_& module) {
  using Self = Localisation;
  nb::class_<Self> result(module, "Localisation", "Where a frame was taken, or why that is unknown.");
  result.def_ro("stamp_ns", &Self::stamp_ns, "Time stamp of the frame [ns].")
      .def_prop_ro(
          "status", [](const Self& self) { return to_string(self.status); },
          "located, lost_too_few_edges, lost_rig_mismatch, lost_unknown_place or lost_ambiguous.")
      .def_ro("key_rig", &Self::key_rig,
              "Number of the frame of the map's recording that it was located against; -1 for a lost frame.")
      .def_ro("inliers", &Self::inliers, "Quads with that keyframe that agree with the pose.")
      .def_ro("support", &Self::support, "Inliers divided by the kept edges that the pose brings into view, 0 to 1.")
      .def_ro("is_followed", &Self::is_followed, "True if it was found near the prediction from the frames before.")
      .def_ro("message", &Self::message, "Why the frame is lost, in one sentence; else empty.")
      .def_ro("warnings", &Self::warnings, "List of FrameWarning, as FrameResult.warnings.")
      .def_ro("latency_ms", &Self::latency_ms, "Time from the images in memory to the pose [ms].")
      .def("__repr__", [](const Self& self) { return std::string("<Localisation: ") + to_string(self.status) + ">"; });
  def_optional(
      result, "map_from_left", &Self::map_from_left,
      "(4, 4) float64: pose of the left camera in the frame of the map [m], which is the left camera frame of\n"
      "the first frame of the map's recording or of its largest segment. None for a lost frame.");
  def_optional(
      result, "covariance", &Self::covariance,
      "(6, 6) float64: covariance of ``map_from_left`` in the convention of ROS's PoseWithCovariance; the pose\n"
      "of the keyframe counts as exact. None for a lost frame.");
}

}  // namespace

void bind_maps(nb::module_& module) {
  bind_localisation(module);
  nb::class_<LoadedMap>(module, "Map",
                        "The places of a recording, saved by Odometry.save_map() or ``quadedge run --save-map``, for\n"
                        "locating other frames in them.")
      .def_static(
          "load",
          [](const std::filesystem::path& path, nb::handle rig, nb::handle device, const std::string& preset,
             nb::handle config, bool follow) {
            return new LoadedMap(path, rig, device_choice(device), make_config(preset, config), follow);
          },
          nb::rv_policy::take_ownership, "path"_a, "rig"_a = nb::none(), nb::arg("device").none() = "auto",
          "preset"_a = "default", "config"_a = nb::none(), "follow"_a = false,
          nb::sig("def load(path: str | os.PathLike, rig: Rig | Dataset | Synthetic | None = None, device: str | int = "
                  "'auto', preset: str = 'default', config: dict | str | os.PathLike | None = None, follow: bool = "
                  "False) -> Map"),
          "Reads a map and prepares the device.\n\n"
          "rig: the cameras of the frames to locate; None: the map's own, if their images had no lens "
          "distortion.\n"
          "Other cameras than the map's may be given.\n"
          "follow: after two located frames, search near the prediction from them first; otherwise every frame is\n"
          "located by itself.\n"
          "device, preset, config: as for Odometry.\n\n"
          "Raises DataError for a file that is missing, damaged or of another version, UsageError for a configuration\n"
          "whose edges differ from the map's or cameras that have to be given, and what Odometry() raises.")
      .def("localise", &LoadedMap::localise, "left"_a.none(), "right"_a.none(), "stamp_ns"_a = 0,
           "left_mask"_a.none() = nb::none(), "right_mask"_a.none() = nb::none(),
           nb::sig("def localise(self, left: numpy.typing.NDArray, right: numpy.typing.NDArray, stamp_ns: int = 0, "
                   "left_mask: numpy.typing.NDArray | None = None, right_mask: numpy.typing.NDArray | None = None) -> "
                   "Localisation"),
           "Locates one frame. Releases the GIL.\n\n"
           "left, right: grey images as recorded, and masks of this frame, as for Odometry.track(). stamp_ns: copied\n"
           "to the result [ns].\n\n"
           "A frame that cannot be located has ``map_from_left`` None, and ``status`` and ``message`` say why. Raises\n"
           "TypeError, DataError and DeviceError as Odometry.track().")
      .def_prop_ro("key_rigs", &LoadedMap::key_rigs, "Number of keyframes in the map.")
      .def_prop_ro("rig", &LoadedMap::rig, kView, "The Rig of the frames to locate.")
      .def_prop_ro("map_rig", &LoadedMap::map_rig, kView, "The pinhole cameras that recorded the map.")
      .def("__len__", &LoadedMap::key_rigs)
      .def("__repr__",
           [](const LoadedMap& self) { return "<Map, keyframes: " + std::to_string(self.key_rigs()) + ">"; });
}

}  // namespace quadedge::python
