#include "generated_quads.hpp"
#include "motion/quads.hpp"

using namespace quadedge::pose;

TEST_CASE("Edges measured together are measured as one by one", "[pose]") {
  for (const quadedge::StereoRig& rig : {generated::car_rig(), generated::crooked_rig()}) {
    generated::Random random(11);
    quadedge::StereoEdges edges;
    std::vector<StereoObservation> observed;
    for (int i = 0; i < 2003; ++i) {  // more than one block; positions without depth and directions without slope too
      const auto coordinate = [&](double limit) {
        return static_cast<double>(static_cast<float>(random.uniform(0, limit)));
      };
      const auto direction = [&] { return static_cast<double>(static_cast<float>(random.uniform(-3.14, 3.14))); };
      StereoObservation edge{{coordinate(700), coordinate(370)},
                             {coordinate(600), coordinate(370)},
                             direction(),
                             direction(),
                             coordinate(3)};
      observed.push_back(edge);
      generated::append(edges, edge);
      edges.left_scale_shift.push_back(static_cast<float>(edge.left_scale_shift));
    }
    MeasuredEdges measured;
    measure_edges(rig, edges, 0.07, measured);
    REQUIRE(measured.size() == observed.size());
    int valid = 0;
    for (std::size_t i = 0; i < observed.size(); ++i) {
      const auto one = measure(rig, observed[i], 0.07);
      REQUIRE(measured[i].has_value() == one.has_value());
      if (!one) continue;
      ++valid;
      const auto same = [&](const auto member) { return (*measured[i]).*member == (*one).*member; };
      CHECK(same(&StereoMeasurement::ray));
      CHECK(same(&StereoMeasurement::inverse_depth));
      CHECK(same(&StereoMeasurement::inverse_depth_per_pixel));
      CHECK(same(&StereoMeasurement::epipolar_sine));
      CHECK(same(&StereoMeasurement::direction));
      CHECK(same(&StereoMeasurement::scale_shift));
      CHECK(same(&StereoMeasurement::slope));
      CHECK(same(&StereoMeasurement::slope_per_radian));
      CHECK(same(&StereoMeasurement::left_edge));
      CHECK(same(&StereoMeasurement::right_edge));
      CHECK(same(&StereoMeasurement::left_normal));
      CHECK(same(&StereoMeasurement::right_normal));
    }
    CHECK(valid > 500);
    CHECK(valid < 1800);
  }
}

TEST_CASE("Quads use the detected positions, keep their match's row and skip edges without depth", "[pose]") {
  const quadedge::StereoRig rig = generated::car_rig();
  generated::Random random(10);
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.translation() << 0.1, 0, -0.8;
  quadedge::StereoEdges previous, current;
  quadedge::TemporalMatches matches;
  std::vector<OrientedPoint> truth;
  for (int i = 0; i < 20; ++i) {
    OrientedPoint p = generated::random_point(rig, 6, 20, random);
    p.tangent = Eigen::Vector3d(0.4, 0.8, 0.3).normalized();
    truth.push_back(p);
    StereoObservation before = generated::observe(rig, p);
    if (i == 7) before.right.x() = before.left.x() + 3;  // behind the cameras
    generated::append(previous, before);
    const StereoObservation after = generated::observe(rig, {motion * p.point, motion.linear() * p.tangent});
    generated::append(current, after);
    matches.previous.push_back(i);
    matches.current.push_back(i);
    matches.left_x.push_back(static_cast<float>(after.left.x()) +
                             0.7f);  // the match's own refined position is not used
    matches.left_y.push_back(static_cast<float>(after.left.y()));
    matches.right_x.push_back(static_cast<float>(after.right.x()) + 0.9f);
    matches.right_y.push_back(static_cast<float>(after.right.y()));
    matches.ncc.push_back(static_cast<float>(i) / 20.0f);
    matches.competing_clusters.push_back(i % 3);
  }
  const QuadObservations quads = build_quads(rig, previous, current, matches);
  REQUIRE(quads.size() == 19);
  REQUIRE(quads.scoring.size() == 19);
  for (std::size_t k = 0; k < quads.size(); ++k) {
    const std::size_t i = k < 7 ? k : k + 1;
    CHECK(quads.match[k] == static_cast<int>(i));
    CHECK(quads.competing_clusters[k] == static_cast<int>(i) % 3);
    CHECK(quads.ncc[k] == Approx(static_cast<double>(i) / 20.0).margin(1e-6));
    const Eigen::Vector3d after = motion * truth[i].point;
    CHECK((quads.previous[k].oriented_point().point - truth[i].point).norm() < 1e-4 * truth[i].point.norm());
    CHECK((quads.current[k].oriented_point().point - after).norm() < 1e-4 * after.norm());
    CHECK((quads.previous[k].oriented_point().tangent - truth[i].tangent).norm() < 1e-3);
    CHECK(static_cast<double>(quads.scoring.left_x[k]) == Approx(rig.left.project(after).x()).margin(1e-3));
  }
}
