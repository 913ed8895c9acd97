#pragma once
/// \file taps.hpp  A tap whose calls a Python object takes.

#include "bindings.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::python {

/// Passes copies to the methods of its Python object, with the GIL held.
class PythonTap : public Tap {
 public:
  /// The cameras of the odometry that it watches; they give its stereo edges their points.
  void watch(const StereoRig& rig);
  void edges(const EdgeSet& left, const EdgeSet& right) override;
  void stereo_filter(StereoFilter filter, const CandidateLists& candidates) override;
  void stereo(const StereoEdges& edges) override;
  void temporal_search(const ObservedSearch& search) override;
  void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) override;
  void quads(const TemporalMatches& matches) override;

 private:
  StereoRig rig_;
};

}  // namespace quadedge::python
