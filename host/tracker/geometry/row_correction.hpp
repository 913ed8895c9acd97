#pragma once
/// \file row_correction.hpp  The rectification error that the search of stereo edges corrects, as the front end sees
/// it.

#include "geometry/epipolar_geometry.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/image.hpp"

namespace quadedge {

/// Gives every frame the rectification error with which its right image is searched: by itself, none.
class RowCorrection {
 public:
  virtual ~RowCorrection() = default;

  /// Begins a frame with the error that earlier frames suggest.
  virtual void start_frame() {}
  /// Whether the frame, in which `edges` were found, was searched with a suitable error. If not, error() has changed
  /// and the frame is to be searched again; the second answer is always true.
  virtual bool suffices(const StereoFrame& /*frame*/, const StereoEdges& /*edges*/) { return true; }
  /// Of the current frame; zero unless the images show clearly that it matters.
  virtual const RectificationError& error() const { return none_; }

 private:
  RectificationError none_;
};

}  // namespace quadedge
