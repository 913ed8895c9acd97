#include "places/place_store.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quadedge::places {

PlaceStore::Rounded PlaceStore::rounded(const PlaceSignature& signature) {
  Rounded result;
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::int16_t>(std::lround(32767 * signature[static_cast<Eigen::Index>(i)]));
  return result;
}

void PlaceStore::add(Place place) {
  bytes_ += bytes_of(place);
  rounded_.push_back(rounded(place.signature));
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
    rounded_.erase(rounded_.begin() + (redundant - places_.begin()));
    places_.erase(redundant);
  }
}

std::vector<PlaceStore::Similar> PlaceStore::most_similar(const PlaceSignature& signature, int count,
                                                          const std::function<bool(const Place&)>& may_be) const {
  const Rounded wanted = rounded(signature);
  std::vector<std::pair<std::int32_t, std::size_t>> heap(places_.size());  // product, index; of equal ones the latest
  for (std::size_t i = 0; i < heap.size(); ++i) {
    std::int32_t product = 0;  // at most 2^30, since signatures have unit length
    for (std::size_t k = 0; k < wanted.size(); ++k) product += rounded_[i][k] * wanted[k];
    heap[i] = {product, i};
  }
  std::make_heap(heap.begin(), heap.end());
  std::vector<Similar> found;
  while (!heap.empty() && found.size() < static_cast<std::size_t>(count)) {
    const Place& place = places_[heap.front().second];
    if (may_be(place)) found.push_back({&place, place.signature.dot(signature)});
    std::pop_heap(heap.begin(), heap.end());
    heap.pop_back();
  }
  return found;
}

}  // namespace quadedge::places
