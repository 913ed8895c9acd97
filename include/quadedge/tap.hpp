#pragma once
/// \file tap.hpp  Observing the production pipeline after every filter (DESIGN section 3).

#include <cstdint>
#include <string>
#include <vector>

#include "quadedge/edges.hpp"

namespace quadedge {

/// Candidate lists in compressed rows: row i owns first[i] .. first[i + 1] of the flat arrays.
struct CandidateLists {
  std::vector<std::int32_t> first;   ///< size rows + 1
  std::vector<std::int32_t> target;  ///< index of the other edge
  std::vector<float> x, y;           ///< place of the candidate [px]: detected, then refined
  std::vector<float> cue;            ///< value of the cue that the filter judged (empty for filters without one)
};

/// Receives copies of what each stage leaves. All functions have empty defaults; overriding one makes the pipeline read back.
class Tap {
 public:
  virtual ~Tap() = default;
  /// After edge detection of a frame.
  virtual void edges(const EdgeSet& left, const EdgeSet& right) { (void)left, (void)right; }
  /// After stereo filter number `order` (Table 1): rows are left edges, targets right edges.
  virtual void stereo_filter(int order, const std::string& name, const CandidateLists& candidates) {
    (void)order, (void)name, (void)candidates;
  }
  /// The final stereo edges of a frame.
  virtual void stereo(const StereoEdges& edges) { (void)edges; }
  /// After temporal filter number `order` (Table 2): rows are previous stereo edges, targets current ones.
  /// `side`: 0 left, 1 right.
  virtual void temporal_filter(int order, const std::string& name, int side, const CandidateLists& candidates) {
    (void)order, (void)name, (void)side, (void)candidates;
  }
  /// The final quads of a frame.
  virtual void quads(const TemporalMatches& matches) { (void)matches; }
};

}  // namespace quadedge
