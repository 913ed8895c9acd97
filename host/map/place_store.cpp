#include "map/place_store.hpp"

#include <algorithm>
#include <utility>

namespace quadedge::map {
namespace {

std::size_t bytes_of(const Place& place) { return sizeof(Place) + place.rig.bytes(); }

}  // namespace

void PlaceStore::add(Place place) {
  bytes_ += bytes_of(place);
  places_.push_back(std::move(place));
  while (bytes_ > max_bytes_ && places_.size() > 1) {
    auto redundant = places_.begin();
    float highest = -1;
    for (auto next = places_.begin() + 1; next != places_.end(); ++next) {
      const float similarity = (next - 1)->signature.dot(next->signature);
      if (similarity > highest) {
        highest = similarity;
        redundant = next - 1;
      }
    }
    bytes_ -= bytes_of(*redundant);
    places_.erase(redundant);
  }
}

std::vector<PlaceStore::Similar> PlaceStore::most_similar(const PlaceSignature& signature, int count,
                                                          const std::function<bool(const Place&)>& may_be) const {
  std::vector<Similar> found;
  for (const Place& place : places_)
    if (may_be(place)) found.push_back({&place, place.signature.dot(signature)});
  const auto end = found.begin() + std::min<std::ptrdiff_t>(count, static_cast<std::ptrdiff_t>(found.size()));
  std::partial_sort(found.begin(), end, found.end(), [](const Similar& a, const Similar& b) {
    return a.similarity != b.similarity ? a.similarity > b.similarity : a.place > b.place;
  });
  found.erase(end, found.end());
  return found;
}

}  // namespace quadedge::map
