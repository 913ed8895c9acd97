#include "generated_quads.hpp"
#include "motion/two_quads.hpp"

using namespace quadedge::pose;

namespace {

OrientedPair moved_pair(const OrientedPair& pair, const Eigen::Isometry3d& m) {
  return {{m * pair.first.point, m.linear() * pair.first.tangent},
          {m * pair.second.point, m.linear() * pair.second.tangent}};
}

}  // namespace

TEST_CASE("Two exact quads give the exact motion", "[pose]") {
  generated::Random random(7);
  int solved = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const OrientedPair pair{{random.uniform(1, 9) * random.unit(), random.unit()},
                            {random.uniform(1, 9) * random.unit(), random.unit()}};
    const Eigen::Isometry3d truth = random.motion(3.0, 5.0);
    const auto found = solve_two_quads(pair, moved_pair(pair, truth));
    if (!found) continue;
    ++solved;
    CHECK((found->matrix() - truth.matrix()).norm() < 1e-9);
  }
  CHECK(solved > 150);
}

TEST_CASE("Coplanar vectors give the exact motion too", "[pose]") {
  generated::Random random(8);
  const OrientedPair pair{{{0, 0, 4}, Eigen::Vector3d::UnitY()}, {{1, 0, 4}, Eigen::Vector3d::UnitY()}};
  const Eigen::Isometry3d truth = random.motion(1.0, 1.0);
  const auto found = solve_two_quads(pair, moved_pair(pair, truth));
  REQUIRE(found);
  CHECK((found->matrix() - truth.matrix()).norm() < 1e-12);
}

TEST_CASE("A chord parallel to the first tangent, or of zero length, is degenerate", "[pose]") {
  const OrientedPair good{{{0, 0, 4}, Eigen::Vector3d::UnitY()}, {{1, 0, 4}, Eigen::Vector3d::UnitZ()}};
  const OrientedPair along{{{0, 0, 4}, Eigen::Vector3d::UnitX()}, {{1, 0, 4}, Eigen::Vector3d::UnitZ()}};
  const OrientedPair one_spot{{{0, 0, 4}, Eigen::Vector3d::UnitY()}, {{0, 0, 4}, Eigen::Vector3d::UnitZ()}};
  CHECK(solve_two_quads(good, good));
  CHECK_FALSE(solve_two_quads(along, good));
  CHECK_FALSE(solve_two_quads(good, along));
  CHECK_FALSE(solve_two_quads(one_spot, good));
  CHECK_FALSE(solve_two_quads(good, one_spot));
}

TEST_CASE("A noisy pair still gives a valid rotation and maps the midpoint exactly", "[pose]") {
  generated::Random random(9);
  for (int trial = 0; trial < 50; ++trial) {
    const OrientedPair before{{random.uniform(1, 9) * random.unit(), random.unit()},
                              {random.uniform(1, 9) * random.unit(), random.unit()}};
    OrientedPair after = moved_pair(before, random.motion(1.0, 1.0));
    after.first.point += 0.1 * random.unit();
    after.second.point += 0.1 * random.unit();
    after.first.tangent = (after.first.tangent + 0.1 * random.unit()).normalized();
    const auto found = solve_two_quads(before, after);
    if (!found) continue;
    CHECK((found->linear().transpose() * found->linear() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(found->linear().determinant() == Approx(1.0));
    CHECK((*found * (0.5 * (before.first.point + before.second.point)) - 0.5 * (after.first.point + after.second.point))
              .norm() < 1e-12);
  }
}
