#include "frontends.hpp"
#include "places/place_store.hpp"

using namespace quadedge;
using namespace matching;

namespace {

places::PlaceSignature signature_of(const RenderedScene& scene, std::size_t frame) {
  Device device("reference");
  const auto frontend = frontend::make_frontend(scene.rig, device, scene.config);
  frontend->process(scene.frame(frame));
  return places::place_signature(frontend::as_global(*frontend).keep());
}

}  // namespace

TEST_CASE("place signature: unit length, and views of one scene are more similar than those of another") {
  const RenderedScene room("room", 240, 150, 2, 4), cables("cables", 240, 150, 1);
  const auto first = signature_of(room, 0), later = signature_of(room, 1), other = signature_of(cables, 0);
  CHECK(first.norm() == Approx(1).epsilon(1e-5));
  CHECK(first.dot(later) > first.dot(other) + 0.1F);
  CHECK(first.dot(later) > later.dot(other) + 0.1F);
}

TEST_CASE("place signature: a frame without edges has a signature that resembles none") {
  const places::PlaceSignature none = places::place_signature({});
  CHECK(none.isZero());
}

TEST_CASE("place words: the axes of the projection are perpendicular") {
  const auto& projection = places::place_words().projection;
  for (int i = 0; i < places::kWordNumbers; ++i)
    for (int j = 0; j < i; ++j)
      CHECK(projection.row(i).normalized().dot(projection.row(j).normalized()) == Approx(0).margin(2e-3));
}
