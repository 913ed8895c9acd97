#include <catch2/catch.hpp>

#include "generated_quads.hpp"
#include "pose/single_quad.hpp"

using namespace quadedge::pose;

TEST_CASE("Every member of a quad's family maps point to point and tangent to tangent", "[pose][single_quad]") {
  generated::Random random(3);
  for (int trial = 0; trial < 100; ++trial) {
    const OrientedPoint p{random.uniform(1, 20) * random.unit(), random.unit()},
        q{random.uniform(1, 20) * random.unit(), random.unit()};
    for (double theta : {-2.5, 0.0, 0.4, 3.1}) {
      const Eigen::Isometry3d motion = family(p, q, theta);
      CHECK((motion * p.point - q.point).norm() < 1e-12);
      CHECK((motion.linear() * p.tangent - q.tangent).norm() < 1e-12);
      CHECK((motion.linear() * motion.linear().transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
      CHECK(motion.linear().determinant() == Approx(1.0));
    }
  }
}

TEST_CASE("The true motion is a member of the family", "[pose][single_quad]") {
  generated::Random random(4);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d truth = random.motion(2.0, 3.0);
    const OrientedPoint p{random.uniform(1, 20) * random.unit(), random.unit()};
    const OrientedPoint q{truth * p.point, truth.linear() * p.tangent};
    // R = Rot(T_bar, theta) align, so the angle is that of R align^T about T_bar.
    const Eigen::Matrix3d rest = truth.linear() * family(p, q, 0.0).linear().transpose();
    const Eigen::Vector3d axis(rest(2, 1) - rest(1, 2), rest(0, 2) - rest(2, 0), rest(1, 0) - rest(0, 1));
    const double theta = std::atan2(0.5 * axis.dot(q.tangent), 0.5 * (rest.trace() - 1));
    CHECK((family(p, q, theta).matrix() - truth.matrix()).norm() < 1e-9);
  }
}

TEST_CASE("Alignment follows Equation 6 and stays exact up to opposite tangents", "[pose][single_quad]") {
  generated::Random random(5);
  const Eigen::Vector3d from = random.unit();
  const Eigen::Vector3d orthogonal = from.unitOrthogonal();
  for (double angle : {0.0, 1e-9, 0.5, 1.5, 2.5, 3.0}) {
    const Eigen::Vector3d to = std::cos(angle) * from + std::sin(angle) * orthogonal;
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(angle, from.cross(orthogonal).normalized()).toRotationMatrix();
    CHECK((align(from, to) - expected).norm() < 1e-9);
  }
  for (double rest : {1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
    const Eigen::Vector3d to = (-from + rest * orthogonal).normalized();
    const Eigen::Matrix3d rotation = align(from, to);
    CHECK((rotation * from - to).norm() < 1e-12);
    CHECK((rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    CHECK(rotation.determinant() == Approx(1.0));
  }
  // Exactly opposite: a half turn about an axis orthogonal to the tangent, 2 u u^T - I.
  CHECK(align(from, -from).trace() == Approx(-1.0));
}
