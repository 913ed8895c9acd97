#pragma once
/// \file frame_edges.hpp  Handles to the stereo edges of a frame, valid for as long as they are held.

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "geometry/measured_edges.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/rig_estimate.hpp"

namespace quadedge::frontend {

/// What a frame has seen. Each front end derives a class with the data it needs to match these edges later.
class FrameEdges {
 public:
  virtual ~FrameEdges() = default;

  int frame = -1;                           ///< frame number, counted from 0 by the front end
  std::int64_t stamp_ns = 0;                ///< of its images
  std::shared_ptr<const PixelMask> hidden;  ///< by the mask of its left image, with edges.margin; null: none
  StereoEdges edges;                        ///< on the host
  /// Spacing of the epipolar lines on which edges were selected, at least that of the maxima of a curve [px]. See
  /// kernels/edge_selection.cl.
  double edges_spacing = 1;
  bool is_restored = false;  ///< without images, with wide descriptors of all edges
  /// The cameras that the edges refer to, if these are not the front end's; offset included.
  std::shared_ptr<const StereoRig> own_calibration;

  /// Measurements of the stereo edges with `calibration`, unless they have their own. Cached until an argument changes.
  /// \param min_epipolar_angle see pose::measure() [rad]
  const pose::MeasuredEdges& measured_edges(const StereoRig& calibration, double min_epipolar_angle) const {
    const StereoRig& used = own_calibration ? *own_calibration : calibration;
    Arguments arguments;
    arguments << used.left.fx, used.left.fy, used.left.cx, used.left.cy, used.right.fx, used.right.fy, used.right.cx,
        used.right.cy, min_epipolar_angle,
        Eigen::Map<const Eigen::Matrix<double, 16, 1>>(used.right_from_left.matrix().data());
    if (arguments != measured_with_) {
      if (measured_.capacity() == 0 && !spare_->empty()) {
        measured_ = std::move(spare_->back());
        spare_->pop_back();
      }
      pose::measure_edges(used, edges, min_epipolar_angle, measured_);
      measured_with_ = arguments;
    }
    return measured_;
  }
  /// Leaves the memory of the measurements, a third of a kilobyte per edge, to another frame of the pool. They are made
  /// again when they are asked for.
  void release_measurements() const {
    if (measured_.capacity() == 0) return;
    measured_with_ = never();
    spare_->push_back(std::exchange(measured_, {}));
  }
  using SpareMeasurements = std::vector<pose::MeasuredEdges>;
  /// Shares what release_measurements() leaves.
  void share(std::shared_ptr<SpareMeasurements> spare) { spare_ = std::move(spare); }
  /// The rig with which the frame was measured. A later frame may know more of the offset; the displacement is its own.
  const RigEstimate& rig() const { return rig_; }
  /// Once that is known: when the frame's motion is.
  void set_rig(const RigEstimate& rig) const { rig_ = rig; }
  /// Prepares the edges for another frame; keeps their memory.
  void start(int frame_number) {
    frame = frame_number;
    own_calibration = nullptr;
    hidden = nullptr;
    is_restored = false;
    rig_ = {};
    measured_with_ = never();
  }

 private:
  using Arguments = Eigen::Matrix<double, 25, 1>;  ///< all that measure() reads
  static Arguments never() { return Arguments::Constant(std::numeric_limits<double>::quiet_NaN()); }
  mutable RigEstimate rig_;
  mutable pose::MeasuredEdges measured_;
  mutable Arguments measured_with_ = never();
  std::shared_ptr<SpareMeasurements> spare_ = std::make_shared<SpareMeasurements>();
};

/// Keeps a frame's edges; their memory is reused when the last handle is released. Must not outlive the device.
using FrameEdgesHandle = std::shared_ptr<const FrameEdges>;

/// The frames' edges of a front end. Their number is the maximum ever held at once, so that nothing is allocated in
/// steady state. \tparam T the front end's own class
template <class T>
class FrameEdgesPool {
 public:
  /// Returns the edges for the next frame: those that are no longer held, with their memory unchanged, or a new one
  /// constructed from `arguments`.
  template <class... Arguments>
  T& next(const Arguments&... arguments) {
    current_ = spare(frames_.size(), arguments...);
    current().start(++frame_);
    return current();
  }
  /// The same for edges that are restored and do not become the current ones.
  template <class... Arguments>
  const std::shared_ptr<T>& restored(const Arguments&... arguments) {
    return frames_[spare(current_, arguments...)];
  }
  T& current() { return *frames_.at(current_); }
  FrameEdgesHandle current_handle() const { return frames_.at(current_); }

  /// The front end's own type of edges that it has created. \throws std::invalid_argument for any others
  T& own(const FrameEdges& frame_edges) {
    for (const auto& own : frames_)
      if (own.get() == &frame_edges) return *own;
    throw std::invalid_argument("edges of another front end");
  }

 private:
  /// Number of edges that are not held and are not number `except`.
  template <class... Arguments>
  std::size_t spare(std::size_t except, const Arguments&... arguments) {
    for (std::size_t i = 0; i < frames_.size(); ++i)
      if (i != except && frames_[i].use_count() == 1) return i;
    frames_.push_back(std::make_shared<T>(arguments...));
    frames_.back()->share(spare_);
    return frames_.size() - 1;
  }

  std::vector<std::shared_ptr<T>> frames_;
  std::shared_ptr<FrameEdges::SpareMeasurements> spare_ = std::make_shared<FrameEdges::SpareMeasurements>();
  std::size_t current_ = 0;
  int frame_ = -1;
};

}  // namespace quadedge::frontend
