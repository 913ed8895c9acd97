#pragma once
/// \file rig.hpp  Handles to the stereo edges of a frame, valid for as long as they are held.

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "pose/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// The stereo rig of one frame. Each front end derives a class with the data it needs to match the rig's edges later.
class Rig {
 public:
  virtual ~Rig() = default;

  int frame = -1;     ///< frame number, counted from 0 by the front end
  StereoEdges edges;  ///< on the host
  /// Spacing of the epipolar lines on which edges were selected, at least that of the maxima of a curve [px]. See
  /// kernels/edge_selection.cl.
  double edges_spacing = 1;
  /// The cameras that the edges refer to, if these are not the front end's; offset included.
  std::shared_ptr<const StereoRig> own_calibration;

  /// Measurements of the stereo edges with a calibration whose disparities include `offset` [px], or with their own
  /// calibration. Cached until the offset changes.
  /// \param min_epipolar_angle see pose::measure() [rad]
  const pose::MeasuredEdges& measured_edges(const StereoRig& calibration, double offset,
                                            double min_epipolar_angle) const {
    if (measured_with_ != offset) {
      pose::measure_edges(own_calibration ? *own_calibration : calibration, edges, min_epipolar_angle, measured_);
      measured_with_ = offset;
    }
    return measured_;
  }
  /// Prepares the rig for another frame; keeps its memory.
  void start(int frame_number) {
    frame = frame_number;
    own_calibration = nullptr;
    measured_with_ = kNever;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  mutable pose::MeasuredEdges measured_;
  mutable double measured_with_ = kNever;  ///< disparity offset [px]
};

/// Keeps a rig; its memory is reused when the last handle is released. Must not outlive the device.
using RigHandle = std::shared_ptr<const Rig>;

/// The rigs of a front end. Their number is the maximum ever held at once, so that nothing is allocated in steady
/// state.
/// \tparam T the rig type of the front end
template <class T>
class RigPool {
 public:
  /// Returns the rig for the next frame: one that is no longer held, with its memory unchanged, or a new one
  /// constructed from `arguments`.
  template <class... Arguments>
  T& next(const Arguments&... arguments) {
    current_ = spare(rigs_.size(), arguments...);
    current().start(++frame_);
    return current();
  }
  /// The same for a rig that is restored and does not become the current one.
  template <class... Arguments>
  const std::shared_ptr<T>& restored(const Arguments&... arguments) {
    return rigs_[spare(current_, arguments...)];
  }
  T& current() { return *rigs_.at(current_); }
  RigHandle current_handle() const { return rigs_.at(current_); }

  /// The front end's own type of a rig that it has created. \throws std::invalid_argument for any other rig
  T& own(const Rig& rig) {
    for (const auto& own : rigs_)
      if (own.get() == &rig) return *own;
    throw std::invalid_argument("a rig of another front end");
  }

 private:
  /// Number of a rig that is not held and is not number `except`.
  template <class... Arguments>
  std::size_t spare(std::size_t except, const Arguments&... arguments) {
    for (std::size_t i = 0; i < rigs_.size(); ++i)
      if (i != except && rigs_[i].use_count() == 1) return i;
    rigs_.push_back(std::make_shared<T>(arguments...));
    return rigs_.size() - 1;
  }

  std::vector<std::shared_ptr<T>> rigs_;
  std::size_t current_ = 0;
  int frame_ = -1;
};

}  // namespace quadedge::frontend
