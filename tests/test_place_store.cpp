#include "places/place_store.hpp"
#include "testing.hpp"

using namespace quadedge;
using places::Place;
using places::PlaceSignature;
using places::PlaceStore;

namespace {

/// A place whose signature points along the sum of two axes.
Place place(int node, int axis, float other = 0) {
  Place made;
  made.node = node;
  made.kept.frame = node;
  made.signature = PlaceSignature::Unit(axis) + other * PlaceSignature::Unit(axis + 1);
  made.signature.normalize();
  return made;
}

}  // namespace

TEST_CASE("place store: beyond its bound the place most similar to the next one leaves") {
  PlaceStore one(1'000'000);
  one.add(place(0, 0));
  PlaceStore store(3 * one.bytes());
  store.add(place(0, 0));
  store.add(place(1, 20));
  store.add(place(2, 20, 0.1F));
  store.add(place(3, 40));
  CHECK(store.bytes() == 3 * one.bytes());
  CHECK(store.most_similar(PlaceSignature::Unit(40), 1, [](const Place&) { return true; }).front().place->node == 3);
  std::vector<int> nodes;
  for (const Place& kept : store.places()) nodes.push_back(kept.node);
  CHECK(nodes == std::vector<int>{0, 2, 3});
}
