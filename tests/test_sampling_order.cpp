#include "motion/sampling_order.hpp"
#include "testing.hpp"

using namespace quadedge::pose;

TEST_CASE("Quads are sampled by fewest competing clusters, then highest NCC, then lowest index", "[pose]") {
  QuadObservations quads;
  quads.resize(6);
  quads.competing_clusters = {1, 0, 0, 0, 0, 2};
  quads.ncc = {1.0f, 0.7f, 0.9f, -0.5f, 0.9f, 1.0f};
  std::vector<SamplingOrder::Entry> buffer;
  SamplingOrder order(quads, buffer);
  REQUIRE(order.size() == 6);
  order.sort_first(1);
  CHECK(order[0] == 2);
  order.sort_first(6);
  const std::size_t expected[] = {2, 4, 1, 3, 0, 5};
  for (std::size_t rank = 0; rank < 6; ++rank) CHECK(order[rank] == expected[rank]);
}
