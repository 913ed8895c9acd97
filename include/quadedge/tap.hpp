#pragma once
/// \file tap.hpp  Observing the production pipeline after every filter (doc/design.md section 3).

#include <cstdint>
#include <vector>

#include "quadedge/edges.hpp"
#include "quadedge/filters.hpp"
#include "quadedge/side.hpp"

namespace quadedge {

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of the flat arrays.
struct CandidateLists {
  std::vector<std::int32_t> first;   ///< size rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
  std::vector<float> x, y;           ///< refined positions of the candidates [px]; empty: where the targets lie
  /// What the NEXT filter will judge, before it does: NCC or SIFT distance. Empty where positions and directions
  /// decide.
  std::vector<float> cue;
};

/// A search for the stereo edges of an earlier frame, its base, in the current one.
struct ObservedSearch {
  int number = 0;      ///< of the searches of one frame, from 0; see TemporalMatches::search and FrameResult::search
  int base_frame = 0;  ///< number of the base; the frames that StereoOdometry takes count from 0
  EdgePositions left, right;  ///< where every stereo edge of the base is expected in the current images
  double radius = 0;          ///< px around the expected positions
  int step = 1;               ///< only every step-th stereo edge of the base is looked for; each has a row
};

/// Receives copies of what each stage leaves, as the production kernels decided it. All functions have empty defaults;
/// overriding one makes the pipeline read back.
class Tap {
 public:
  virtual ~Tap() = default;
  /// After edge detection of a frame.
  virtual void edges(const EdgeSet& left, const EdgeSet& right) { (void)left, (void)right; }
  /// After every stereo filter between the baseline and the best: rows are left edges, targets right edges.
  virtual void stereo_filter(StereoFilter filter, const CandidateLists& candidates) { (void)filter, (void)candidates; }
  /// The final stereo edges of a frame.
  virtual void stereo(const StereoEdges& edges) { (void)edges; }
  /// Before every search in time.
  virtual void temporal_search(const ObservedSearch& search) { (void)search; }
  /// After every filter of that search between the baseline and the best, of the left and of the right image: row r is
  /// stereo edge r * step of the base, targets are current stereo edges. What the agreement leaves is one list, told
  /// for either side.
  virtual void temporal_filter(TemporalFilter filter, Side side, const CandidateLists& candidates) {
    (void)filter, (void)side, (void)candidates;
  }
  /// The quads of that search. FrameResult::search says which search of the frame its motion was taken from.
  virtual void quads(const TemporalMatches& matches) { (void)matches; }
};

}  // namespace quadedge
