#pragma once
/// \file frontend.hpp  Everything of a frame above the host's line: from two images to stereo edges and quads
/// (doc/design.md section 1).

#include <memory>
#include <string>

#include "common/temporal_search.hpp"
#include "frontend/rig.hpp"
#include "quadedge/camera.hpp"
#include "quadedge/config.hpp"
#include "quadedge/device.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/odometry.hpp"
#include "quadedge/tap.hpp"

namespace quadedge::frontend {

/// What can be counted of the current frame.
struct FrontendCounts {
  double edge_threshold = 0;  ///< of both images [grey levels per px]
  int edges_left = 0, edges_right = 0;
  int dropped_edges = 0;                      ///< beyond edges.max_edges, both images
  int temporal_left = 0, temporal_right = 0;  ///< rows of the last match() that keep a candidate before the agreement
  int searches = 0;                           ///< calls of match(); they number TemporalMatches::search
};

/// Two implementations: the OpenCL stages, and the plain C++ reference. The caller decides which rigs are kept, by
/// holding their handles.
class Frontend {
 public:
  virtual ~Frontend() = default;

  /// Stages 1 to 5 of doc/design.md section 1: images to stereo edges. \returns the rig, which is the current one until
  /// the next call; it is overwritten then unless somebody holds a handle.
  virtual RigHandle process(const StereoFrame& frame) = 0;
  /// Stage 6: quads between an earlier rig, the base, and the current one. `search` has one entry per stereo edge of
  /// the base. Replaces `matches`, as match_globally() does.
  virtual void match(const Rig& base, const TemporalSearch& search, TemporalMatches& matches) = 0;
  /// Quads between a part of a base's edges and the current rig, found anywhere in the left image by what surrounds
  /// them.
  virtual void match_globally(const Rig& base, TemporalMatches& matches) = 0;
  TemporalMatches match(const Rig& base, const TemporalSearch& search) {
    TemporalMatches matches;
    match(base, search, matches);
    return matches;
  }
  TemporalMatches match_globally(const Rig& base) {
    TemporalMatches matches;
    match_globally(base, matches);
    return matches;
  }

  const FrontendCounts& counts() const { return counts_; }

  std::string notice;  ///< empty, or what the user should know of the device at once

  /// Edges of one of the current images.
  virtual EdgeSet edges(Side side) = 0;
  virtual std::size_t device_bytes() const = 0;

  /// Observes every filter from now on; null stops.
  virtual void set_tap(Tap* tap) { tap_ = tap; }

 protected:
  FrontendCounts counts_;
  Tap* tap_ = nullptr;
};

/// The OpenCL stages on `device`, or the reference where the device says so.
/// \throws UsageError for a variant that does not exist or limits that make no sense, DeviceError when kernels do not
/// build.
std::unique_ptr<Frontend> make_frontend(const StereoRig& rig, Device& device, const Config& config);

}  // namespace quadedge::frontend
