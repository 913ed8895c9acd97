/// \file odometry.cpp  Stereo images in, poses out (include/quadedge/odometry.hpp).

#include "quadedge/odometry.hpp"

#include <memory>
#include <mutex>
#include <nanobind/stl/map.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "cameras.hpp"
#include "configuration.hpp"
#include "edges.hpp"
#include "images.hpp"
#include "quadedge/error.hpp"

namespace quadedge::python {
namespace {

constexpr int kMaxValue16 = 65535;

/// What one frame was made of.
struct Details {
  EdgeSet left_edges, right_edges;
  StereoEdgesInSpace stereo, previous_stereo;
  Quads quads;
};

/// The library's odometry with its device. Calls from several threads wait for one another.
class Odometry {
 public:
  Odometry(const Cameras& cameras, const std::string& device, Config config) : config_(std::move(config)) {
    complete(config_, cameras);
    running_ = std::make_unique<Running>(cameras.rig, device, config_);
    rig_ = running_->odometry.rig();
    max_value_ = cameras.rig.max_value > kMaxValue8 ? cameras.rig.max_value : kMaxValue16;
  }

  FrameResult track(const StereoFrame& frame) {
    const std::lock_guard<std::mutex> alone(in_use_);
    FrameResult result = running().odometry.track(frame);
    disparity_offset_ = result.disparity_offset;
    return result;
  }
  StereoEdgesInSpace edges() {
    const std::lock_guard<std::mutex> alone(in_use_);
    return in_space(running().odometry.details().stereo);
  }
  Details details() {
    const std::lock_guard<std::mutex> alone(in_use_);
    FrameDetails found = running().odometry.details();
    return {std::move(found.left_edges),
            std::move(found.right_edges),
            in_space(std::move(found.stereo)),
            in_space(std::move(found.previous_stereo)),
            {std::move(found.quads), std::move(found.quad_inlier)}};
  }
  void close() {
    const std::lock_guard<std::mutex> alone(in_use_);
    running_.reset();
  }

  const StereoRig& rig() const { return rig_; }
  const Config& config() const { return config_; }
  int max_value() const { return max_value_; }
  DeviceInfo device() { return running().device.info(); }
  std::map<std::string, std::string> variants() { return running().odometry.variants(); }

 private:
  struct Running {
    Running(const StereoRig& rig, const std::string& choice, const Config& config)
        : device(choice), odometry(rig, device, config) {}
    Device device;
    StereoOdometry odometry;
  };
  Running& running() {
    if (!running_) throw UsageError("the odometry is closed");
    return *running_;
  }
  StereoEdgesInSpace in_space(StereoEdges edges) const {
    EdgePoints points = edge_points(edges, rig_, config_, disparity_offset_);
    return {std::move(edges), std::move(points)};
  }

