#pragma once
/// \file tap.hpp  Observation of the production pipeline after every filter (doc/design.md section 3).

#include "quadedge/camera.hpp"
#include "quadedge/edges.hpp"
#include "quadedge/filters.hpp"

namespace quadedge {

/// A search for the stereo edges of an earlier frame, the base, in the current frame.
struct ObservedSearch {
  int number = 0;      ///< among the searches of a frame, from 0; see TemporalMatches::search and FrameResult::search
  int base_frame = 0;  ///< number of the base; frames passed to StereoOdometry are counted from 0
  EdgePositions left, right;  ///< predicted position of every stereo edge of the base in the current images
  double radius = 0;          ///< search radius around the predicted positions [px]
  int step = 1;               ///< every step-th stereo edge of the base is searched for and has a row
};

/// Receives copies of the results of each stage, as computed by the production kernels. All functions do nothing by
/// default; overriding one makes the pipeline read the data back.
class Tap {
 public:
  virtual ~Tap() = default;
  /// Called after edge detection of a frame.
  virtual void edges(const EdgeSet& left, const EdgeSet& right) { (void)left, (void)right; }
  /// Called after every stereo filter between the baseline and the best. Rows are left edges, targets right edges.
  virtual void stereo_filter(StereoFilter filter, const CandidateLists& candidates) { (void)filter, (void)candidates; }
  /// Called with the final stereo edges of a frame.
  virtual void stereo(const StereoEdges& edges) { (void)edges; }
  /// Called before every temporal search.
  virtual void temporal_search(const ObservedSearch& search) { (void)search; }
  /// Called after every filter of that search between the baseline and the best, for the left and the right image. Row
  /// r is stereo edge r * step of the base; targets are current stereo edges. The quad agreement leaves one for both.
  virtual void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) {
    (void)filter, (void)side, (void)candidates;
  }
  /// Called with the quads of that search. FrameResult::search identifies the search that gave the frame's motion.
  virtual void quads(const TemporalMatches& matches) { (void)matches; }
};

}  // namespace quadedge
