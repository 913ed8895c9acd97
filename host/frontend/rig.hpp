#pragma once
/// \file rig.hpp  What the front end has seen at one time, handed out for as long as somebody needs it.

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "pose/quads.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"

namespace quadedge::frontend {

/// The stereo rig of one frame. Each front end derives from it what it needs to match the rig's edges with later ones.
class Rig {
 public:
  virtual ~Rig() = default;

  int frame = -1;     ///< number of the frame, counted from 0 by the front end
  StereoEdges edges;  ///< on the host
  /// Distance of the epipolar lines where edges were kept [px]; 0: all were. See kernels/edge_selection.cl.
  double edges_spacing = 0;

  /// The stereo edges measured with a calibration whose disparities carry `offset` [px]. Kept until the offset changes.
  /// \param min_epipolar_angle see pose::measure() [rad]
  const pose::MeasuredEdges& measured_edges(const StereoRig& calibration, double offset,
                                            double min_epipolar_angle) const {
    if (measured_with_ != offset) {
      pose::measure_edges(calibration, edges, min_epipolar_angle, measured_);
      measured_with_ = offset;
    }
    return measured_;
  }
  /// The memory serves for another frame.
  void start(int frame_number) {
    frame = frame_number;
    measured_with_ = kNever;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::quiet_NaN();
  mutable pose::MeasuredEdges measured_;
  mutable double measured_with_ = kNever;  ///< disparity offset [px]
};

/// Keeps a rig: its memory serves for another frame when the last handle is gone. Must not outlive the device.
using RigHandle = std::shared_ptr<const Rig>;

/// The rigs of a front end. There are as many as were ever needed at once, so that steady frames allocate nothing.
/// \tparam T the front end's rig
template <class T>
class RigPool {
 public:
  /// The rig of the next frame, which becomes the current one: a rig that nobody holds any more, its memory as it was
  /// left, or else a new one made of `arguments`.
  template <class... Arguments>
  T& next(const Arguments&... arguments) {
    auto spare = std::find_if(rigs_.begin(), rigs_.end(), [](const auto& rig) { return rig.use_count() == 1; });
    if (spare == rigs_.end()) spare = rigs_.insert(rigs_.end(), std::make_shared<T>(arguments...));
    current_ = static_cast<std::size_t>(spare - rigs_.begin());
    current().start(++frame_);
    return current();
  }
  T& current() { return *rigs_.at(current_); }
  RigHandle current_handle() const { return rigs_.at(current_); }

  /// The front end's own view of a rig that it has handed out. \throws std::invalid_argument for any other.
  T& own(const Rig& rig) {
    for (const auto& own : rigs_)
      if (own.get() == &rig) return *own;
    throw std::invalid_argument("a rig of another front end");
  }

 private:
  std::vector<std::shared_ptr<T>> rigs_;
  std::size_t current_ = 0;
  int frame_ = -1;
};

}  // namespace quadedge::frontend