  Config config_;
  StereoRig rig_;
  int max_value_ = kMaxValue16;
  double disparity_offset_ = 0;
  std::mutex in_use_;
  std::unique_ptr<Running> running_;
};

void bind_evidence(nb::module_& module) {
  nb::class_<FrameCounts>(module, "FrameCounts", "Counts of one frame.")
      .def_ro("edges_left", &FrameCounts::edges_left)
      .def_ro("edges_right", &FrameCounts::edges_right)
      .def_ro("stereo_edges", &FrameCounts::stereo_edges)
      .def_ro("temporal_left", &FrameCounts::temporal_left,
              "Stereo edges of the earlier frame that keep a candidate in the left image.")
      .def_ro("temporal_right", &FrameCounts::temporal_right, "The same in the right image.")
      .def_ro("quads", &FrameCounts::quads)
      .def_ro("inliers", &FrameCounts::inliers);
  nb::class_<RigEvidence>(module, "RigEvidence",
                          "What a frame's own images say of the calibration; NaN where nothing could be measured.")
      .def_ro("matched_ratio", &RigEvidence::matched_ratio, "Left edges with a stereo partner, of all left edges.")
      .def_ro("epipolar_residual", &RigEvidence::epipolar_residual, "Median distance from the epipolar line [px].")
      .def_ro("epipolar_offset", &RigEvidence::epipolar_offset, "Signed, in the middle of the image [px].")
      .def_ro("searched_residual", &RigEvidence::searched_residual,
              "Median distance of spots found far around their epipolar lines [px]; in some frames only.")
      .def_ro("found_ratio", &RigEvidence::found_ratio, "Of the sought spots.")
      .def_ro("on_line_ratio", &RigEvidence::on_line_ratio, "Found within 1 px of their line.");
}

nb::object optional_matrix(const std::optional<PoseCovariance>& covariance, nb::handle owner) {
  if (!covariance) return nb::none();
  return nb::cast(ArrayView<double>(covariance->data(), {6, 6}, owner));
}

void bind_result(nb::module_& module) {
  using Self = FrameResult;
  nb::class_<Self>(module, "FrameResult", "The outcome of one frame.")
      .def_ro("stamp_ns", &Self::stamp_ns)
      .def_prop_ro(
          "status", [](const Self& self) { return to_string(self.status); },
          "first, tracked, lost_too_few_edges, lost_too_few_quads, lost_no_consensus or lost_rig_mismatch.")
      .def_prop_ro(
          "is_tracked", [](const Self& self) { return is_tracked(self.status); },
          "Is there a pose? True for first and tracked.")
      .def_prop_ro(
          "world_from_left", [](const Self& self) { return view_of_matrix(self.world_from_left.matrix()); }, kView,
          "(4, 4): pose of the left camera in the frame of the first one [m]; for a lost frame the last motion\n"
          "repeated.")
      .def_prop_ro(
          "current_from_reference",
          [](const Self& self) { return view_of_matrix(self.current_from_reference.matrix()); }, kView,
          "(4, 4): a point in this left camera's frame from one in the key rig's [m].")
      .def_prop_ro(
          "covariance",
          [](nb::handle_t<Self> self) {
            return optional_matrix(nb::cast<const Self&>(self).covariance_in_world, self);
          },
          nb::sig("def covariance(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "(6, 6): of ``world_from_left`` as ROS's PoseWithCovariance has it: x, y, z [m], rotation about x, y, z\n"
          "[rad], along and about the world's axes. None for a lost frame, and from where tracking went on from a\n"
          "predicted pose.")
      .def_prop_ro(
          "covariance_in_reference",
          [](nb::handle_t<Self> self) {
            return optional_matrix(nb::cast<const Self&>(self).covariance_in_reference, self);
          },
          nb::sig("def covariance_in_reference(self) -> numpy.typing.NDArray[numpy.float64] | None"),
          "(6, 6): the same of the pose in the key rig's left camera frame, the inverse of\n"
          "``current_from_reference``; None for a lost frame.")
      .def_ro("reference_frame", &Self::reference_frame, "Number of the key rig's frame; -1 before the first one.")
      .def_ro("new_key_rig", &Self::new_key_rig, "Does this frame become the key rig of the following ones?")
      .def_ro("disparity_offset", &Self::disparity_offset, "Found so far, added to every disparity [px].")
      .def_ro("overflow", &Self::overflow, "A capacity ran out; the message says which.")
      .def_ro("message", &Self::message, "Empty, or one sentence for a person: why a frame was lost.")
      .def_ro("warning", &Self::warning, "Empty, or what is doubtful about the recording; told once per run.")
      .def_ro("ambiguous_motion", &Self::ambiguous_motion, "Another motion explains nearly as much of the image.")
      .def_ro("moving_ratio", &Self::moving_ratio, "Edges where the image moves otherwise than the camera says.")
      .def_ro("rig_evidence", &Self::rig)
      .def_ro("counts", &Self::counts)
      .def_prop_ro(
          "stages",
          [](const Self& self) {
            nb::dict times;
            for (const auto& stage : self.stages) times[nb::str(stage.stage.c_str())] = stage.ms;
            return times;
          },
          nb::sig("def stages(self) -> dict[str, float]"), "Time of each stage [ms].")
      .def_ro("latency_ms", &Self::latency_ms, "From images in memory to the pose.")
      .def("__repr__", [](const Self& self) {
        return "<FrameResult " + std::to_string(self.stamp_ns) + ": " + to_string(self.status) + ">";
      });
}

void bind_details(nb::module_& module) {
  nb::class_<Details>(module, "FrameDetails", "What one frame was made of; for drawing and for evaluation.")
      .def_ro("left_edges", &Details::left_edges)
      .def_ro("right_edges", &Details::right_edges)
      .def_ro("stereo", &Details::stereo, "Stereo edges of this frame.")
      .def_ro("previous_stereo", &Details::previous_stereo, "Of the frame that this one was matched with, if any.")
      .def_ro("quads", &Details::quads, "Indices into ``previous_stereo`` and ``stereo``.");
}

FrameResult track(Odometry& self, std::int64_t stamp_ns, nb::handle left, nb::handle right) {
  const ImageArgument left_image(left, "the left image", self.max_value());
  const ImageArgument right_image(right, "the right image", self.max_value());
  const nb::gil_scoped_release released;
  return self.track({stamp_ns, left_image.view(), right_image.view()});
}

constexpr const char* kOdometryHelp =
    "Tracks the pose of a stereo camera. One object per sequence; the same frames, device and configuration give\n"
    "the same bytes as ``quadedge run``. Threads may have an object each.\n\n"
    "rig: a Rig, or a Dataset or Synthetic, whose disparity range it then uses.\n"
    "device: auto (first GPU, else first CPU), cpu, gpu, reference (plain C++, slow, without OpenCL), a number of\n"
    "``devices()``, or a part of a name.\n"
    "preset: fast, default or accurate. config: what differs from it, a dictionary such as\n"
    "``{\"stereo.max_disparity\": 100}`` (doc/configuration.md), or the path of a TOML file.\n\n"
    "Raises DataError for an unusable rig, UsageError for the configuration, DeviceError.";

}  // namespace

/// LONG: one statement per member.
void bind_odometry(nb::module_& module) {
  bind_evidence(module);
  bind_result(module);
  bind_details(module);
  nb::class_<Odometry>(module, "Odometry", kOdometryHelp)
      .def(
          "__init__",
          [](Odometry* self, nb::handle rig, const std::string& device, const std::string& preset, nb::handle config) {
            const Cameras cameras = cameras_of(rig);
            const Config constants = make_config(preset, config);
            const nb::gil_scoped_release released;
            new (self) Odometry(cameras, device, constants);
          },
          "rig"_a.none(), "device"_a = "auto", "preset"_a = "default", "config"_a = nb::none(),
          nb::sig("def __init__(self, rig: Rig | Dataset | Synthetic, device: str = 'auto', preset: str = 'default', "
                  "config: dict | str | os.PathLike | None = None) -> None"))
      .def(
          "track", &track, "stamp_ns"_a, "left"_a.none(), "right"_a.none(),
          nb::sig("def track(self, stamp_ns: int, left: numpy.typing.NDArray, right: numpy.typing.NDArray) -> "
                  "FrameResult"),
          "Processes the next frame; the GIL is released meanwhile.\n\n"
          "left, right: recorded images, (height, width) of uint8, or of uint16 where ``rig.max_value`` says so. Rows "
          "may\n"
          "be any number of bytes apart, the arrays may be read-only; they are not kept.\n\n"
          "What can happen in any frame is a status. Raises TypeError for what is no image, DataError for images that\n"
          "do not fit the rig or a stamp that goes back (no trace is left), UsageError after close().")
      .def(
          "edges",
          [](Odometry& self) {
            const nb::gil_scoped_release released;
            return self.edges();
          },
          "Stereo edges of the frame tracked last; none before the first one.")
      .def(
          "details",
          [](Odometry& self) {
            const nb::gil_scoped_release released;
            return self.details();
          },
          "All edges and quads of the frame tracked last.")
      .def_prop_ro(
          "rig", &Odometry::rig, kView,
          "The pinhole cameras whose pixels edges are given in: those of the constructor, or where one has at\n"
          "least one and a half times the other's resolution, with that one reduced.")
      .def_prop_ro(
          "config", [](const Odometry& self) { return to_dict(self.config()); },
          "Every constant in effect, by its key.")
      .def_prop_ro("device", &Odometry::device)
      .def_prop_ro("variants", &Odometry::variants, "Chosen kernel variant of every stage; none on the reference.")
      .def(
          "close",
          [](Odometry& self) {
            const nb::gil_scoped_release released;
            self.close();
          },
          "Releases the device's memory. Results stay; track() and edges() raise UsageError from now on.")
      .def("__enter__", [](nb::handle self) { return nb::borrow(self); })
      .def(
          "__exit__",
          [](Odometry& self, nb::handle, nb::handle, nb::handle) {
            const nb::gil_scoped_release released;
            self.close();
          },
          nb::arg().none(), nb::arg().none(), nb::arg().none());
}

}  // namespace quadedge::python
