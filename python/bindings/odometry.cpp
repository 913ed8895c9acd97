/// \file odometry.cpp  Stereo visual odometry (include/quadedge/odometry.hpp).

#include "quadedge/odometry.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>
#include <type_traits>

#include "arguments.hpp"
#include "arrays.hpp"
#include "edges.hpp"
#include "quadedge/error.hpp"
#include "quadedge/map.hpp"
#include "quadedge/result_files.hpp"
#include "taps.hpp"

namespace quadedge::python {
namespace {

/// The result of a frame with the state of the map, if there is one.
struct MappedResult : FrameResult {
  std::optional<Eigen::Isometry3d> map_from_odometry;
};

/// The edges and quads of one frame.
struct Details {
  EdgeSet left_edges, right_edges;
  StereoEdgesInSpace stereo, previous_stereo;
  Quads quads;
};

/// The library's odometry with its device. Calls from several threads are serialised.
class Odometry {
 public:
  Odometry(const StereoRig& rig, const std::string& device, const Config& config, bool loops)
      : max_value_(max_value_of(rig)),
        running_(std::make_unique<Running>(rig, device, config, loops)),
        config_(running_->odometry.config()),
        rig_(running_->odometry.rig()) {}

  MappedResult track(const StereoFrame& frame) {
    return alone([&](Running& running) {
      MappedResult result{running.odometry.track(frame), std::nullopt};
      if (running.map) {
        running.map->add(result);
        result.map_from_odometry = running.map->map_from_odometry();
      }
      return result;
    });
  }
  void set_tap(PythonTap* tap) {
    alone([&](Running& running) {
      if (tap != nullptr) tap->watch(running.odometry.rig());
      running.odometry.set_tap(tap);
    });
  }
  void restart() {
    alone([](Running& running) { running.odometry.restart(); });
  }
  Trajectory map_trajectory() {
    return alone([](Running& running) { return running.finished_map().trajectory(); });
  }
  void save_map(const std::filesystem::path& file) {
    alone([&](Running& running) { write_map(file.string(), running.finished_map().saved()); });
  }
  ResultFiles result_files(const std::string& folder, const ResultOrigin& origin, bool force) {
    return alone([&](Running& running) { return ResultFiles(folder, running.odometry, origin, force); });
  }
  StereoEdgesInSpace edges() {
    FrameDetails found = alone([](Running& running) { return running.odometry.details(); });
    return in_space(std::move(found.stereo), found.rig);
  }
  Details details() {
    FrameDetails found = alone([](Running& running) { return running.odometry.details(); });
    return {std::move(found.left_edges),
            std::move(found.right_edges),
            in_space(std::move(found.stereo), found.rig),
            in_space(std::move(found.previous_stereo), found.previous_rig),
            {std::move(found.quads), std::move(found.quad_inlier)}};
  }
  void close() {
    const std::lock_guard<std::mutex> lock(in_use_);
    running_.reset();
  }

  const StereoRig& rig() const { return rig_; }
  const Config& config() const { return config_; }
  int max_value() const { return max_value_; }
  DeviceInfo device() {
    const ReleasedGil released;
    return alone([](Running& running) { return running.device.info(); });
  }
  std::map<std::string, std::string> variants() {
    const ReleasedGil released;
    return alone([](Running& running) { return running.odometry.variants(); });
  }

 private:
  struct Running {
    Running(const StereoRig& rig, const std::string& choice, const Config& config, bool loops)
        : device(choice), odometry(rig, device, config) {
      if (loops) map.emplace(odometry);
    }
    Map& finished_map() {
      if (!map) throw UsageError("the odometry keeps no map: expected Odometry(rig, loops=True)");
      map->finish();
      return *map;
    }
    Device device;
    StereoOdometry odometry;
    std::optional<Map> map;
  };
  /// Runs `work(Running&)` without any other work on the device. \throws UsageError after close().
  template <class Work>
  std::invoke_result_t<const Work&, Running&> alone(const Work& work) {
    const std::lock_guard<std::mutex> lock(in_use_);
    if (!running_) throw UsageError("the odometry is closed");
    return work(*running_);
  }
  StereoEdgesInSpace in_space(StereoEdges edges, const RigEstimate& estimate) const {
    EdgePoints points = edge_points(edges, rig_, estimate);
    return {std::move(edges), std::move(points)};
  }

