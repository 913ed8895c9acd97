#include <catch2/catch.hpp>

#include "edges/range_follower.hpp"

using namespace quadedge;
using frontend::CoarseGate;

namespace {

/// Searches of a frame in which `undecided` of 100 edges remain undecided; `consulted` receives whether the last one
/// consulted the coarse disparity.
int searches(CoarseGate& gate, int undecided, bool& consulted) {
  int count = 1;
  while (!gate.suffices({100, undecided})) ++count;
  consulted = gate.is_open();
  return count;
}

}  // namespace

TEST_CASE("coarse gate: is open in frames with many undecided edges and shut in those with few", "[frontend]") {
  StereoConfig config;
  config.coarse_ties = 0.2;
  CoarseGate gate(config, true);
  bool consulted = false;
  CHECK(searches(gate, 19, consulted) == 1);
  CHECK_FALSE(consulted);
  CHECK(searches(gate, 20, consulted) == 2);
  CHECK(consulted);
  CHECK(searches(gate, 60, consulted) == 1);
  CHECK(consulted);
  CHECK(searches(gate, 5, consulted) == 2);
  CHECK_FALSE(consulted);
  CHECK(searches(gate, 5, consulted) == 1);
  CHECK_FALSE(consulted);
}

TEST_CASE("coarse gate: stays shut at a ratio of 1, without votes, and where rows do not correspond", "[frontend]") {
  StereoConfig never, no_votes;
  never.coarse_ties = 1;
  no_votes.relaxation_rounds = 0;
  bool consulted = true;
  for (auto gate : {CoarseGate(never, true), CoarseGate(no_votes, true), CoarseGate({}, false)}) {
    CHECK(searches(gate, 100, consulted) == 1);
    CHECK_FALSE(consulted);
  }
}
