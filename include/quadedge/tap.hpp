#pragma once
/// \file tap.hpp  Observing the production pipeline after every filter (doc/design.md section 3).

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
  /// What the NEXT filter will judge, before it does: NCC or SIFT distance. Empty where places and directions decide.
  std::vector<float> cue;
};

/// Where a search in time expects every previous stereo edge in one of the current images [px, rad]; NaN: nowhere.
struct ExpectedEdges {
  std::vector<float> x, y, direction;
};

/// Receives copies of what each stage leaves. All functions have empty defaults; overriding one makes the pipeline read
/// back.
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
  /// Before every search in time: it looks within `radius` px of the expected places of every `step`-th previous stereo
  /// edge.
  virtual void temporal_search(const ExpectedEdges& left, const ExpectedEdges& right, double radius, int step) {
    (void)left, (void)right, (void)radius, (void)step;
  }
  /// After temporal filter number `order` (Table 2): rows are previous stereo edges, targets current ones.
  /// `side`: 0 left, 1 right.
  virtual void temporal_filter(int order, const std::string& name, int side, const CandidateLists& candidates) {
    (void)order, (void)name, (void)side, (void)candidates;
  }
  /// The final quads of a frame.
  virtual void quads(const TemporalMatches& matches) { (void)matches; }
};

}  // namespace quadedge
