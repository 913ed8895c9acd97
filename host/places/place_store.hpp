#pragma once
/// \file place_store.hpp  Kept key rigs, and those most similar to a given one (doc/method.md section 10).

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "frontend/kept_frame_edges.hpp"
#include "places/place_signature.hpp"

namespace quadedge::places {

/// A rig is compared with this number of places, the most similar ones; one without a known place with up to
/// kCandidateBatches times as many. If it is found, those of them that see other places are compared as well, in case
/// another matches, too.
constexpr int kCandidates = 5, kCandidateBatches = 4;

/// A kept rig.
struct Place {
  frontend::KeptFrameEdges rig;
  PlaceSignature signature;
  int node = 0;  ///< of the pose graph
};

/// Keeps places within a bound of memory: beyond it, the place that is most similar to the one after it leaves.
class PlaceStore {
 public:
  /// \param max_bytes at least room for one place remains
  explicit PlaceStore(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  void add(Place place);
  /// A place and the scalar product of its signature with the given one.
  struct Similar {
    const Place* place;
    float similarity;
  };
  /// The `count` most similar places that `may_be` accepts, best first; valid until the next add().
  std::vector<Similar> most_similar(const PlaceSignature& signature, int count,
                                    const std::function<bool(const Place&)>& may_be) const;

  std::size_t size() const { return places_.size(); }
  std::size_t bytes() const { return bytes_; }
  const std::vector<Place>& places() const { return places_; }

 private:
  /// A signature in whole numbers. In an array of their own, those of 100,000 places are compared in a few
  /// milliseconds.
  using Rounded = std::array<std::int16_t, kWords * kWordNumbers>;
  static Rounded rounded(const PlaceSignature& signature);
  static std::size_t bytes_of(const Place& place) { return sizeof(Place) + sizeof(Rounded) + place.rig.bytes(); }

  std::size_t max_bytes_;
  std::size_t bytes_ = 0;
  std::vector<Place> places_;     ///< oldest first
  std::vector<Rounded> rounded_;  ///< their signatures
};

}  // namespace quadedge::places
