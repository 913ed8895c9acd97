#include "generated_quads.hpp"
#include "motion/two_quads.hpp"

using namespace quadedge::pose;

namespace {

OrientedPair moved(const OrientedPair& pair, const Eigen::Isometry3d& m) {
  return {{m * pair.first.point, m.linear() * pair.first.tangent},
          {m * pair.second.point, m.linear() * pair.second.tangent}};
}

Eigen::Vector3d unit(double x, double y, double z) { return Eigen::Vector3d(x, y, z).normalized(); }

/// D along x, 2 m long; T1 and T2 not coplanar with it.
OrientedPair example() { return {{{0, 0, 5}, unit(0.3, 1, 0)}, {{2, 0, 5}, unit(0.2, 0.5, 1)}}; }

}  // namespace

TEST_CASE("A rigidly moved pair passes all six constraints", "[pose]") {
  generated::Random random(6);
  for (int trial = 0; trial < 200; ++trial) {
    const OrientedPair pair{{random.uniform(1, 9) * random.unit(), random.unit()},
                            {random.uniform(1, 9) * random.unit(), random.unit()}};
    const ConstraintCheck check = check_constraints(pair, moved(pair, random.motion(3.0, 5.0)));
    for (std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{5}})
      CHECK(check.passed[i]);
  }
  CHECK(check_constraints(example(), moved(example(), random.motion(3.0, 5.0))).all());
}

TEST_CASE("Each constraint fails alone, just beyond its threshold", "[pose]") {
  const OrientedPair before = example();
  const auto only_fails = [&](const OrientedPair& after, std::size_t number) {
    const ConstraintCheck check = check_constraints(before, after);
    for (std::size_t i = 0; i < 6; ++i) CHECK(check.passed[i] == (i != number));
  };
  OrientedPair after = before;
  after.second.point.x() = 2 * 1.12;
  CHECK(check_constraints(before, after).all());
  after.second.point.x() = 2 * 1.14;
  only_fails(after, 0);

  // T1 turned about z: its cosine with D changes, T1 . T2 hardly does.
  after = before;
  const double cosine = before.first.tangent.x() - 0.125;
  after.first.tangent = Eigen::Vector3d(cosine, std::sqrt(1 - cosine * cosine), 0);
  only_fails(after, 1);
  const double nearer = before.first.tangent.x() - 0.115;
  after.first.tangent = Eigen::Vector3d(nearer, std::sqrt(1 - nearer * nearer), 0);
  CHECK(check_constraints(before, after).all());

  after = before;
  const double second = before.second.tangent.x() + 0.125;
  after.second.tangent = std::sqrt(1 - second * second) * unit(0, 0.5, 1) + second * Eigen::Vector3d::UnitX();
  only_fails(after, 2);

  // T2 turned about D: only its angle with T1 changes.
  after = before;
  after.second.tangent = Eigen::AngleAxisd(-0.45, Eigen::Vector3d::UnitX()) * before.second.tangent;
  CHECK(std::abs(after.first.tangent.dot(after.second.tangent) - before.first.tangent.dot(before.second.tangent)) >
        0.32);
  only_fails(after, 3);
}

TEST_CASE("A mirrored pair fails only the determinant's sign", "[pose]") {
  OrientedPair after = example();
  for (OrientedPoint* p : {&after.first, &after.second}) {
    p->point.z() = -p->point.z();
    p->tangent.z() = -p->tangent.z();
  }
  const ConstraintCheck check = check_constraints(example(), after);
  CHECK_FALSE(check.passed[5]);
  for (std::size_t i = 0; i < 5; ++i) CHECK(check.passed[i]);

  // Coplanar tangents: the determinant's sign is meaningless.
  OrientedPair flat = example();
  flat.second.tangent = unit(0.2, 1, 0.05);
  OrientedPair mirrored = flat;
  mirrored.second.tangent.z() = -mirrored.second.tangent.z();
  CHECK(check_constraints(flat, mirrored).passed[5]);
}

TEST_CASE("A flipped tangent fails the signed constraints", "[pose]") {
  OrientedPair after = example();
  after.first.tangent = -after.first.tangent;
  const ConstraintCheck check = check_constraints(example(), after);
  CHECK(check.passed[0]);
  CHECK_FALSE(check.passed[1]);
  CHECK_FALSE(check.passed[3]);
}

TEST_CASE("The quads swap roles where D is parallel to the first tangent, and fail where it is parallel to both",
          "[pose]") {
  OrientedPair pair = example();
  CHECK_FALSE(check_constraints(pair, pair).swapped);
  pair.first.tangent = unit(1, std::tan(13.0 * quadedge::kDegree), 0);
  CHECK(check_constraints(pair, pair).swapped);
  CHECK(check_constraints(pair, pair).all());
  pair.first.tangent = unit(1, std::tan(15.0 * quadedge::kDegree), 0);
  CHECK_FALSE(check_constraints(pair, pair).swapped);
  pair.first.tangent = Eigen::Vector3d::UnitX();
  pair.second.tangent = -Eigen::Vector3d::UnitX();
  CHECK_FALSE(check_constraints(pair, pair).passed[4]);
}

TEST_CASE("Two coincident points fail", "[pose]") {
  OrientedPair pair = example();
  pair.second.point = pair.first.point;
  CHECK_FALSE(check_constraints(pair, example()).all());
  CHECK_FALSE(check_constraints(example(), pair).all());
}

TEST_CASE("Two quads give no motion where the chord is parallel to the first tangent or has no length", "[pose]") {
  const OrientedPair good{{{0, 0, 4}, Eigen::Vector3d::UnitY()}, {{1, 0, 4}, Eigen::Vector3d::UnitZ()}};
  OrientedPair along = good, one_spot = good;
  along.first.tangent = Eigen::Vector3d::UnitX();
  one_spot.second.point = one_spot.first.point;
  CHECK(solve_two_quads(good, good));
  for (const OrientedPair& degenerate : {along, one_spot}) {
    CHECK_FALSE(solve_two_quads(degenerate, good));
    CHECK_FALSE(solve_two_quads(good, degenerate));
  }
}