  int max_value_ = kMaxValue16;
  std::unique_ptr<Running> running_;
  Config config_;
  StereoRig rig_;
  std::mutex in_use_;
};

void bind_counts(nb::module_& module) {
  nb::class_<FrameCounts>(module, "FrameCounts", "Numbers of edges and quads of one frame.")
      .def_ro("edges_left", &FrameCounts::edges_left, "Edges detected in the left image.")
      .def_ro("edges_right", &FrameCounts::edges_right, "Edges detected in the right image.")
      .def_ro("stereo_edges", &FrameCounts::stereo_edges, "Edges matched between the left and the right image.")
      .def_ro("temporal_left", &FrameCounts::temporal_left,
              "Stereo edges of the earlier frame with at least one candidate in the left image.")
      .def_ro("temporal_right", &FrameCounts::temporal_right, "The same in the right image.")
      .def_ro("quads", &FrameCounts::quads, "Stereo edges matched with those of the earlier frame.")
      .def_ro("inliers", &FrameCounts::inliers, "Quads that agree with the estimated motion.");
}

void bind_warning(nb::module_& module) {
  using Self = Warning;
  nb::class_<Self>(module, "FrameWarning", "A warning that concerns a whole recording.")
      .def_prop_ro(
          "kind", [](const Self& self) { return to_string(self.kind); },
          "device_memory, implausible_calibration, doubtful_calibration, small_disparity_range,\n"
          "unsynchronised_cameras, unknown_motion, repeated_images, large_disparity_offset,\n"
          "static_region, displaced_images, changed_rig, poor_images or doubtful_lenses.")
      .def_ro("text", &Self::text, "The warning in one sentence.")
      .def("__str__", [](const Self& self) { return self.text; })
      .def("__repr__", [](const Self& self) {
        return std::string("<FrameWarning ") + to_string(self.kind) + ": " + self.text + ">";
      });
}

void bind_timing(nb::module_& module) {
  using Self = FrameTiming;
  nb::class_<Self>(module, "FrameTiming", "Computing time of one frame.")
      .def_prop_ro(
          "stages",
          [](const Self& self) {
            nb::dict times;
            for (const auto& stage : self.stages) times[nb::str(stage.stage.c_str())] = stage.ms;
            return times;
          },
          nb::sig("def stages(self) -> dict[str, float]"), "Duration of each processing stage by its name [ms].")
      .def_ro("latency_ms", &Self::latency_ms, "Time from the images in memory to the pose [ms].");
}

void bind_diagnostics(nb::module_& module) {
  using Self = FrameDiagnostics;
  nb::class_<Self> diagnostics(module, "FrameDiagnostics", "Internal quantities of one frame, for evaluation.");
  diagnostics
      .def_ro("edge_threshold", &Self::edge_threshold,
              "Gradient threshold of the edges in both images [grey levels per px].")
      .def_ro("disparity_range", &Self::disparity_range,
              "Largest disparity that stereo matches were searched for, in the middle of the left image [px].")
      .def_ro("overflow", &Self::overflow, "True if a buffer was full; ``message`` of the FrameResult names it.")
      .def_ro("base_frame", &Self::base_frame,
              "Number of the frame that the pose was measured against: the keyframe, or the last one with a pose; -1\n"
              "without a pose.")
      .def_ro("search", &Self::search, "Number of the frame's temporal search that gave its motion; -1: no motion.")
      .def_ro("moving_ratio", &Self::moving_ratio,
              "Share of the visible edges in image regions that do not follow the camera's motion, 0 to 1.")
      .def_ro(
          "moving_cells", &Self::moving_cells,
          "Number of image cells of 32 px that move otherwise than the camera's motion has it, beyond the noise of\n"
          "the frame: information, no doubt about the pose.")
      .def_prop_ro(
          "moving_box",
          [](const Self& self) -> std::optional<std::tuple<double, double, double, double>> {
            if (!self.moving_box) return std::nullopt;
            const Eigen::Vector4d& box = *self.moving_box;
            return std::tuple(box[0], box[1], box[2], box[3]);
          },
          "Bounds of the largest group of adjacent moving cells in the left image: left, top, right, bottom [px].\n"
          "None without any.");
  def_optional(diagnostics, "covariance_in_reference", &Self::covariance_in_reference,
               "(6, 6) float64: covariance, in the convention of ROS's PoseWithCovariance (x, y, z [m], then rotation\n"
               "about x, y, z [rad]), of the pose in the left camera frame of the keyframe, the inverse of\n"
               "``current_from_reference``. None for a lost frame.");
}

void bind_poses(nb::class_<MappedResult>& result) {
  using Self = MappedResult;
  using Pose = std::optional<Eigen::Isometry3d>;
  def_optional(
      result, "covariance", &Self::covariance,
      "(6, 6) float64: covariance of ``world_from_left`` in the convention of ROS's PoseWithCovariance: x, y, z\n"
      "[m], then rotation about x, y, z [rad], along and about the axes of the world frame. Relative to the pose that\n"
      "the segment starts from, which counts as exact. None for a lost frame.");
  def_optional(
      result, "relative_covariance", &Self::relative_covariance,
      "(6, 6) float64: covariance of ``current_from_reference`` due to edge errors alone: x, y, z [m], then rotation\n"
      "about x, y, z [rad], as a left perturbation in the frame of this left camera. None for a lost frame.");
  def_optional(
      result, "world_from_left", &Self::world_from_left,
      "(4, 4) float64: pose of the left camera in the world frame [m], which is the left camera frame of the first\n"
      "frame (x right, y down, z forward). A segment after the first continues from a predicted pose: its place in\n"
      "the world is not measured. None for a lost frame.");
  def_optional(
      result, "predicted_world_from_left", &Self::predicted_world_from_left,
      "(4, 4) float64: for a lost frame, the pose if the last motion is repeated [m]. None for any other frame.");
  def_optional(
      result, "pose_or_prediction",
      [](const Self& self) -> const Pose& {
        return self.world_from_left ? self.world_from_left : self.predicted_world_from_left;
      },
      "(4, 4) float64: ``world_from_left`` or, for a lost frame, ``predicted_world_from_left`` [m].");
  def_optional(
      result, "current_from_reference", &Self::current_from_reference,
      "(4, 4) float64: maps points from the left camera frame of the keyframe to that of this frame [m]. None for a\n"
      "lost frame.");
  def_optional(
      result, "map_from_odometry", &Self::map_from_odometry,
      "(4, 4) float64: maps points from the world frame of the odometry to that of the map [m], in which loops are\n"
      "closed; ``map_from_odometry @ world_from_left`` is the corrected pose. None without ``loops=True``.");
}

void bind_result(nb::module_& module) {
  using Self = MappedResult;
  nb::class_<Self> result(module, "FrameResult", "The result of tracking one frame.");
  bind_poses(result);
  result.def_ro("stamp_ns", &Self::stamp_ns, "Time stamp of the frame [ns].")
      .def_prop_ro(
          "status", [](const Self& self) { return to_string(self.status); },
          "first, tracked, lost_too_few_edges, lost_too_few_quads, lost_no_consensus or lost_rig_mismatch.")
      .def_prop_ro(
          "is_tracked", [](const Self& self) { return is_tracked(self.status); },
          "True if the pose was measured: status first or tracked.")
      .def_ro("segment", &Self::segment,
              "Number of the frame's segment, from 0. Measurements connect all tracked frames of a segment with one\n"
              "another, but not with those of other segments: where the motion across lost frames could not be\n"
              "measured, a new segment starts. A lost frame has the number of the segment before it.")
      .def_ro("reference_frame", &Self::reference_frame,
              "Number of the keyframe, counted from 0; -1 before the first one.")
      .def_ro("new_key_rig", &Self::new_key_rig, "True if this frame becomes the keyframe of the following frames.")
      .def_prop_ro(
          "disparity_offset", [](const Self& self) { return self.rig.disparity_offset; },
          "Offset of all disparities estimated so far, which is added to them [px].")
      .def_prop_ro(
          "disparity_offset_sigma", [](const Self& self) { return self.rig.disparity_offset_sigma; },
          "Its standard deviation [px].")
      .def_prop_ro(
          "disparity_error", [](const Self& self) { return self.rig.disparity_error; },
          "How good the calibration is: standard deviation of the errors that it leaves in disparities [px].")
      .def_prop_ro(
          "displacement", [](const Self& self) { return self.rig.displacement; },
          "By how much the right image of this frame alone is displaced along the epipolar lines, so that its\n"
          "disparities are larger [px]; 0 for most frames.")
      .def_ro("ambiguous_motion", &Self::ambiguous_motion,
              "True if a second motion explains nearly as much of the image as the estimated one.")
      .def_ro("counts", &Self::counts, "Numbers of edges and quads, a FrameCounts.")
      .def_ro("message", &Self::message, "Why the frame was lost or is doubtful, in one sentence; may be empty.")
      .def_ro(
          "warnings", &Self::warnings,
          "List of FrameWarning: what is doubtful about the recording as a whole. Those of one kind are given with\n"
          "the first frame that has any.")
      .def_ro("timing", &Self::timing, "Computing time, a FrameTiming.")
      .def_ro("diagnostics", &Self::diagnostics, "Internal quantities for evaluation, a FrameDiagnostics.")
      .def("__repr__", [](const Self& self) {
        return "<FrameResult " + std::to_string(self.stamp_ns) + ": " + to_string(self.status) + ">";
      });
}

void bind_details(nb::module_& module) {
  nb::class_<Details>(module, "FrameDetails", "The edges and quads of one frame, for drawing and evaluation.")
      .def_ro("left_edges", &Details::left_edges)
      .def_ro("right_edges", &Details::right_edges)
      .def_ro("stereo", &Details::stereo, "Stereo edges of this frame.")
      .def_ro("previous_stereo", &Details::previous_stereo,
              "Stereo edges of the frame that this one was matched with; empty if there is none.")
      .def_ro("quads", &Details::quads, "Indices into ``previous_stereo`` and ``stereo``.");
}

MappedResult track(Odometry& self, std::int64_t stamp_ns, nb::handle left, nb::handle right, nb::handle left_mask,
                   nb::handle right_mask) {
  const ImageArgument left_image(left, "the left image", self.max_value());
  const ImageArgument right_image(right, "the right image", self.max_value());
  const ImageArgument hides_left = ImageArgument::mask(left_mask, "left_mask");
  const ImageArgument hides_right = ImageArgument::mask(right_mask, "right_mask");
  const ReleasedGil released;
  return self.track({stamp_ns, left_image.view(), right_image.view(), hides_left.view(), hides_right.view()});
}

void bind_result_files(nb::module_& module) {
  nb::class_<ResultFiles>(
      module, "ResultFiles",
      "The results folder of ``quadedge run``, for frames that a program tracks by itself: config.toml, trajectories,\n"
      "frames.csv and poses.csv, and at the end report.json, for which the results of all frames stay in memory.\n\n"
      "odometry: that tracks the frames. name: of the recording or camera. command: the program's command line.\n"
      "force: replace results in the folder. Raises UsageError for a folder that has results or that another run\n"
      "writes to, and DataError for one that cannot be written, as do add() and finish().")
      .def(
          "__init__",
          [](ResultFiles* self, const std::filesystem::path& folder, Odometry& odometry, const std::string& name,
             const std::string& command, bool force) {
            const ReleasedGil released;
            new (self) ResultFiles(odometry.result_files(folder.string(), {name, command}, force));
          },
          "folder"_a, "odometry"_a, "name"_a, "command"_a = "", "force"_a = false)
      .def(
          "add", [](ResultFiles& self, const MappedResult& result) { self.add(result); }, "result"_a,
          "Adds the FrameResult of the next frame.")
      .def("finish", &ResultFiles::finish, kReleasesGil, "ended_early"_a = "",
           "Writes report.json. ended_early: why, if not all frames were tracked.");
}

constexpr const char* kOdometryHelp =
    "Estimates the pose of a stereo camera. Create one object per sequence. The same frames, device and configuration\n"
    "give byte for byte the poses of ``quadedge run``. Several objects may track in parallel threads.\n\n"
    "rig: a Rig, or a Dataset or Synthetic, which also provides its disparity range.\n"
    "device: \"auto\" (first GPU, else first CPU), \"cpu\", \"gpu\", \"reference\" (plain C++, slow, without OpenCL),\n"
    "an index of ``devices()``, or a part of a device's name.\n"
    "preset: \"fast\", \"default\", \"dense\" or \"paper\", the paper's own method.\n"
    "config: values that differ from the preset, as a dictionary such as ``{\"stereo.max_disparity\": 100}``\n"
    "(doc/configuration.md), or the path of a TOML file.\n"
    "loops: keep a map beside the odometry, as ``quadedge run --loops`` does. It recognises places, closes loops and\n"
    "gives ``map_from_odometry`` of every result and map_trajectory(); the odometry's own poses stay the same.\n\n"
    "Raises DataError for an unusable rig, UsageError for an invalid configuration, and DeviceError when no device\n"
    "matches, a kernel does not build, or the process was forked after OpenCL had been used.";

}  // namespace

/// LONG: one statement per member.
void bind_odometry(nb::module_& module) {
  bind_counts(module);
  bind_warning(module);
  bind_timing(module);
  bind_diagnostics(module);
  bind_result(module);
  bind_details(module);
  nb::class_<Odometry>(module, "Odometry", kOdometryHelp)
      .def(
          "__init__",
          [](Odometry* self, nb::handle rig, nb::handle device, const std::string& preset, nb::handle config,
             bool loops) {
            const StereoRig cameras = rig_of(rig);
            const std::string choice = device_choice(device);
            const Config constants = make_config(preset, config);
            const ReleasedGil released;
            new (self) Odometry(cameras, choice, constants, loops);
          },
          "rig"_a.none(), nb::arg("device").none() = "auto", "preset"_a = "default", "config"_a = nb::none(),
          "loops"_a = false,
          nb::sig("def __init__(self, rig: Rig | Dataset | Synthetic, device: str | int = 'auto', preset: str = "
                  "'default', config: dict | str | os.PathLike | None = None, loops: bool = False) -> None"))
      .def(
          "track", &track, "stamp_ns"_a, "left"_a.none(), "right"_a.none(), "left_mask"_a.none() = nb::none(),
          "right_mask"_a.none() = nb::none(),
          nb::sig("def track(self, stamp_ns: int, left: numpy.typing.NDArray, right: numpy.typing.NDArray, left_mask: "
                  "numpy.typing.NDArray | None = None, right_mask: numpy.typing.NDArray | None = None) -> FrameResult"),
          "Processes the next frame. Releases the GIL.\n\n"
          "stamp_ns: time stamp [ns], not below that of the previous frame.\n"
          "left, right: grey images as recorded, of the calibrated size, (height, width) or (height, width, 1),\n"
          "uint8, or uint16 if ``rig.max_value`` exceeds 255. Colour is refused: convert it first, for example with\n"
          "``cv2.cvtColor(image, cv2.COLOR_BGR2GRAY)``. Rows may be padded and arrays may be read-only; they are\n"
          "not kept after the call.\n"
          "left_mask, right_mask: masks of this frame, uint8, (height, width) of the image: 0 where it shows "
          "something\n"
          "that is not to be tracked (people, a gripper). Neither edges there nor within ``edges.margin`` of it match\n"
          "or vote. None: everything counts.\n\n"
          "A frame that cannot be tracked is reported by ``status``, not by an exception. Raises TypeError for\n"
          "anything but an array of uint8 or uint16 (a mask: uint8), DataError for images and masks that do not fit\n"
          "the rig and for stamps that go back, DeviceError for a failing device and in a process forked after OpenCL "
          "had been used, and\n"
          "UsageError after close(). The odometry's state does not change when DataError or TypeError is raised.")
      .def("edges", &Odometry::edges, kReleasesGil,
           "Stereo edges of the last frame; empty before the first one. Raises UsageError after close().")
      .def("details", &Odometry::details, kReleasesGil,
           "All edges and quads of the last frame. Raises UsageError after close().")
      .def("map_trajectory", &Odometry::map_trajectory, kReleasesGil,
           "The corrected Trajectory, in the frame of the map: all frames that measured motions connect; if the\n"
           "trajectory broke and no place joins its segments, those of the largest segment. Raises UsageError without\n"
           "``loops=True`` and after close().")
      .def("save_map", &Odometry::save_map, kReleasesGil, "path"_a,
           "Writes the keyframes of these frames to a file, for Map.load() and ``quadedge localise``.\n\n"
           "Raises DataError if it cannot be written, UsageError without ``loops=True`` and after close().")
      .def_prop_ro(
          "rig", &Odometry::rig, kView,
          "The pinhole cameras whose pixel coordinates edges are given in: the rig passed to the constructor, or,\n"
          "where one camera has at least 1.5 times the resolution of the other, that rig with the finer camera\n"
          "reduced.")
      .def_prop_ro(
          "config", [](const Odometry& self) { return to_dict(self.config()); },
          "All configuration values in effect, by key.")
      .def_prop_ro("device", &Odometry::device, "The device in use, a DeviceInfo. Raises UsageError after close().")
      .def_prop_ro("variants", &Odometry::variants,
                   "Kernel variant of every stage, by the stage's name; empty on the plain C++ reference.")
      .def("set_tap", &Odometry::set_tap, kReleasesGil, "tap"_a.none(), nb::keep_alive<1, 2>(),
           "Observes all filters in the following frames with a Tap; None stops.")
      .def("restart", &Odometry::restart, kReleasesGil,
           "Forgets all earlier frames: the next one may have any stamp, and starts a new segment at the last pose,\n"
           "which is no measurement. For clocks that were set, and recordings that were joined.")
      .def("close", &Odometry::close, kReleasesGil,
           "Releases the device memory. Results remain valid; track(), edges() and details() raise UsageError\n"
           "afterwards.")
      .def("__enter__", [](nb::handle self) { return nb::borrow(self); })
      .def(
          "__exit__", [](Odometry& self, const nb::args&) { self.close(); }, kReleasesGil);
  bind_result_files(module);
}

}  // namespace quadedge::python
